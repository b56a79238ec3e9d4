#include "io/shell_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/effects.h"
#include "core/frame.h"
#include "core/mill_shape.h"
#include "io/output.h"

namespace tumble::io {
namespace {

// Units of the picture: the shell's radius is 400, the steel around it 24.
constexpr double kRadius = 400, kSteel = 24, kMargin = 90, kTitle = 70;

std::string mm(double metres) { return fmt::format("{:.4g} mm", 1e3 * metres); }

std::string title_of(const Config& config) {
  const std::string inside = fmt::format("Mill of {:g} m inside the shell", config.mill.diameter);
  const Lifters& l = config.mill.lifters;
  if (l.profile == LifterProfile::kNone) return inside + ", no lifters";
  std::string text = inside + fmt::format(", {} lifters: {}", l.count, name_of(l.profile));
  if (!std::isnan(l.height)) text += ", " + mm(l.height) + " high";
  if (!std::isnan(l.width) && l.profile != LifterProfile::kWave && l.profile != LifterProfile::kPolygon)
    text += ", " + mm(l.width) + " wide";
  if (l.profile == LifterProfile::kSwivel) text += fmt::format(", tilted by {:g}°", l.swivel_angle_deg);
  return text;
}

std::string list_of(const std::vector<int>& numbers) {
  std::string text;
  for (const int n : numbers) text += (text.empty() ? "" : ", ") + std::to_string(n);
  return text;
}

// What became of the lifters; empty where they are as new.
std::string wear_of(const Config& config) {
  std::string text;
  if (has_effect(config, "lifter_wear")) {
    const std::vector<int> worn = effect_list(config, "lifter_wear", "lifters");
    text = fmt::format(
        "{} worn: {:.3g} % of the height lost, edges rounded by {}", worn.empty() ? "All" : "Lifters " + list_of(worn),
        100 * effect_value(config, "lifter_wear", "height_loss"), mm(effect_value(config, "lifter_wear", "rounding")));
  }
  if (has_effect(config, "missing_lifters"))
    text += (text.empty() ? "" : ". ") + ("Missing: " + list_of(effect_list(config, "missing_lifters", "lifters")));
  return text;
}

// 1, 2 or 5 times a power of ten, about a fifth of the diameter.
double scale_bar(double diameter) {
  const double about = diameter / 5, decade = std::pow(10, std::floor(std::log10(about)));
  return (about >= 5 * decade ? 5 : about >= 2 * decade ? 2 : 1) * decade;
}

std::string path_of(const MillShape& shape, double chord) {
  const double unit = kRadius / shape.radius;
  std::vector<Eigen::Vector2d> points = outline(shape, chord);
  points.push_back(points.front());
  std::string path;
  for (const auto& p : thinned(points, 0.01 / unit))
    path += fmt::format("{}{:.2f} {:.2f}", path.empty() ? "M" : "L", p.x() * unit, -p.y() * unit);
  return path + "Z";
}

// Numbers of the lifters in the steel behind them, as the effects' lists have them.
std::string numbers_of(const MillShape& shape) {
  std::string text;
  const int each = 1 + shape.lifter_count / 72;  // more would run into each other
  for (int k = 0; k < shape.lifter_count; k += each) {
    const double a = k * shape.pitch(), r = kRadius + kSteel + 13;
    text += fmt::format(R"(<text x="{:.1f}" y="{:.1f}" class="number">{}</text>)", r * std::cos(a),
                        -r * std::sin(a) + 4, k);
  }
  return text;
}

// An arrow that follows the rim over `degrees` to either side of 12 o'clock, counter-clockwise.
std::string rotation_arrow() {
  const double r = kRadius + kSteel + 42, half = 0.16;
  const double x = r * std::sin(half), y = -r * std::cos(half);
  return fmt::format(R"(<path class="arrow" d="M{0:.1f} {1:.1f}A{2:.1f} {2:.1f} 0 0 0 {3:.1f} {1:.1f}"/>)"
                     R"(<path class="head" d="M{4:.1f} {5:.1f}l15.6 -8.6l2.2 14.4z"/>)"
                     R"(<text x="{6:.1f}" y="{7:.1f}" class="small">direction of rotation</text>)",
                     x, y, r, -x, -x - 11, y + 2.2, x + 12, y + 4);
}

}  // namespace

void write_shell_svg(const std::filesystem::path& path, const Config& config, double chord) {
  const MillShape shape = make_mill_shape(config);
  const double outer = kRadius + kSteel, half = outer + kMargin, bar = scale_bar(config.mill.diameter);
  const double bar_length = bar * kRadius / shape.radius;
  const std::string wear = wear_of(config);
  std::string svg = fmt::format(
      R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="{0:.0f} {1:.0f} {2:.0f} {3:.0f}" width="{2:.0f}" height="{3:.0f}">)"
      "\n<style>text{{font-family:Helvetica,Arial,sans-serif;fill:#222}}.title{{font-size:22px}}"
      ".small{{font-size:15px;fill:#555}}.number{{font-size:12px;fill:#555;text-anchor:middle}}"
      ".steel{{fill:#cfd4da;fill-rule:evenodd;stroke:#222;stroke-width:1.4;stroke-linejoin:round}}"
      ".axis{{stroke:#888;stroke-width:.8;stroke-dasharray:14 4 3 4}}"
      ".arrow,.bar{{fill:none;stroke:#222;stroke-width:2}}.head{{fill:#222}}</style>\n",
      -half, -half - kTitle, 2 * half, 2 * half + kTitle);
  svg += fmt::format(R"(<rect x="{0:.0f}" y="{1:.0f}" width="{2:.0f}" height="{3:.0f}" fill="#fff"/>)", -half,
                     -half - kTitle, 2 * half, 2 * half + kTitle);
  svg += fmt::format("\n<text x=\"{:.0f}\" y=\"{:.0f}\" class=\"title\">{}</text>\n", -half + 24, -half - kTitle + 38,
                     title_of(config));
  if (!wear.empty())
    svg += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" class=\"small\">{}</text>\n", -half + 24, -half - kTitle + 64,
                       wear);
  svg += fmt::format(
      "<path class=\"steel\" d=\"M{0:.2f} 0A{0:.2f} {0:.2f} 0 1 0 -{0:.2f} 0A{0:.2f} {0:.2f} 0 1 0 "
      "{0:.2f} 0Z{1}\"/>\n",
      outer, path_of(shape, chord));
  const double cross = kRadius * 0.12;
  svg += fmt::format("<path class=\"axis\" d=\"M-{0:.0f} 0H{0:.0f}M0 -{0:.0f}V{0:.0f}\"/>\n", cross);
  svg += numbers_of(shape) + "\n" + rotation_arrow() + "\n";
  const double x = -half + 24, y = half - 24;
  svg += fmt::format(
      "<path class=\"bar\" d=\"M{0:.1f} {1:.1f}v-8v4h{2:.2f}v-4v8\"/>"
      "<text x=\"{3:.1f}\" y=\"{4:.1f}\" class=\"small\">{5:g} m</text>\n</svg>\n",
      x, y, bar_length, x + bar_length + 10, y + 1, bar);
  write_text(path, svg);
}

void write_shell_csv(const std::filesystem::path& path, const Config& config, double chord) {
  std::string text = "x_m,y_m,lifter,face\n";
  for (const OutlinePoint& p : labelled_outline(make_mill_shape(config), chord))
    text += fmt::format("{:.9g},{:.9g},{},{}\n", p.at.x(), p.at.y(), p.lifter < 0 ? "" : std::to_string(p.lifter),
                        kFaceNames[static_cast<std::size_t>(p.face)]);
  write_text(path, text);
}

}  // namespace tumble::io
