#include "render/torque_plot.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/config.h"
#include "core/quantile.h"
#include "core/units.h"
#include "render/axis.h"

namespace tumble::render {
namespace {

TextStyle axis_text(const Canvas& canvas, Align align) {
  return {canvas.letter(12), canvas.theme.quiet, Weight::kRegular, align};
}

}  // namespace

TorqueTrace::TorqueTrace(std::span<const double> time, std::span<const double> torque, double passage)
    : time_(time.begin(), time.end()), torque_(torque.begin(), torque.end()), passage_(passage) {
  const bool known = std::any_of(torque.begin(), torque.end(), [](double value) { return !std::isnan(value); });
  if (time.size() < 2 || torque.size() != time.size() || !(time.back() > time.front()) || !known) return;
  sums_.reserve(torque.size() + 1);
  sums_.push_back(0);
  double last = 0;  // a sample that is not known counts as its predecessor
  for (const double value : torque) {
    if (!std::isnan(value)) last = value;
    sums_.push_back(sums_.back() + last);
  }
}

bool TorqueTrace::is_of(std::span<const double> time, std::span<const double> torque) const {
  const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
  return std::ranges::equal(time, time_, same) && std::ranges::equal(torque, torque_, same);
}

double TorqueTrace::running(double time) const {
  if (empty()) return kNotGiven;
  const auto begin = std::lower_bound(time_.begin(), time_.end(), time - passage_ / 2);
  const auto end = std::upper_bound(time_.begin(), time_.end(), time + passage_ / 2);
  auto i = static_cast<std::size_t>(begin - time_.begin()), j = static_cast<std::size_t>(end - time_.begin());
  if (j <= i) {  // sparser than a passage: the nearest sample
    i = std::min(i, time_.size() - 1);
    j = i + 1;
  }
  return (sums_[j] - sums_[i]) / static_cast<double>(j - i);
}

double TorqueTrace::mean() const { return empty() ? kNotGiven : sums_.back() / static_cast<double>(torque_.size()); }

double TorquePlot::x_of(double time) const { return box.left + (time - start) / (end - start) * box.width(); }

double TorquePlot::y_of(double torque) const {
  return std::clamp(box.bottom - (torque - low) / (high - low) * box.height(), box.top, box.bottom);
}

TorquePlot make_torque_plot(Canvas& canvas, const Box& area, const TorqueTrace& trace) {
  TorquePlot plot;
  plot.start = trace.time().front();
  plot.end = trace.time().back();
  std::vector<double> known;
  std::copy_if(trace.torque().begin(), trace.torque().end(), std::back_inserter(known),
               [](double value) { return !std::isnan(value); });
  // Single collisions would squash the curve: the scale holds zero, the curve and all but the wildest samples.
  plot.low = std::min(0.0, quantile_of(known, 0.05));
  plot.high = std::max(0.0, quantile_of(known, 0.95));
  for (const double time : trace.time()) {
    plot.low = std::min(plot.low, trace.running(time));
    plot.high = std::max(plot.high, trace.running(time));
  }
  if (!(plot.high > plot.low)) plot.high = plot.low + 1;
  plot.high += 0.08 * (plot.high - plot.low);

  const TextStyle style = axis_text(canvas, Align::kRight);
  double labels = 0;
  for (const Tick& tick : ticks(plot.low, plot.high, 4)) {
    labels = std::max(labels, canvas.text.width(tick.label, style));
  }
  plot.box = {area.left + labels + canvas.px(8), area.top, area.right, area.bottom - canvas.px(9) - style.size};
  return plot;
}

void draw_torque_curve(Canvas& canvas, const TorquePlot& plot, const TorqueTrace& trace, bool pale) {
  auto& m = canvas.meshes;
  const Box& box = plot.box;
  const double hair = canvas.stroke(1.0);
  const TextStyle beside = axis_text(canvas, Align::kRight), under = axis_text(canvas, Align::kCentre);
  for (const Tick& tick : ticks(plot.low, plot.high, 4)) {
    const double y = std::round(plot.y_of(tick.value));
    m.line({box.left, y}, {box.right, y}, hair,
           tick.value == 0 ? with_alpha(canvas.theme.quiet, 0.7) : canvas.theme.faint);
    if (pale) canvas.text.add(tick.label, box.left - canvas.px(8), y + 0.36 * beside.size, beside);
  }
  for (const Tick& tick : ticks(plot.start, plot.end, 5)) {
    const double x = std::round(plot.x_of(tick.value));
    m.line({x, box.bottom}, {x, box.bottom + canvas.px(4)}, hair, with_alpha(canvas.theme.quiet, 0.7));
    const double half = canvas.text.width(tick.label, under) / 2;
    if (pale)
      canvas.text.add(tick.label, std::min(x, box.right - half), box.bottom + canvas.px(7) + 0.8 * under.size, under);
  }

  // The band: bins of a few samples, and of a pixel at least.
  const auto time_of = [&](int part, int parts) { return plot.start + (plot.end - plot.start) * part / parts; };
  const int pixels = std::max(2, static_cast<int>(box.width()));
  const int bins = std::clamp(static_cast<int>(trace.time().size() / 4), 1, pixels);
  std::size_t k = 0;
  for (int i = 0; i < bins; ++i) {
    double smallest = kNotGiven, largest = kNotGiven;
    for (; k < trace.time().size() && trace.time()[k] <= time_of(i + 1, bins); ++k) {
      smallest = std::fmin(smallest, trace.torque()[k]);
      largest = std::fmax(largest, trace.torque()[k]);
    }
    if (std::isnan(smallest)) continue;
    m.rectangle(plot.x_of(time_of(i, bins)), plot.y_of(largest), plot.x_of(time_of(i + 1, bins)), plot.y_of(smallest),
                with_alpha(canvas.theme.trace, pale ? 0.07 : 0.18));
  }
  std::vector<Vec2> curve;
  for (int i = 0; i <= pixels; ++i) {
    const double time = time_of(i, pixels);
    curve.emplace_back(plot.x_of(time), plot.y_of(trace.running(time)));
  }
  m.polyline(curve, canvas.stroke(pale ? 1.3 : 1.8), with_alpha(canvas.theme.trace, pale ? 0.4 : 1.0));

  const double mean = plot.y_of(trace.mean()), dash = canvas.px(6);
  for (double x = box.left; x < box.right; x += 2 * dash) {
    m.line({x, mean}, {std::min(x + dash, box.right), mean}, hair, with_alpha(canvas.theme.text, 0.75));
  }
}

void draw_torque_cursor(Canvas& canvas, const TorquePlot& plot, const TorqueTrace& trace, double now) {
  const double x = std::clamp(plot.x_of(now), plot.box.left, plot.box.right);
  canvas.meshes.line({x, plot.box.top}, {x, plot.box.bottom}, canvas.stroke(1.2), canvas.theme.accent);
  canvas.meshes.ring({x, plot.y_of(trace.running(now))}, 0, canvas.px(3.6), 0, 2 * kPi, canvas.theme.accent);
}

}  // namespace tumble::render
