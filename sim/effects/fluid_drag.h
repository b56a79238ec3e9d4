#pragma once
#include <cmath>

#include "core/effects.h"
#include "core/units.h"

// Drag of a fluid at rest in the lab on a sphere of radius r:
//
//   F = -(6 pi eta r + C_d rho pi r^2 |v| / 2) v       M = -8 pi eta r^3 omega
//
// Stokes (1851) for slow motion, Newton's quadratic law for fast motion, added, which joins both limits; the couple is
// Stokes' for a slowly spinning sphere (Lamb, Hydrodynamics, art. 334). No added mass, no lift, no neighbours.
namespace tumble::sim {

struct FluidDrag {
  double viscosity = 0;         // eta [Pa s]
  double density = 0;           // rho [kg/m3]
  double drag_coefficient = 0;  // C_d

  bool on() const { return viscosity > 0 || density > 0; }
  // Force over velocity [kg/s], couple over spin [N m s].
  template <class Real>
  Real per_velocity(const Real& radius, const Real& speed) const {
    return kPi * radius * (6 * viscosity + 0.5 * drag_coefficient * density * radius * speed);
  }
  template <class Real>
  Real per_spin(const Real& radius) const {
    return 8 * kPi * viscosity * radius * radius * radius;
  }
};

inline FluidDrag make_fluid_drag(const Config& config) {
  if (!has_effect(config, "fluid_drag")) return {};
  return {effect_value(config, "fluid_drag", "viscosity"), effect_value(config, "fluid_drag", "density"),
          effect_value(config, "fluid_drag", "drag_coefficient")};
}

}  // namespace tumble::sim
