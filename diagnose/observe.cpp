#include "diagnose/observe.h"

#include <cmath>

#include "core/mill_shape.h"
#include "core/quantile.h"
#include "core/units.h"
#include "diagnose/free_flight.h"
#include "diagnose/seen_charge.h"

namespace tumble::diagnose {
namespace {

constexpr double kShortestSpan = 0.004;  // [s]

// Weight of the charge times the place of its centre of mass, as the observer has it [N m of one slice].
double weight_couple(const Measurement& m, const Observer& observer) {
  const SeenCharge charge = see_charge(m);
  const double weight = slice_mass(m.config, class_counts(m.config)) * kGravity;
  double moment = 0, height = 0;
  for (std::size_t f = 0; f < charge.time.size(); ++f) {
    moment += charge.moment[f] / double(charge.time.size());
    height += charge.height[f] / double(charge.time.size());
  }
  return (1 + observer.scale) * (std::cos(observer.rotation) * moment - std::sin(observer.rotation) * weight * height);
}

}  // namespace

double span_of(const Measurement& measurement) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < measurement.frames.size(); ++i)
    steps.push_back(measurement.frames[i].time - measurement.frames[i - 1].time);
  if (steps.empty()) return kNotGiven;
  const double step = quantile_of(std::move(steps), 0.5);
  return step * std::ceil(kShortestSpan / step - 1e-6);
}

Observation observe(const Measurement& m, const ObservationLayout& layout, double span, const Observer& observer,
                    double torque_offset) {
  Observation seen;
  seen.value.assign(layout.size(), kNotGiven);
  seen.noise.assign(layout.size(), 0);
  const Experiment& e = m.experiment;

  if (!m.frames.empty()) {
    const MillShape shape = make_mill_shape(m.config);
    const std::vector<int> counts = class_counts(m.config);
    double mean = 0, balls = 0;
    for (std::size_t k = 0; k < counts.size(); ++k) {
      mean += counts[k] * m.config.charge.balls[k].radius;
      balls += counts[k];
    }
    MapSums maps(layout, shape.radius, shape.tip_radius, mean / balls, {{span, observer}});
    FreeFlights flights(shape.tip_radius);
    for (const SeenFrame& frame : m.frames) {
      maps.add(frame.time, frame.mill_angle, frame.balls);
      flights.add(frame.time, frame.balls);
    }
    maps.finish(0, seen);
    flights.finish(layout, observer, seen);
    if (std::isnan(m.frames.front().mill_angle))
      for (std::size_t k = 0; k < layout.count(Observable::kPockets); ++k)
        seen.value[layout.first(Observable::kPockets) + k] = kNotGiven;
  }

  const Estimate torque = slice_torque(m);
  if (!std::isnan(torque.value)) {
    const std::size_t at = layout.first(Observable::kTorque), closure = layout.first(Observable::kClosure);
    seen.value[at] = torque.value - torque_offset;
    seen.noise[at] = seen.noise[closure] = std::isnan(torque.se) ? 0 : torque.se;
    if (!m.frames.empty()) seen.value[closure] = seen.value[at] - weight_couple(m, observer);
  }
  const std::size_t angles = layout.first(Observable::kAngles);
  for (std::size_t k = 2; k < kScalarData.size(); ++k) {
    const Estimate& angle = e.*kScalarData[k].measured;
    if (std::isnan(angle.value)) continue;
    seen.value[angles + k - 2] = angle.value + observer.rotation * 180 / kPi;
    seen.noise[angles + k - 2] = std::isnan(angle.se) ? 0 : angle.se;
  }
  return seen;
}

Estimate slice_torque(const Measurement& m) {
  const double slices = slice_count(m.config);
  const Experiment& e = m.experiment;
  if (!std::isnan(e.torque.value)) return {e.torque.value / slices, e.torque.se / slices};
  const double turning = speed_rpm(m.config.mill) * 2 * kPi / 60;
  return {e.power.value / turning / slices, e.power.se / turning / slices};
}

}  // namespace tumble::diagnose
