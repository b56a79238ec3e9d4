#pragma once
#include <cmath>

#include "core/effects.h"
#include "core/units.h"

// A drive whose speed varies n times a revolution about its mean W:
//
//   theta(t) = W t + (a / n) (sin(n W t + phi) - sin phi),   omega(t) = W (1 + a cos(n W t + phi))
//
// Given in closed form, so that the mill's angle is never summed up. Kinematic: the drive holds this speed whatever the
// torque (a fault of coupling or gear, not a weak motor).
namespace tumble::sim {

struct SpeedRipple {
  double amplitude = 0;  // a
  double order = 1;      // n [1/rev]
  double phase = 0;      // phi [rad]

  double angle(double turned) const {
    return amplitude == 0 ? turned : turned + amplitude / order * (std::sin(order * turned + phase) - std::sin(phase));
  }
  double share(double turned) const { return amplitude == 0 ? 1 : 1 + amplitude * std::cos(order * turned + phase); }
};

inline SpeedRipple make_speed_ripple(const Config& config) {
  if (!has_effect(config, "speed_ripple")) return {};
  return {effect_value(config, "speed_ripple", "amplitude"), effect_value(config, "speed_ripple", "order"),
          effect_value(config, "speed_ripple", "phase_deg") * kPi / 180};
}

}  // namespace tumble::sim
