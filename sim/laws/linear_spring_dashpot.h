#pragma once
#include <cmath>

#include "core/units.h"
#include "sim/laws/real.h"

// Linear spring and dashpot with Coulomb friction (Mishra & Rajamani 1992, fig. 1 and eqs 1, 13, 14; tangential spring
// with history after Cundall & Strack 1979).
//
//   normal      F_n = k_n d + C v_n            d overlap [m], v_n closing speed [m/s]; > 0 pushes apart
//   tangential  F_t = -k_t s,  |F_t| <= mu |F_n|    s tangential displacement since the first touch [m]
//   damping     C = -2 ln e sqrt(m k_n) / sqrt(ln^2 e + pi^2)     m effective mass [kg] (eq. 13)
//
// F_n is not cut off where the dashpot pulls at the end of an impact: eq. 13 gives the restitution e only for the whole
// half wave of the oscillator. A spring at the Coulomb limit is wound back to it; there is no tangential dashpot.
// Valid for overlaps far below the radii; the contact lasts pi sqrt(m / k_n), whatever the speed.
//
// Energy, exactly as the central differences spend it. A force that acts at step n does the work F_n (d_n+1 - d_n-1) /
// 2 on the bodies. Summed by parts this is the trapezoid of the force over each step's change of overlap, so that
// - the normal spring holds k_n d^2 / 2 at every step and nothing is lost in it, but for the first and the last step,
//   where the trapezoid reaches outside the contact; that share, of second order in the time step, goes to the losses;
// - the tangential spring loses (mean spring force) x (what it is wound back), and what it holds when the contact
// parts.
namespace tumble::sim {

struct LinearSpringDashpot {
  double normal_stiffness = 0;      // k_n [N/m], > 0
  double tangential_stiffness = 0;  // k_t [N/m], >= 0
  double friction = 0;              // mu, >= 0
  double restitution = 1;           // e, (0, 1]
};

// Share of critical damping: e = exp(-pi z / sqrt(1 - z^2)).
inline double damping_ratio(double restitution) {
  const double l = std::log(restitution);
  return -l / std::sqrt(l * l + kPi * kPi);
}

// C [N s/m] of eq. 13, less what the time step adds to it. Central differences with the velocity foreseen from the last
// step act on an oscillator as if its stiffness were larger by q (1/12 - 5/3 z^2) and its damping by q (1/2 - 5/3 z^2),
// q = (w dt)^2 (modified equation, second order); the restitution hangs on their ratio C / sqrt(k) alone. The first and
// the last step, where the foreseen velocity knows nothing of the dashpot's jump, add 0.76 q z (1 - z^2)^(3/2):
// measured, as the mean over all phases of the impact within a step, for e from 0.1 to 0.8.
struct Damping {
  double twice_ratio = 0, excess = 0, stiffness = 0, time_step = 0;

