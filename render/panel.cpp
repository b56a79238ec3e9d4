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

TextStyle quiet(const Canvas& canvas, double size, Align align = Align::kLeft) {
  return {canvas.letter(size), canvas.theme.quiet, Weight::kRegular, align};
}

// Where things stand in the panel [px]. What is left between the readings and the colour scale belongs to the torque.
struct Plan {
  Plan(const Canvas& canvas, Colour by)
      : unit(canvas.layout.unit),
        left(canvas.layout.panel.left),
        right(canvas.layout.panel.right),
        top(canvas.layout.panel.top) {
    const double bottom = canvas.layout.panel.bottom;
    speed_x = left;
    // Letters do not shrink below what can be read: a small picture has room for fewer of them.
    is_small = unit < 0.75;
    torque_x = left + (is_small ? 230 : 170) * unit;
    power_x = left + 322 * unit;
    bar_top = bottom - (21 + kBarHeight) * unit;
    bar_title = bar_top - 11 * unit;
    plot_top = y(258);
    plot_bottom = by == Colour::kSteel ? bottom - 10 * unit : bar_title - 40 * unit;
  }
  double y(double units) const { return top + units * unit; }

  bool is_small = false;
  double unit, left, right, top;
  double speed_x, torque_x, power_x;
  double plot_top, plot_bottom, bar_title, bar_top;
};

void rule(Canvas& canvas, double y) {
  const Box& panel = canvas.layout.panel;
  canvas.meshes.line({panel.left, std::round(y)}, {panel.right, std::round(y)}, canvas.stroke(1.0), canvas.theme.faint);
}

// Letters do not shrink below what can be read, so lines of a tiny picture would stand in each other: which are so many
// units apart and have no room leave the lesser one out.
bool has_room(const Canvas& canvas, double units_between_lines) { return canvas.px(units_between_lines) >= 9; }

// A small label, a value below it, and a remark below that.
void value_and_unit(Canvas& canvas, double x, double y, const std::string& value, const std::string& unit) {
  const TextStyle large{canvas.letter(23), canvas.theme.text, Weight::kBold};
  canvas.text.add(value, x, y + canvas.px(28), large);
  canvas.text.add(unit, x + canvas.text.width(value, large) + canvas.px(5), y + canvas.px(28),
                  {canvas.letter(13), canvas.theme.text});
}

void label_and_remark(Canvas& canvas, double x, double y, const std::string& label, const std::string& remark) {
  if (has_room(canvas, 28)) canvas.text.add(label, x, y, quiet(canvas, 12.5));
  if (has_room(canvas, 19)) canvas.text.add(remark, x, y + canvas.px(47), quiet(canvas, 12.5));
}

void draw_colour_bar(Canvas& canvas, double left, double right, double top, const ColourScale& scale) {
  const double bottom = top + canvas.px(kBarHeight);
  const int steps = std::max(2, static_cast<int>(right - left));
  for (int i = 0; i < steps; ++i) {
    // Up to the bar's end, to be painted over by the next step: no seams between them.
    canvas.meshes.rectangle(left + (right - left) * i / steps, top, right, bottom,
                            scale.palette().at((i + 0.5) / steps));
  }
  const TextStyle label = quiet(canvas, 12, Align::kCentre);
  for (const Tick& tick : ticks(scale.low, scale.high, 5)) {
    const double x = left + (right - left) * (tick.value - scale.low) / (scale.high - scale.low);
    canvas.meshes.line({x, bottom}, {x, bottom + canvas.px(4)}, canvas.stroke(1.0),
                       with_alpha(canvas.theme.quiet, 0.7));
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
                    {canvas.letter(13), canvas.theme.text});
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
      return "Ball spin, rad/s (> 0 in the mill's sense)";
    case Colour::kResidence:
      return "Time in the bed since the last flight, s";
    case Colour::kForce:
      return "Largest contact force, N";
    case Colour::kSteel:
      break;
  }
  return "";
}

// Places after the point that show two digits of the run's mean; fixed for a run, so that the live value does not jump.
int decimals(double mean) {
  const double size = std::abs(mean);
  if (size >= 1000) return 0;
  if (!(size > 0 && size < 1)) return 1;
  return std::min(6, 1 - static_cast<int>(std::floor(std::log10(size))));
}

}  // namespace

