#pragma once
#include <cmath>

#include "core/effects.h"
#include "sim/laws/real.h"

// Friction that falls with the sliding speed of the contact: mu(v) = mu (1 - drop (1 - exp(-v / v_s))).
//
// The 1992 paper saw excessive sliding at high speed and let the coefficient fall with the MILL's speed
// (contact.friction_drop_at_critical); the physics behind it is this one (Moore, Principles and Applications of
// Tribology, 1975). Holds for dry and boundary-lubricated sliding.
namespace tumble::sim {

struct FrictionWeakening {
  double drop = 0;           // share lost at high speed
  double sliding_speed = 1;  // v_s [m/s]

  template <class Real>
  Real share_at(const Real& v) const {
    return 1 - drop * (1 - decay(Real(v / sliding_speed)));
  }
};

inline FrictionWeakening make_friction_weakening(const Config& config) {
  return {effect_value(config, "friction_weakening", "drop"),
          effect_value(config, "friction_weakening", "sliding_speed")};
}

}  // namespace tumble::sim
