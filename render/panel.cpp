#include "render/panel.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "core/units.h"
#include "render/axis.h"

namespace tumble::render {
namespace {

constexpr double kBarHeight = 12;  // of the colour bar [units]

TextStyle quiet(const Canvas& canvas, double size) { return {canvas.letter(size), ink::kQuiet}; }

void rule(Canvas& canvas, double y) {
  const Box& panel = canvas.layout.panel;
  canvas.meshes.line({panel.left, std::round(y)}, {panel.right, std::round(y)}, canvas.stroke(1.0), ink::kFaint);
}

// A small label, a value below it, and a remark below that.
void reading(Canvas& canvas, double x, double y, const std::string& label, const std::string& value,
             const std::string& unit, const std::string& remark) {
  canvas.text.add(label, x, y, quiet(canvas, 12.5));
  const TextStyle large{canvas.letter(23), ink::kText, Weight::kBold};
  canvas.text.add(value, x, y + canvas.px(28), large);
  canvas.text.add(unit, x + canvas.text.width(value, large) + canvas.px(5), y + canvas.px(28),
                  {canvas.letter(13), ink::kText});
  canvas.text.add(remark, x, y + canvas.px(47), quiet(canvas, 12.5));
}

void draw_colour_bar(Canvas& canvas, double left, double right, double top, const ColourScale& scale) {
  const double bottom = top + canvas.px(kBarHeight);
  const int steps = std::max(2, static_cast<int>(right - left));
  for (int i = 0; i < steps; ++i) {
    const double x0 = left + (right - left) * i / steps, x1 = left + (right - left) * (i + 1) / steps;
    canvas.meshes.rectangle(x0, top, x1, bottom, scale.palette().at((i + 0.5) / steps));
  }
  TextStyle label = quiet(canvas, 12);
  label.align = Align::kCentre;
  for (const Tick& tick : ticks(scale.low, scale.high, 5)) {
    const double x = left + (right - left) * (tick.value - scale.low) / (scale.high - scale.low);
    canvas.meshes.line({x, bottom}, {x, bottom + canvas.px(4)}, canvas.stroke(1.0), with_alpha(ink::kQuiet, 0.7));
    const double half = canvas.text.width(tick.label, label) / 2;
    canvas.text.add(tick.label, std::clamp(x, left + half, right - half), bottom + canvas.px(7) + 0.8 * label.size,
                    label);
  }
}

// By size there are a few classes, so each is shown as a ball of its colour.
void draw_classes(Canvas& canvas, double left, double right, double top, const ColourScale& scale,
                  const std::set<double>& radii) {
  const double step = (right - left) / static_cast<double>(radii.size());
  double x = left;
  for (const double radius : radii) {
    const double r = canvas.px(6 + 4 * radius / *radii.rbegin());
    Disc disc;
    disc.centre = {x + canvas.px(11), top + canvas.px(8)};
    disc.radius = r;
    disc.colour = scale.colour_of(radius);
    canvas.discs.add(disc);
    canvas.text.add(fmt::format("{:.3g}", 1000 * radius), x + canvas.px(28), top + canvas.px(13),
                    {canvas.letter(13), ink::kText});
    x += step;
  }
}

const char* title_of(Colour by) {
  switch (by) {
    case Colour::kSpeed:
      return "Ball speed, m/s";
    case Colour::kSize:
      return "Ball radius, mm";
    case Colour::kSpin:
      return "Ball spin, rad/s (counter-clockwise > 0)";
    case Colour::kSteel:
      break;
  }
  return "";
}

}  // namespace

std::string time_note(double slow) {
  if (std::abs(slow - 1) < 5e-3) return "true time";
  const auto factor = [](double f) {  // 3.3, 10, 0.25: two digits, no idle zeros
    return f < 9.95 ? fmt::format("{:g}", std::round(f * 10) / 10) : fmt::format("{:.0f}", f);
  };
  return slow > 1 ? factor(slow) + " × slower" : factor(1 / slow) + " × faster";
}

std::string mill_in_words(const Config& config) {
  const Mill& mill = config.mill;
  const double size = mill.diameter;
  const std::string diameter = size < 2 ? fmt::format("{:.0f} mm", 1000 * size) : fmt::format("{:.2f} m", size);
  return "Ball mill, ⌀ " + diameter;
}

std::string charge_in_words(const RunSetup& setup) {
  const Mill& mill = setup.config.mill;
  const Lifters& lifters = mill.lifters;
  std::string words;
  if (lifters.profile == LifterProfile::kNone || lifters.count == 0) {
    words = "smooth shell";
  } else {
    std::string profile = name_of(lifters.profile);
    if (lifters.profile == LifterProfile::kRectangle) {
      profile = std::abs(lifters.height - lifters.width) < 1e-9 ? "square" : "rectangular";
    } else if (lifters.profile == LifterProfile::kTriangle) {
      profile = "triangular";
    } else if (lifters.profile == LifterProfile::kTrapezoid) {
      profile = "trapezoidal";
    }
    words = fmt::format("{} {} lifter{}", lifters.count, profile, lifters.count == 1 ? "" : "s");
  }
  double area = 0;
  for (const double r : setup.balls.radius) area += kPi * r * r;
  const double shell = kPi * mill.diameter * mill.diameter / 4;
  return fmt::format("{} · {} ball{} · filling {:.1f} %", words, setup.balls.size(), setup.balls.size() == 1 ? "" : "s",
                     100 * area / (kSettledAreaShare * shell));
}

void draw_panel(Canvas& canvas, const RunSetup& setup, const Frame& frame, const TorqueTrace& trace,
                const ColourScale& scale, double slow) {
  const Box& panel = canvas.layout.panel;
  const auto y = [&](double units) { return panel.top + canvas.px(units); };
  auto& text = canvas.text;

  text.add(mill_in_words(setup.config), panel.left, y(18), {canvas.letter(21), ink::kText, Weight::kBold});
  text.add(charge_in_words(setup), panel.left, y(42), quiet(canvas, 13));
  rule(canvas, y(62));

  const TextStyle clock{canvas.letter(40), ink::kText, Weight::kBold};
  const std::string seconds = fmt::format("{:.2f}", frame.time);
  text.add(seconds, panel.left, y(116), clock);
  text.add("s", panel.left + text.width(seconds, clock) + canvas.px(8), y(116), {canvas.letter(20), ink::kQuiet});
  TextStyle note = quiet(canvas, 13);
  note.align = Align::kRight;
  text.add(time_note(slow), panel.right, y(116), note);
  const double revolutions = std::abs(frame.mill_angle) / (2 * kPi);
  text.add(fmt::format("revolution {:.2f}", revolutions), panel.right, y(95), note);

  const double rpm = rpm_from_rad_s(setup.mill_speed);
  const double torque = std::isnan(running_torque(trace)) ? frame.observed.torque : running_torque(trace);
  const double mean = mean_torque(trace), third = panel.width() / 3;
  reading(canvas, panel.left, y(148), "Speed", fmt::format("{:.1f}", rpm), "rev/min",
          fmt::format("{:.1f} % of critical", 100 * rpm / critical_speed_rpm(setup.config.mill)));
  if (!std::isnan(torque)) {
    reading(canvas, panel.left + 1.16 * third, y(148), "Torque", fmt::format("{:.1f}", torque), "N m",
            std::isnan(mean) ? "one slice" : fmt::format("mean {:.2f} N m", mean));
    reading(canvas, panel.left + 2.2 * third, y(148), "Power", fmt::format("{:.1f}", torque * setup.mill_speed), "W",
            std::isnan(mean) ? "" : fmt::format("mean {:.1f} W", mean * setup.mill_speed));
  }
  rule(canvas, y(214));

  // What is left between the readings and the colour scale belongs to the torque's trace.
  const bool has_scale = scale.by != Colour::kSteel;
  const double bar_top = panel.bottom - canvas.px(12 + kBarHeight + 9), bar_title = bar_top - canvas.px(11);
  const double plot_bottom = has_scale ? bar_title - canvas.px(40) : panel.bottom - canvas.px(10);
  text.add("Torque, N m", panel.left, y(240), {canvas.letter(13), ink::kText});
  text.add("over time, s; running mean of one lifter passage", panel.right, y(240), [&] {
    TextStyle style = quiet(canvas, 11.5);
    style.align = Align::kRight;
    return style;
  }());
  draw_torque_plot(canvas, {panel.left, y(258), panel.right, plot_bottom}, trace);

  if (!has_scale) return;
  text.add(title_of(scale.by), panel.left, bar_title, {canvas.letter(13), ink::kText});
  const std::set<double> radii(setup.balls.radius.begin(), setup.balls.radius.end());
  if (scale.by == Colour::kSize && radii.size() <= 6) {
    draw_classes(canvas, panel.left, panel.right, bar_top, scale, radii);
  } else {
    ColourScale shown = scale;
    if (scale.by == Colour::kSize) {
      shown.low *= 1000;
      shown.high *= 1000;
    }
    draw_colour_bar(canvas, panel.left, panel.right, bar_top, shown);
  }
}

}  // namespace tumble::render
