#pragma once
#include <optional>
#include <span>
#include <vector>

#include "core/statistics.h"

// Restitution from balls that are dropped on a plate, or that swing against one another (Mishra & Rajamani 1992, p.
// 602, eqs 11 and 12).
//
//   drop      e = sqrt(h2 / h1)                      h1 fall height, h2 rebound height
//   pendulum  e = (1 + m2 / m1) sqrt(h2 / h1) - 1    h1 fall height of the striker m1, h2 height that the ball m2
//             reaches, which was at rest: m1 v1 = m1 u1 + m2 u2, u2 - u1 = e v1 give u2 = m1 (1 + e) v1 / (m1 + m2).
//             Equal masses give eq. 12.
//   damping   C = -2 ln e sqrt(m k_n) / sqrt(ln^2 e + pi^2), m the effective mass (eq. 13)
namespace tumble::diagnose {

struct Bounce {
  double fall_height = 0;       // h1 [m], > 0
  double rebound_height = 0;    // h2 [m], >= 0
  double fall_uncertainty = 0;  // one standard deviation [m]; 0 = not given
  double rebound_uncertainty = 0;
  double ball_mass = kNotGiven;    // of the falling ball [kg]
  double ball_radius = kNotGiven;  // [m]
  double target_mass = kNotGiven;  // pendulum: of the ball at rest [kg]; not given = the same
};

enum class BounceKind { kDrop, kPendulum };

// Speed of the impact [m/s] with the restitution found from it; se from the heights' uncertainties, NaN without any.
struct Impact {
  double speed = 0;
  Estimate restitution;
};
Impact impact_of(const Bounce& bounce, BounceKind kind);

// Balls of one size.
struct BallGroup {
  double ball_mass = kNotGiven, ball_radius = kNotGiven, target_mass = kNotGiven;
  double effective_mass = kNotGiven;  // m of eq. 13 [kg]; NaN where no mass is given
  std::size_t impacts = 0;
  Estimate restitution;
  Estimate damping;  // C [N s/m]; NaN without stiffness or mass
};

// e(v) = e0 (1 - drop (1 - exp(-v / speed))): the effect impact_restitution.
struct FallingRestitution {
  Estimate at_rest;  // e0
  Estimate drop;
  Estimate speed;  // v_e [m/s]
};

struct RestitutionResult {
  std::vector<Impact> impacts;  // in the order of the data
  Estimate mean;                // NaN se: a single impact without uncertainties
  std::vector<BallGroup> groups;
  Estimate slope_speed;  // de/dv [s/m]; NaN where the speeds do not differ
  Estimate slope_size;   // de/dr [1/m], by radius, or by the radius of a steel ball of that mass; NaN likewise
  bool speed_matters = false, size_matters = false;  // the slope is not 0 by 95 %
  std::optional<FallingRestitution> falling;         // only where the speeds span enough to fix it
  const char* why_not_falling = "";                  // one line, where it is not
};

// The mean weighs impacts by their uncertainties and by what they scatter beyond them (Paule & Mandel 1982); balls of
// different size that differ more than their errors widen its error (Birge 1932).
RestitutionResult restitution_from(std::span<const Bounce> bounces, BounceKind kind,
                                   const Estimate& normal_stiffness = {});

// C of eq. 13 [N s/m] with its error.
Estimate damping_constant(const Estimate& restitution, const Estimate& normal_stiffness, double effective_mass);

}  // namespace tumble::diagnose
