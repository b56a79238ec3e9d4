#include "io/report/mill_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/angle.h"
#include "io/report/html.h"

namespace tumble::io::report {
namespace {

constexpr double kScale = 100;  // the shell's radius in the picture's units
constexpr int kShades = 12;
constexpr int kFiner = 3;  // shaded cells along one cell of the field, blended between its neighbours
constexpr int kArrowsAcross = 20;

// Picture units from metres; y stays up, the picture's group turns it over.
struct Canvas {
  double per_metre;
  std::string point(double x, double y) const { return fmt::format("{:.2f} {:.2f}", x * per_metre, y * per_metre); }
};

// Occupancy at a place in cells from the grid's corner, blended between the four cells around; NaN where all are.
double blended(const Field& field, double column, double row) {
  double sum = 0, weights = 0;
  const double c0 = std::floor(column - 0.5), r0 = std::floor(row - 0.5);
  for (const double r : {r0, r0 + 1})
    for (const double c : {c0, c0 + 1}) {
      if (r < 0 || c < 0 || r >= field.n || c >= field.n) continue;
      const double o = field.occupancy[static_cast<std::size_t>(r * field.n + c)];
      const double w = (1 - std::abs(column - 0.5 - c)) * (1 - std::abs(row - 0.5 - r));
      if (!std::isfinite(o)) continue;
      sum += w * o;
      weights += w;
    }
  return sum / weights;
}

// Cells of like shade in a row become one rectangle, rectangles of one shade one path: some kilobytes in all.
std::string shades(const Field& field, const Canvas& canvas) {
  const auto cells = static_cast<std::size_t>(field.n);
  if (field.occupancy.size() != cells * cells || cells == 0) return "";
  std::array<std::string, kShades> paths;
  const int n = field.n * kFiner;
  const double cell = field.cell * canvas.per_metre / kFiner, low = -cell * n / 2;
  const auto shade = [&](int row, int column) {
    const double o = blended(field, (column + 0.5) / kFiner, (row + 0.5) / kFiner);
    return o > 0.01 ? std::clamp(static_cast<int>(o * kShades), 0, kShades - 1) : -1;
  };
  for (int row = 0; row < n; ++row) {
    for (int begin = 0; begin < n;) {
      int end = begin + 1;
      const int s = shade(row, begin);
      while (end < n && shade(row, end) == s) ++end;
      if (s >= 0)
        paths[static_cast<std::size_t>(s)] +=
            fmt::format("M{:.2f} {:.2f}h{:.2f}v{:.2f}h{:.2f}z", low + cell * begin, low + cell * row,
                        cell * (end - begin), cell, -cell * (end - begin));
      begin = end;
    }
  }
  std::string out;
  for (int s = 0; s < kShades; ++s)
    if (const auto& path = paths[static_cast<std::size_t>(s)]; !path.empty())
      out += fmt::format(R"(<path class="shade" shape-rendering="crispEdges" opacity="{:.3f}" d="{}"/>)",
                         (s + 0.5) / kShades * 0.8, path);
  return out;
}

// Mean velocities, the longest as long as the arrows' spacing.
std::string arrows(const Field& field, const Canvas& canvas) {
  const int n = field.n;
  if (field.vx.size() != field.occupancy.size() || field.vy.size() != field.vx.size() || field.vx.empty()) return "";
  const int stride = std::max(1, static_cast<int>(std::lround(static_cast<double>(n) / kArrowsAcross)));
  double fastest = 0;
  for (std::size_t i = 0; i < field.vx.size(); ++i)
    if (const double v = std::hypot(field.vx[i], field.vy[i]); v > fastest && field.occupancy[i] > 0.1) fastest = v;
  if (!(fastest > 0)) return "";
  const double length = 1.3 * stride * field.cell / fastest;
  std::string path;
  for (int row = stride / 2; row < n; row += stride) {
    for (int column = stride / 2; column < n; column += stride) {
      const auto i = static_cast<std::size_t>(row) * static_cast<std::size_t>(n) + static_cast<std::size_t>(column);
      const double dx = field.vx[i] * length, dy = field.vy[i] * length;
      if (!(field.occupancy[i] > 0.05) || !(std::hypot(dx, dy) > 0.2 * stride * field.cell)) continue;
      const double x = (column + 0.5 - n / 2.0) * field.cell, y = (row + 0.5 - n / 2.0) * field.cell;
      const double tx = x + dx / 2, ty = y + dy / 2;  // the tip; the arrow is centred on its cell
      path += fmt::format("M{}L{}", canvas.point(x - dx / 2, y - dy / 2), canvas.point(tx, ty));
      path += fmt::format("M{}L{}L{}", canvas.point(tx - 0.3 * dx - 0.18 * dy, ty - 0.3 * dy + 0.18 * dx),
                          canvas.point(tx, ty), canvas.point(tx - 0.3 * dx + 0.18 * dy, ty - 0.3 * dy - 0.18 * dx));
    }
  }
  return path.empty() ? "" : fmt::format(R"(<path class="arrows" d="{}"/>)", path);
}

std::string ray(const char* style, double deg, double from, double to) {
  if (!std::isfinite(deg)) return "";
  const double c = std::cos(radians(deg)), s = std::sin(radians(deg));
  return fmt::format(R"(<path class="{}" d="M{:.2f} {:.2f}L{:.2f} {:.2f}"/>)", style, from * c, from * s, to * c,
                     to * s);
}

std::string name_at(const char* name, double deg) {
  if (!std::isfinite(deg)) return "";
  const double c = std::cos(radians(deg)), s = std::sin(radians(deg)), r = 112;
  const char* anchor = c > 0.35 ? "start" : (c < -0.35 ? "end" : "middle");
  return fmt::format(R"(<text y="{1:.1f}" text-anchor="{2}"><tspan x="{0:.1f}">{3}</tspan>)"
                     R"(<tspan class="degrees" x="{0:.1f}" dy="1.15em">{4:.1f}°</tspan></text>)",
                     r * c, -r * s, anchor, name, deg);
}

std::string cross(const ChargeMotion& m, const Canvas& canvas) {
  const double x = m.centre_of_circulation_x.value * canvas.per_metre;
  const double y = m.centre_of_circulation_y.value * canvas.per_metre;
  if (!std::isfinite(x) || !std::isfinite(y)) return "";
  return fmt::format(R"(<path class="centre" d="M{0:.2f} {1:.2f}h8M{2:.2f} {3:.2f}v8"/>)", x - 4, y, x, y - 4);
}

}  // namespace

std::string mill_picture(const MillShape& shape, const ChargeMotion& motion, const ChargeMotion* other,
                         const std::string& label) {
  const Canvas canvas{kScale / shape.radius};
  const double tip = shape.tip_radius * canvas.per_metre;
  std::string inside;
  for (const auto& p : thinned(outline(shape, shape.radius / 40), 5e-4 * shape.radius))
    inside += std::string(inside.empty() ? "M" : "L") + canvas.point(p.x(), p.y());

  std::string out =
      fmt::format(R"(<svg class="mill" viewBox="-166 -110 332 220" role="img" aria-label="{}">)", escaped(label));
  out += R"svg(<g transform="scale(1 -1)"><circle class="inside" r="104"/>)svg" + shades(motion.field, canvas);
  // Shell and lifters lie over the shades, which reach a cell too far.
  out += fmt::format(
      R"(<path class="shell" fill-rule="evenodd" d="M104 0A104 104 0 1 0 -104 0A104 104 0 1 0 104 0z{}z"/>)", inside);
  out += arrows(motion.field, canvas) + cross(motion, canvas);
  if (other)
    out += ray("other", other->toe_deg.value, tip * 0.8, 108) + ray("other", other->shoulder_deg.value, tip * 0.8, 108);
  out += ray("mark", motion.toe_deg.value, tip * 0.8, 108) + ray("mark", motion.shoulder_deg.value, tip * 0.8, 108);
  out += "</g>";
  out += name_at("toe", motion.toe_deg.value) + name_at("shoulder", motion.shoulder_deg.value);
  return out + "</svg>";
}

}  // namespace tumble::io::report