std::string time_note(double slow) {
  if (std::isnan(slow)) return "";
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

std::optional<TorquePlot> place_torque_plot(Canvas& canvas, const TorqueTrace& trace, Colour by) {
  if (trace.empty()) return std::nullopt;
  const Plan plan(canvas, by);
  return make_torque_plot(canvas, {plan.left, plan.plot_top, plan.right, plan.plot_bottom}, trace);
}

void draw_still_panel(Canvas& canvas, const Panel& panel, bool pale) {
  const Plan plan(canvas, panel.scale.by);
  auto& text = canvas.text;
  text.add(mill_in_words(panel.setup.config), plan.left, plan.y(18),
           {canvas.letter(21), canvas.theme.text, Weight::kBold});
  if (has_room(canvas, 24)) text.add(charge_in_words(panel.setup), plan.left, plan.y(42), quiet(canvas, 13));
  rule(canvas, plan.y(62));
  text.add(time_note(panel.slow), plan.right, plan.y(116), quiet(canvas, 13, Align::kRight));

  const double rpm = rpm_from_rad_s(panel.setup.mill_speed), mean = panel.trace.mean(),
               power = mean * panel.setup.mill_speed;
  label_and_remark(canvas, plan.speed_x, plan.y(148), "Speed",
                   fmt::format("{:.1f} % of critical", 100 * rpm / critical_speed_rpm(panel.setup.config.mill)));
  value_and_unit(canvas, plan.speed_x, plan.y(148), fmt::format("{:.1f}", rpm), "rev/min");
  label_and_remark(canvas, plan.torque_x, plan.y(148), "Torque",
                   std::isnan(mean) ? "of one slice" : fmt::format("mean {:.{}f} N m", mean, decimals(mean) + 1));
  if (!plan.is_small) {
    label_and_remark(canvas, plan.power_x, plan.y(148), "Power",
                     std::isnan(mean) ? "of one slice" : fmt::format("mean {:.{}f} W", power, decimals(power)));
  }
  rule(canvas, plan.y(214));

  if (panel.plot) {
    text.add("Torque of one slice, N m", plan.left, plan.y(240), {canvas.letter(13), canvas.theme.text});
    text.add(plan.is_small ? "time, s" : "running mean over a lifter passage; time, s", plan.right, plan.y(240),
             quiet(canvas, 11, Align::kRight));
    draw_torque_curve(canvas, *panel.plot, panel.trace, pale);
  }

  const auto& radii = panel.setup.balls.radius;
  draw_colour_scale(canvas, plan.left, plan.right, plan.bar_top, panel.scale, {radii.begin(), radii.end()});
}

void draw_colour_scale(Canvas& canvas, double left, double right, double top, const ColourScale& scale,
                       const std::set<double>& radii) {
  if (scale.by == Colour::kSteel) return;
  canvas.text.add(title_of(scale.by), left, top - canvas.px(11), {canvas.letter(13), canvas.theme.text});
  if (scale.by == Colour::kSize && radii.size() <= 6) {
    draw_classes(canvas, left, right, top, scale, radii);
  } else {
    ColourScale shown = scale;
    if (scale.by == Colour::kSize) {
      shown.low *= 1000;
      shown.high *= 1000;
    }
    draw_colour_bar(canvas, left, right, top, shown);
  }
}

void draw_moving_panel(Canvas& canvas, const Panel& panel, const Frame& frame) {
  const Plan plan(canvas, panel.scale.by);
  auto& text = canvas.text;
  const TextStyle clock{canvas.letter(40), canvas.theme.text, Weight::kBold};
  const std::string seconds = fmt::format("{:.2f}", frame.time);
  text.add(seconds, plan.left, plan.y(116), clock);
  text.add("s", plan.left + text.width(seconds, clock) + canvas.px(8), plan.y(116),
           {canvas.letter(20), canvas.theme.quiet});
  const double revolutions = frame.time * std::abs(panel.setup.mill_speed) / (2 * kPi);
  if (has_room(canvas, 21))
    text.add(fmt::format("revolution {:.2f}", revolutions), plan.right, plan.y(95), quiet(canvas, 13, Align::kRight));

  const double running = panel.trace.running(frame.time);
  const double torque = std::isnan(running) ? frame.observed.torque : running, mean = panel.trace.mean();
  const auto live = [](double value, double of_run) { return fmt::format("{:.{}f}", value, decimals(of_run)); };
  value_and_unit(canvas, plan.torque_x, plan.y(148), std::isnan(torque) ? "–" : live(torque, mean), "N m");
  if (!plan.is_small) {
    value_and_unit(canvas, plan.power_x, plan.y(148),
                   std::isnan(torque) ? "–" : live(torque * panel.setup.mill_speed, mean * panel.setup.mill_speed),
                   "W");
  }
  if (panel.plot) draw_torque_cursor(canvas, *panel.plot, panel.trace, frame.time);
}

}  // namespace tumble::render
