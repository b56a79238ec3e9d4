#include "render/torque_plot.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <vector>

#include "core/config.h"
#include "core/units.h"
#include "render/axis.h"

namespace tumble::render {
namespace {

// Sums of the first n samples, so that any running mean is one subtraction. NaN samples count as their predecessor.
std::vector<double> running_sums(std::span<const double> series) {
  std::vector<double> sums{0.0};
  sums.reserve(series.size() + 1);
  double last = 0;
  for (const double value : series) {
    if (!std::isnan(value)) last = value;
    sums.push_back(sums.back() + last);
  }
  return sums;
}

double running_mean(const TorqueTrace& trace, const std::vector<double>& sums, double time) {
  const auto& t = trace.time;
  const auto begin = std::lower_bound(t.begin(), t.end(), time - trace.passage / 2);
  const auto end = std::upper_bound(t.begin(), t.end(), time + trace.passage / 2);
  auto i = static_cast<std::size_t>(begin - t.begin()), j = static_cast<std::size_t>(end - t.begin());
  if (j <= i) {  // sparser than a passage: the nearest sample
    i = std::min(i, t.size() - 1);
    j = i + 1;
  }
  return (sums[j] - sums[i]) / static_cast<double>(j - i);
}

bool is_empty(const TorqueTrace& trace) {
  return trace.time.size() < 2 || trace.torque.size() != trace.time.size() || !(trace.time.back() > trace.time.front());
}

double quantile(std::vector<double> values, double share) {
  const auto k = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + k, values.end());
  return values[static_cast<std::size_t>(k)];
}

}  // namespace

double running_torque(const TorqueTrace& trace) {
  if (is_empty(trace)) return kNotGiven;
  return running_mean(trace, running_sums(trace.torque), trace.now);
}

double mean_torque(const TorqueTrace& trace) {
  if (is_empty(trace)) return kNotGiven;
  return running_sums(trace.torque).back() / static_cast<double>(trace.torque.size());
}

void draw_torque_plot(Canvas& canvas, const Box& box, const TorqueTrace& trace) {
  if (is_empty(trace)) return;
  const std::vector<double> sums = running_sums(trace.torque);
  std::vector<double> known;
  std::copy_if(trace.torque.begin(), trace.torque.end(), std::back_inserter(known),
               [](double value) { return !std::isnan(value); });
  if (known.empty()) return;
  // Single collisions would squash the curve: the scale holds all but one sample in two hundred, and zero.
  double low = std::min(0.0, quantile(known, 0.005)), high = std::max(0.0, quantile(known, 0.995));
  if (!(high > low)) high = low + 1;
  high += 0.08 * (high - low);
  const double start = trace.time.front(), end = trace.time.back();

  const TextStyle axis_text{canvas.letter(12), ink::kQuiet, Weight::kRegular, Align::kRight};
  const std::vector<Tick> levels = ticks(low, high, 4);
  double margin = 0;
  for (const Tick& tick : levels) margin = std::max(margin, canvas.text.width(tick.label, axis_text));
  const Box plot{box.left + margin + canvas.px(8), box.top, box.right, box.bottom - canvas.px(9) - axis_text.size};
  const auto x_of = [&](double t) { return plot.left + (t - start) / (end - start) * plot.width(); };
  const auto y_of = [&](double value) {
    return std::clamp(plot.bottom - (value - low) / (high - low) * plot.height(), plot.top, plot.bottom);
  };

  auto& m = canvas.meshes;
  const double hair = canvas.stroke(1.0);
  for (const Tick& tick : levels) {
    const double y = std::round(y_of(tick.value));
    m.line({plot.left, y}, {plot.right, y}, hair, tick.value == 0 ? with_alpha(ink::kQuiet, 0.7) : ink::kFaint);
    canvas.text.add(tick.label, plot.left - canvas.px(8), y + 0.36 * axis_text.size, axis_text);
  }
  TextStyle under = axis_text;
  under.align = Align::kCentre;
  for (const Tick& tick : ticks(start, end, 5)) {
    const double x = std::round(x_of(tick.value));
    m.line({x, plot.bottom}, {x, plot.bottom + canvas.px(4)}, hair, with_alpha(ink::kQuiet, 0.7));
    const double half = canvas.text.width(tick.label, under) / 2;
    const double at = std::min(x, plot.right - half);
    canvas.text.add(tick.label, at, plot.bottom + canvas.px(7) + 0.8 * under.size, under);
  }

  // One column a pixel; what is still to come is paler.
  const int columns = std::max(2, static_cast<int>(plot.width()));
  std::vector<Vec2> past, future;
  const double cursor = std::clamp(x_of(trace.now), plot.left, plot.right);
  std::size_t k = 0;
  for (int c = 0; c < columns; ++c) {
    const double x = plot.left + plot.width() * c / (columns - 1);
    const double until = start + (end - start) * (c + 0.5) / (columns - 1);
    double smallest = kNotGiven, largest = kNotGiven;
    for (; k < trace.time.size() && trace.time[k] <= until; ++k) {
      smallest = std::fmin(smallest, trace.torque[k]);
      largest = std::fmax(largest, trace.torque[k]);
    }
    const bool is_past = x <= cursor;
    if (!std::isnan(smallest)) {
      const double top = y_of(largest), bottom = y_of(smallest);
      if (bottom - top > 1) m.rectangle(x - 0.5, top, x + 0.5, bottom, with_alpha(ink::kTrace, is_past ? 0.26 : 0.10));
    }
    const Vec2 point(x, y_of(running_mean(trace, sums, start + (end - start) * c / (columns - 1))));
    if (is_past) past.push_back(point);
    if (!is_past || c + 1 == columns) future.push_back(point);
  }
  if (!past.empty() && !future.empty() && past.back() != future.front()) future.insert(future.begin(), past.back());
  m.polyline(future, canvas.stroke(1.3), with_alpha(ink::kTrace, 0.35));
  m.polyline(past, canvas.stroke(1.8), ink::kTrace);

  const double mean = y_of(sums.back() / static_cast<double>(trace.torque.size()));
  const double dash = canvas.px(6);
  for (double x = plot.left; x < plot.right; x += 2 * dash) {
    m.line({x, mean}, {std::min(x + dash, plot.right), mean}, hair, with_alpha(ink::kText, 0.75));
  }
  m.line({cursor, plot.top}, {cursor, plot.bottom}, canvas.stroke(1.2), ink::kAccent);
  m.ring({cursor, y_of(running_mean(trace, sums, trace.now))}, 0, canvas.px(3.6), 0, 2 * kPi, ink::kAccent);
}

}  // namespace tumble::render
