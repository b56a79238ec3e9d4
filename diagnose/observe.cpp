#include "diagnose/observe.h"

#include <cmath>

#include "core/mill_shape.h"
#include "core/quantile.h"
#include "core/units.h"
#include "diagnose/contact_laws.h"
#include "diagnose/free_flight.h"
#include "diagnose/lost_balls.h"
#include "diagnose/seen_charge.h"
#include "diagnose/tracking_noise.h"

namespace tumble::diagnose {
namespace {

constexpr double kShortestSpan = 0.004;  // [s]
constexpr double kOfAnEnd = 4;           // samples

// The first, or last, of a series that is known: a mean of a few.
double end_of(const std::vector<double>& series, bool last) {
  double sum = 0, known = 0;
  for (std::size_t i = 0; i < series.size() && known < kOfAnEnd; ++i) {
    const double v = series[last ? series.size() - 1 - i : i];
    if (!std::isnan(v)) sum += v, ++known;
  }
  return sum / known;
}

// Weight of the charge times the place of its centre of mass, as the observer has it, and what the charge gains in
// angular momentum besides [N m of one slice].
double held_by_torque(const Measurement& m, const Observer& observer) {
  const SeenCharge charge = see_charge(m);
  const double weight = slice_mass(m.config, class_counts(m.config)) * kGravity;
  double moment = 0, height = 0;
  for (std::size_t f = 0; f < charge.time.size(); ++f) {
    moment += charge.moment[f] / double(charge.time.size());
    height += charge.height[f] / double(charge.time.size());
  }
  const double gained = (end_of(charge.angular_momentum, true) - end_of(charge.angular_momentum, false)) /
                        (charge.time.back() - charge.time.front());
  return (1 + observer.scale) * (std::cos(observer.rotation) * moment - std::sin(observer.rotation) * weight * height) +
         (std::isfinite(gained) ? gained : 0);
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
    const auto look_at = [&](const std::vector<SeenFrame>& frames) {
      MapSums maps(layout, shape.radius, shape.tip_radius, mean / balls, {{span, observer}});
      for (const SeenFrame& frame : frames) maps.add(frame.time, frame.mill_angle, frame.balls);
      Observation maps_alone;
      maps.finish(0, maps_alone);
      return maps_alone;
    };
    const std::vector<SeenFrame> whole = with_lost_balls(m.frames);
    FreeFlights flights(shape.tip_radius);
    ContactLaws laws(m.config);
    for (const SeenFrame& frame : whole) flights.add(frame.time, frame.balls);
    for (const SeenFrame& frame : m.frames) laws.add(frame.time, frame.mill_angle, frame.balls);
    const Observation maps = look_at(whole);
    for (std::size_t i = layout.first(Observable::kOccupancy); i < layout.first(Observable::kFlight); ++i)
      seen.value[i] = maps.value[i];
    // Noise of tracking blurs the maps: as much more of it blurs them as much again (SIMEX: Cook & Stefanski 1994).
    if (const double noise = noise_of_places(m.frames); noise > 0) {
      const Observation blurred = look_at(noisier(whole, noise));
      for (std::size_t i = layout.first(Observable::kOccupancy); i < layout.first(Observable::kFlight); ++i)
        seen.value[i] -= blurred.value[i] - maps.value[i];
    }
    flights.finish(layout, observer, seen);
    const LawNumbers told = laws.numbers(observer);
    const auto first = static_cast<std::ptrdiff_t>(layout.first(Observable::kLaws));
    std::copy(told.value.begin(), told.value.end(), seen.value.begin() + first);
    for (std::size_t i = 0; i < told.se.size(); ++i)
      seen.noise[static_cast<std::size_t>(first) + i] = or_nothing(told.se[i]);
    if (std::isnan(m.frames.front().mill_angle))
      for (std::size_t k = 0; k < layout.count(Observable::kPockets); ++k)
        seen.value[layout.first(Observable::kPockets) + k] = kNotGiven;
  }

  const Estimate torque = m.torque;
  if (!std::isnan(torque.value)) {
    const std::size_t at = layout.first(Observable::kTorque), closure = layout.first(Observable::kClosure);
    seen.value[at] = torque.value - torque_offset;
    seen.noise[at] = seen.noise[closure] = m.torque_error;
    if (!m.frames.empty()) seen.value[closure] = seen.value[at] - held_by_torque(m, observer);
  }
  const std::size_t angles = layout.first(Observable::kAngles);
  for (std::size_t k = 2; k < kScalarData.size(); ++k) {
    const Estimate& angle = e.*kScalarData[k].measured;
    if (std::isnan(angle.value)) continue;
    seen.value[angles + k - 2] = angle.value + observer.rotation * 180 / kPi;
    seen.noise[angles + k - 2] = or_nothing(angle.se);
  }
  return seen;
}

}  // namespace tumble::diagnose
