#pragma once
#include <algorithm>

#include "sim/effects/fluid_drag.h"
#include "sim/laws/real.h"

// A pool of slurry, level and at rest in the lab: a ball immersed to the depth h is lifted by what it displaces,
//
//   F_b = rho g V(h),   V(h) = pi h^2 (3 r - h) / 3,   0 <= h <= 2 r,
//
// and is dragged as in fluid_drag, in the proportion V(h) / V(2 r). The pool's surface stays level and where it is: the
// slurry that balls displace or lifters carry up is not followed.
namespace tumble::sim {

struct SlurryPool {
  FluidDrag slurry;
  double surface = 0;  // height against the axis [m]
  double gravity = 0;  // g [m/s2]

  bool on() const { return slurry.density > 0; }
  template <class Real>
  Real depth(const Real& y, const Real& radius) const {
    const Real below = surface - (y - radius);
    return select(below < Real(0), Real(0), select(below > 2 * radius, 2 * radius, below));
  }
  template <class Real>
  Real volume(const Real& depth, const Real& radius) const {
    return kPi * depth * depth * (3 * radius - depth) * (1.0 / 3);
  }
  template <class Real>
  Real lift(const Real& depth, const Real& radius) const {
    return slurry.density * gravity * volume(depth, radius);
  }
  // Of the lift, 0 for a ball that only touches the surface [J].
  double potential(double y, double radius) const {
    const double h = depth(y, radius);
    const double deeper = std::max(0.0, surface - y - radius);
    return slurry.density * gravity * (kPi * h * h * h * (4 * radius - h) / 12 + volume(2 * radius, radius) * deeper);
  }
};

inline SlurryPool make_slurry_pool(const Config& config, double gravity) {
  if (!has_effect(config, "slurry_pool")) return {};
  const auto value = [&](const char* parameter) { return effect_value(config, "slurry_pool", parameter); };
  return {{value("viscosity"), value("density"), value("drag_coefficient")},
          value("level") * config.mill.diameter / 2,
          gravity};
}

}  // namespace tumble::sim
