#pragma once
#include "core/effects.h"

// Rolling resistance: a rotational spring that slips, as the tangential spring does.
//
//   M = -k_r theta_r,  |M| <= mu_r R |F_n|      theta_r relative rotation since the first touch, wound back to the
//   limit k_r = k_t R^2                               R = r_i r_j / (r_i + r_j), at the wall r [m]
//
// Iwashita & Oda, J. Eng. Mech. 124 (1998) 285; Ai et al., Powder Technol. 206 (2011) 269 (elastic-plastic spring,
// their model C, without the dashpot). A couple of constant size (their model A) would shake resting balls for ever.
// A sphere that rolls on a plane is slowed by (5/7) mu_r g.
namespace tumble::sim {

struct RollingResistance {
  double coefficient = 0;  // mu_r
};

inline RollingResistance make_rolling_resistance(const Config& config) {
  return {effect_value(config, "rolling_resistance", "coefficient")};
}

}  // namespace tumble::sim
