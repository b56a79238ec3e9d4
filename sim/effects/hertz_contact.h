#pragma once
#include <cmath>

#include "core/effects.h"

// A contact that stiffens as it is pressed, in any share with the linear spring:
//
//   F = (1 - s) k_n d + s k_h sqrt(R / R_0) d^(3/2),   k_h = (5/4) k_n / sqrt(d_0)
//
// R as in cohesion; R_0 and d_0 = v_0 sqrt(m_0 / k_n) are those of two mean balls: at the impact speed v_0 they overlap
// as much as by the linear law, so k_n keeps its meaning. Hertz (1882) for spheres (d^(3/2), ~ sqrt R); the 1992
// paper's Table 2 for layers of particles between the balls.
//
// The dashpot C(d) = 2 z sqrt(m) F(d) / sqrt(2 U(d)), U the work done on the spring, gives the restitution e at every
// speed: in the coordinate q = sqrt(2 U) the motion is that of the linear oscillator. For s = 1 it is the d^(1/4)
// dashpot of Tsuji et al. (1992) with the factor of Antypov & Elliott (2011).
namespace tumble::sim {

struct HertzContact {
  double share = 0;      // s, 0 linear to 1 Hertz
  double stiffness = 0;  // k_h / sqrt(R_0) [N/m^2]
};

// Two balls of the number-mean radius [m] and mass [kg] are the reference.
inline HertzContact make_hertz_contact(const Config& config, double normal_stiffness, double mean_radius,
                                       double mean_mass) {
  const double overlap =
      effect_value(config, "hertz_contact", "reference_speed") * std::sqrt(mean_mass / 2 / normal_stiffness);
  return {hertz_share(config), 1.25 * normal_stiffness / std::sqrt(overlap * mean_radius / 2)};
}

}  // namespace tumble::sim
