#pragma once
#include <span>
#include <vector>

#include "diagnose/contact_events.h"
#include "sim/config_laws.h"

namespace tumble::diagnose {

enum class Law {
  kDrag,
  kLift,
  kEnds,
  kSpinDecay,
  kBallRestitution,
  kWallRestitution,
  kBallFriction,
  kWallFriction,
  kRolling,
};

// What one flight or impact tells of a law: y is the sum of `up` over that of `down`, among those whose key lies in a
// range. One event may be seen in two ways; these follow one another.
struct LawSample {
  int event = 0;
  double key = 0;  // what it is sorted by, of other frames than up and down where their noise would matter
  double x = 0;    // in the same unit
  double up = 0, down = 0;
  double model = 0;  // `up` as the model has it; 0 without one
};

// `model` may be null. As `observer` would have it.
std::vector<LawSample> samples_of(Law law, std::span<const FlightWindow> flights, std::span<const SeenImpact> impacts,
                                  const Config& config, const sim::ConfigLaws* model, const Observer& observer);

// Mean over the time of a flight's window of a vector that hangs on place and velocity, with the weight that the fitted
// acceleration gives each moment: (1 - s^2)^2 of s from -1 to 1 at its ends.
template <class Vector, class Of>
Vector mean_over(const FlightWindow& w, const Of& of) {
  Vector sum{};
  double weights = 0;
  for (int k = -3; k <= 3; ++k) {
    const double s = k / 4.0, t = s * w.half, weight = (1 - s * s) * (1 - s * s);
    const Vector v =
        of(w.x + t * w.vx + 0.5 * t * t * w.ax, w.y + t * w.vy + 0.5 * t * t * w.ay, w.vx + t * w.ax, w.vy + t * w.ay);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += weight * v[i];
    weights += weight;
  }
  for (auto& v : sum) v /= weights;
  return sum;
}

// A flight as an observer sees it.
FlightWindow seen_by(const Observer& observer, FlightWindow w);

}  // namespace tumble::diagnose
