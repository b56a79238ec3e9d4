#pragma once
#include "core/effects.h"

// Friction of the two end walls of a slice, which turn with the shell, on every ball:
//
//   F = -k_t s,  |F| <= coefficient m g + pressure sum |F_n|
//
// s is the displacement of the ball's poles against the ends (a vector in the mill's frame, wound back to the limit, as
// the tangential spring of a contact), sum |F_n| the ball's contact forces: balls that stand a little out of line are
// pressed against the ends by their neighbours. The poles lie on the spin's axis: spin is not braked. The ends belong
// to the mill, so the moment of these forces is part of the torque.
//
// Coulomb friction with a history spring, Cundall & Strack (1979). In real one-layer mills (Moys and co-workers'
// slices) the ends rub on every ball.
namespace tumble::sim {

struct EndWallFriction {
  double coefficient = 0;  // limit over the ball's weight
  double pressure = 0;     // limit over the sum of its normal forces
  double stiffness = 0;    // k_t [N/m]

  // How far the spring may be wound [m].
  template <class Real>
  Real most_wound(const Real& mass, double gravity, const Real& pressed) const {
    return (coefficient * gravity * mass + pressure * pressed) * (1 / stiffness);
  }
  bool on() const { return coefficient > 0 || pressure > 0; }
};

inline EndWallFriction make_end_wall_friction(const Config& config, double tangential_stiffness) {
  return {effect_value(config, "end_wall_friction", "coefficient"),
          effect_value(config, "end_wall_friction", "pressure"), tangential_stiffness};
}

}  // namespace tumble::sim
