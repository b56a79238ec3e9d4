#pragma once
#include <cmath>

#include "sim/effects/cohesion.h"
#include "sim/effects/friction_weakening.h"
#include "sim/effects/hertz_contact.h"
#include "sim/effects/impact_restitution.h"
#include "sim/effects/rolling_resistance.h"
#include "sim/laws/linear_spring_dashpot.h"
#include "sim/laws/table.h"

// The law of one kind of contact (ball on ball, or ball on wall): the springs and dashpot of the 1992 paper, and the
// effects that change them. Each effect is one member whose zeros switch it off; with all of them off the law is
// `springs` alone (`plain`), and the loops over contacts run without any of this.
//
//   pressure    P = F(d) + C(d) v_n          F: spring, linear and Hertzian in shares; C: see hertz_contact.h
//   normal      F_n = P - F_c                F_c: cohesion
//   tangential  |F_t| <= mu(v_t) |P|         mu falls with the sliding speed: friction_weakening, tabulated_friction
//   rolling     |M| <= mu_r R |P|            rolling_resistance
//   restitution e(v_n at first touch)        impact_restitution, tabulated_restitution
//
// Losses are the trapezoid of the force over each step's change of overlap, less what the springs hold: that is the
// work which central differences do on the bodies (linear_spring_dashpot.h), whatever the force law.
namespace tumble::sim {

struct ContactModel {
  LinearSpringDashpot springs;
  HertzContact hertz;
  ImpactRestitution restitution;
  Cohesion cohesion;
  FrictionWeakening friction;
  RollingResistance rolling;
  Table tabulated_friction, tabulated_restitution;  // in place of the springs' friction and restitution

  ContactModel() = default;
  ContactModel(const LinearSpringDashpot& s) : springs(s) {}  // implicit: the plain law
  bool plain() const {
    return hertz.share == 0 && restitution.drop == 0 && cohesion.per_radius == 0 && friction.drop == 0 &&
           rolling.coefficient == 0 && !tabulated_friction.on() && !tabulated_restitution.on();
  }
  // Of an impact that begins with this normal speed [m/s].
  double restitution_at(double speed) const {
    const double e = tabulated_restitution.on() ? tabulated_restitution.at(std::abs(speed)) : springs.restitution;
    return restitution.drop == 0 ? e : e * restitution.share_at(speed);
  }
  // Of a contact that slides at this speed, before it weakens [m/s].
  template <class Real>
  Real friction_at(const Real& speed) const {
    return tabulated_friction.on() ? tabulated_friction.at(speed) : Real(springs.friction);
  }
};

// What such a contact remembers beside ContactState.
template <class Real>
struct BasicTermState {
  Real force = 0;    // F_n [N]
  Real stored = 0;   // U of the normal spring, cohesion included [J]
  Real damping = 0;  // C of the linear law at this contact's restitution [N s/m]
  Real roll = 0;     // theta_r [rad]
};
using TermState = BasicTermState<double>;

// The pair, and its rolling during the step.
template <class Real>
struct BasicPairing {
  Real effective_mass = 0;    // [kg]; looked at in the first step alone
  Real effective_radius = 0;  // R [m]
  Real roll = 0;              // [rad] since the last step
};
using Pairing = BasicPairing<double>;

template <class Real>
Real rolling_stiffness(const ContactModel& law, const Real& effective_radius) {
  return law.springs.tangential_stiffness * effective_radius * effective_radius;
}

// C of a contact that begins: at its own restitution.
inline double damping_from(const ContactModel& law, const Touch& now, const Pairing& pair, double time_step) {
  if (law.restitution.drop == 0 && !law.tabulated_restitution.on()) return now.damping;
  LinearSpringDashpot slower = law.springs;
  slower.restitution = law.restitution_at(now.closing);
  return Damping(slower, time_step).of(pair.effective_mass);
}

// `terms.damping` is set by the caller when the contact begins (damping_from).
template <class Real>
BasicReaction<Real> touch(const ContactModel& law, const BasicTouch<Real>& now, const BasicPairing<Real>& pair,
                          bool first, double time_step, BasicContactState<Real>& state, BasicTermState<Real>& terms) {
  using std::abs;
  using std::copysign;
  using std::sqrt;
  const LinearSpringDashpot& s = law.springs;
  const Real d = now.overlap;
  Real spring = s.normal_stiffness * d, stored = 0.5 * spring * d, stiffening = 1;
  if (law.hertz.share != 0) {
    const Real hertz = law.hertz.stiffness * sqrt(pair.effective_radius * d) * d;
    spring += law.hertz.share * (hertz - spring);
    stored += law.hertz.share * (0.4 * hertz * d - stored);
    stiffening = spring / sqrt(2 * stored * s.normal_stiffness);
  }
  const Real weight = edge_weight(d, now.closing, time_step);
  const Real pressure = spring + terms.damping * stiffening * now.closing * weight;
  const Real attraction = law.cohesion.per_radius * pair.effective_radius;
  stored -= attraction * d;

  BasicReaction<Real> r;
  r.normal = pressure - attraction * weight;
  r.normal_loss =
      0.5 * (terms.force + r.normal) * (d - (first ? d - now.approach : state.overlap)) - (stored - terms.stored);

  const Real sliding = abs(now.slide) / time_step;
  Real limit = law.friction_at(sliding) * abs(pressure);
  if (law.friction.drop != 0) limit *= law.friction.share_at(sliding);
  const double k_t = s.tangential_stiffness;
  const Real wound = state.spring + now.slide;
  const Real held = held_within(first ? touched_share(now) * wound : wound, limit, k_t);
  r.tangential = -k_t * held;
  r.sliding_loss = 0.5 * k_t * (state.spring + held) * (wound - held);

  if (law.rolling.coefficient != 0) {
    const Real k_r = rolling_stiffness(law, pair.effective_radius);
    const Real most = law.rolling.coefficient * pair.effective_radius * abs(pressure);
    const Real turned = terms.roll + pair.roll;
    const Real kept = select(k_r * abs(turned) > most, copysign(most / k_r, turned), turned);
    r.couple = -k_r * kept;
    r.rolling_loss = 0.5 * k_r * (terms.roll + kept) * (turned - kept);
    terms.roll = kept;
  }
  terms.force = r.normal;
  terms.stored = stored;
  state.overlap = d;
  state.spring = held;
  state.normal_lost += r.normal_loss;
  state.sliding_lost += r.sliding_loss;
  return r;
}

// The losses of the step in which the pair came apart.
inline Reaction part(const ContactModel& law, const Touch& now, const Pairing& pair, ContactState& state,
                     TermState& terms) {
  Reaction r;
  r.normal_loss = 0.5 * terms.force * (now.overlap - state.overlap) + terms.stored;
  r.sliding_loss = 0.5 * law.springs.tangential_stiffness * state.spring * (state.spring + now.slide);
  r.rolling_loss = 0.5 * rolling_stiffness(law, pair.effective_radius) * terms.roll * (terms.roll + pair.roll);
  state.normal_lost += r.normal_loss;
  state.sliding_lost += r.sliding_loss;
  return r;
}

inline double elastic_energy(const ContactModel& law, double effective_radius, const ContactState& state,
                             const TermState& terms) {
  return terms.stored + 0.5 * law.springs.tangential_stiffness * state.spring * state.spring +
         0.5 * rolling_stiffness(law, effective_radius) * terms.roll * terms.roll;
}

}  // namespace tumble::sim