  Damping() = default;
  Damping(const LinearSpringDashpot& law, double dt)
      : twice_ratio(2 * damping_ratio(law.restitution)), stiffness(law.normal_stiffness), time_step(dt) {
    const double z = twice_ratio / 2;
    excess = (11 - 20 * z * z) / 24 + 0.76 * z * std::pow(1 - z * z, 1.5);
  }
  double of(double effective_mass) const {
    const double q = stiffness / effective_mass * time_step * time_step;
    return twice_ratio * std::sqrt(effective_mass * stiffness) / (1 + q * excess);
  }
};

// What a contact remembers from step to step; all zero while apart.
template <class Real>
struct BasicContactState {
  Real overlap = 0;       // d [m]
  Real dashpot = 0;       // C v_n [N]
  Real spring = 0;        // s [m]
  Real normal_lost = 0;   // energy lost since the first touch, in the dashpot [J]
  Real sliding_lost = 0;  // likewise, in what the tangential spring was wound back [J]
};
using ContactState = BasicContactState<double>;

// Motion of a touching pair at one step.
template <class Real>
struct BasicTouch {
  Real overlap = 0;   // d [m]
  Real closing = 0;   // v_n at this step [m/s]
  Real approach = 0;  // growth of the overlap during the step that led here, from the velocities [m]
  Real slide = 0;     // tangential displacement during that step [m]
  Real damping = 0;   // C of the pair [N s/m]
};
using Touch = BasicTouch<double>;

template <class Real>
struct BasicReaction {
  Real normal = 0;        // F_n [N]
  Real tangential = 0;    // F_t [N]
  Real normal_loss = 0;   // [J] since the last step
  Real sliding_loss = 0;  // [J] since the last step
  Real couple = 0;        // against rolling [N m]; 0 for this law
  Real rolling_loss = 0;  // [J] since the last step; 0 for this law
};
using Reaction = BasicReaction<double>;

// A contact begins and ends within a step, and whole steps of a force that jumps at the edge (dashpot, cohesion) would
// make the restitution err in the first order of the time step, by up to pi z dt / (contact time). With s = d / (|v|
// dt) steps to or from the edge, the weights below add up to the contact's true time: w(s) + w(s + 1) = s + 3/2. They
// are continuous and vanish at the edge, so that it does not matter whether a last sliver of overlap is met or missed.
template <class Real>
Real edge_weight(const Real& overlap, const Real& closing, double time_step) {
  using std::abs;
  const Real reach = abs(closing) * time_step;
  const Real s = overlap / reach;
  return select(overlap < 2 * reach, select(s < Real(1), 1.5 * s, 2 - 0.5 * s), Real(1));
}

// Share of the step in which a pair first touches that lies after the touch: only that winds the tangential spring.
template <class Real>
Real touched_share(const BasicTouch<Real>& now) {
  return select(now.overlap < now.approach, now.overlap / now.approach, Real(1));
}

// The spring's displacement, wound back to what the limit of friction holds.
template <class Real>
Real held_within(const Real& wound, const Real& limit, double stiffness) {
  using std::abs;
  using std::copysign;
  const double compliance = 1 / stiffness;
  return select(stiffness * abs(wound) > limit, copysign(limit * compliance, wound), wound);
}

// `first`: the pair did not touch at the step before.
template <class Real>
BasicReaction<Real> touch(const LinearSpringDashpot& law, const BasicTouch<Real>& now, bool first, double time_step,
                          BasicContactState<Real>& state) {
  using std::abs;
  const double k_n = law.normal_stiffness, k_t = law.tangential_stiffness;
  const Real dashpot = now.damping * now.closing * edge_weight(now.overlap, now.closing, time_step);
  BasicReaction<Real> r;
  r.normal = k_n * now.overlap + dashpot;
  const Real wound = state.spring + now.slide;
  const Real spring = held_within(first ? touched_share(now) * wound : wound, law.friction * abs(r.normal), k_t);
  r.tangential = -k_t * spring;

  const Real before = first ? now.overlap - now.approach : state.overlap;
  r.normal_loss = 0.5 * (state.dashpot + dashpot) * (now.overlap - before);
  if (first) r.normal_loss -= 0.5 * k_n * now.overlap * before;
  r.sliding_loss = 0.5 * k_t * (state.spring + spring) * (wound - spring);

  state.overlap = now.overlap;
  state.dashpot = dashpot;
  state.spring = spring;
  state.normal_lost += r.normal_loss;
  state.sliding_lost += r.sliding_loss;
  return r;
}

// The losses of the step in which the pair came apart; `now.overlap` < 0. The state's `lost` is then the impact's.
inline Reaction part(const LinearSpringDashpot& law, const Touch& now, ContactState& state) {
  Reaction r;
  r.normal_loss =
      0.5 * state.dashpot * (now.overlap - state.overlap) + 0.5 * law.normal_stiffness * state.overlap * now.overlap;
  r.sliding_loss = 0.5 * law.tangential_stiffness * state.spring * (state.spring + now.slide);
  state.normal_lost += r.normal_loss;
  state.sliding_lost += r.sliding_loss;
  return r;
}

inline double elastic_energy(const LinearSpringDashpot& law, const ContactState& state) {
  return 0.5 * law.normal_stiffness * state.overlap * state.overlap +
         0.5 * law.tangential_stiffness * state.spring * state.spring;
}

}  // namespace tumble::sim
