#pragma once
#include "sim/laws/table.h"

// Drag by a table of points (speed in the lab, c):
//
//   F = -c(|v|) (r / r_mean)^n v        r_mean the charge's number-mean radius [m]
//
// The table holds force over speed and not the force: constant outside then means Stokes' law beyond both ends, nothing
// jumps for a ball at rest, and Stokes' and Newton's drag together are exactly two points. n says how it grows with the
// ball: 1 as Stokes' drag, 2 as Newton's, 3 for a deceleration that is the same for all. No couple on the spin.
namespace tumble::sim {

struct TabulatedDrag {
  Table coefficient;       // [kg/s] of a ball of the mean radius
  double mean_radius = 1;  // [m]
  int radius_power = 1;    // n

  bool on() const { return coefficient.on(); }
  template <class Real>
  Real share_of(const Real& radius) const {
    Real share = 1;
    for (int k = 0; k < radius_power; ++k) share *= radius * (1 / mean_radius);
    return share;
  }
  // Force over velocity [kg/s].
  template <class Real>
  Real per_velocity(const Real& radius, const Real& speed) const {
    return share_of(radius) * coefficient.at(speed);
  }
};

inline TabulatedDrag make_tabulated_drag(const Config& config, double mean_radius) {
  return {make_table(config, "tabulated_drag", "coefficient"), mean_radius,
          static_cast<int>(effect_value(config, "tabulated_drag", "radius_power"))};
}

}  // namespace tumble::sim
