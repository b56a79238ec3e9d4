#pragma once
#include <cmath>

#include "core/effects.h"
#include "sim/laws/real.h"

// Restitution that falls with the impact's speed: e(v) = e (1 - drop (1 - exp(-v / v_e))), v the normal speed at the
// first touch. The contact keeps that value until it parts, however the speed changes meanwhile.
//
// Metals deform plastically in fast impacts and give less back (Johnson, Contact Mechanics, 1985, ch. 11: e ~ v^(-1/4)
// once fully plastic). The saturating form has a finite e at rest and one parameter for size and one for onset.
namespace tumble::sim {

struct ImpactRestitution {
  double drop = 0;          // share lost in fast impacts
  double impact_speed = 1;  // v_e [m/s]

  template <class Real>
  Real share_at(const Real& v) const {
    using std::abs;
    return 1 - drop * (1 - decay(Real(abs(v) / impact_speed)));
  }
};

inline ImpactRestitution make_impact_restitution(const Config& config) {
  return {effect_value(config, "impact_restitution", "drop"),
          effect_value(config, "impact_restitution", "impact_speed")};
}

}  // namespace tumble::sim
