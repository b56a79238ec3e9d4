#include "sim/config_laws.h"

#include <cmath>

#include "sim/charge.h"
#include "sim/mill_model.h"

namespace tumble::sim {

struct ConfigLaws::Impl {
  MillModel model;
  const ContactModel& of(bool at_wall) const { return at_wall ? model.wall : model.ball; }
  Parting step_through(const Meeting& m, double phase) const;
};

ConfigLaws::ConfigLaws(const Config& config) : impl_(new Impl{make_mill_model(config)}) {}
ConfigLaws::~ConfigLaws() = default;
ConfigLaws::ConfigLaws(ConfigLaws&&) noexcept = default;

double ConfigLaws::restitution(bool at_wall, double normal_speed) const {
  return impl_->of(at_wall).restitution_at(normal_speed);
}

double ConfigLaws::friction(bool at_wall, double sliding_speed) const {
  const ContactModel& law = impl_->of(at_wall);
  return law.friction_at(sliding_speed) * law.friction.share_at(sliding_speed);
}

// One impact whose first touch falls `phase` of a step before its end.
ConfigLaws::Parting ConfigLaws::Impl::step_through(const Meeting& m, double phase) const {
  const ContactModel& law = of(m.at_wall);
  const double dt = model.time_step;
  const double mass = m.at_wall ? m.mass_i : m.mass_i * m.mass_j / (m.mass_i + m.mass_j);
  const double radius = m.at_wall ? m.radius_i : m.radius_i * m.radius_j / (m.radius_i + m.radius_j);
  const double per_i = 1 / inertia(m.mass_i, m.radius_i), per_j = m.at_wall ? 0 : 1 / inertia(m.mass_j, m.radius_j);
  Touch now;
  now.damping = Damping(law.springs, dt).of(mass);
  Pairing pair{mass, radius, 0};
  ContactState state;
  TermState terms;
  Parting out;
  double closing = m.closing, slip = m.slip, roll = m.roll, half_kick = 0;
  now.overlap = (phase - 1) * closing * dt;
  for (bool first = true; first || now.overlap > 0; first = false) {
    now.approach = closing * dt;
    now.overlap += now.approach;
    if (!(now.overlap > 0)) break;
    now.closing = closing + half_kick;
    now.slide = slip * dt;
    pair.roll = roll * dt;
    if (first) terms.damping = damping_from(law, now, pair, dt);
    const Reaction r = touch(law, now, pair, first, dt, state, terms);
    half_kick = -0.5 * dt * r.normal / mass;
    closing += 2 * half_kick;
    const double push = r.tangential * dt;
    slip += 3.5 * push / mass;  // spheres: 1 / m + r^2 / I of both
    roll += r.couple * dt * (per_i + per_j) - push * (m.radius_j * per_j - m.radius_i * per_i);
    out.sliding += push / mass;
    out.couple += r.couple * dt;
  }
  out.parting = -closing;
  return out;
}

ConfigLaws::Parting ConfigLaws::rebound(const Meeting& meeting) const {
  constexpr int kPhases = 4;
  Parting mean;
  for (int k = 0; k < kPhases; ++k) {
    const Parting p = impl_->step_through(meeting, (k + 0.5) / kPhases);
    mean.parting += p.parting / kPhases;
    mean.sliding += p.sliding / kPhases;
    mean.couple += p.couple / kPhases;
  }
  return mean;
}

double ConfigLaws::mill_speed() const { return impl_->model.speed; }

double ConfigLaws::spin_decay(const Flying& b) const {
  const BodyEffects& body = impl_->model.body;
  double couple = body.drag.on() ? body.drag.per_spin(b.radius) : 0;  // over spin [N m s]
  if (body.pool.on())
    couple += body.pool.volume(body.pool.depth(b.y, b.radius), b.radius) / body.pool.volume(2 * b.radius, b.radius) *
              body.pool.slurry.per_spin(b.radius);
  return couple / inertia(b.mass, b.radius);
}

std::array<double, 2> ConfigLaws::acceleration(const Flying& b) const {
  const MillModel& m = impl_->model;
  const double speed = std::hypot(b.vx, b.vy);
  double per_velocity = 0, lift = 0;
  if (m.body.drag.on()) per_velocity += m.body.drag.per_velocity(b.radius, speed);
  if (m.body.tabulated.on()) per_velocity += m.body.tabulated.per_velocity(b.radius, speed);
  if (m.body.pool.on()) {
    const double depth = m.body.pool.depth(b.y, b.radius);
    per_velocity += m.body.pool.volume(depth, b.radius) / m.body.pool.volume(2 * b.radius, b.radius) *
                    m.body.pool.slurry.per_velocity(b.radius, speed);
    lift = m.body.pool.lift(depth, b.radius);
  }
  std::array<double, 2> a{-per_velocity * b.vx / b.mass, (lift - per_velocity * b.vy) / b.mass};
  // Ends slide on a ball in flight: the spring that friction winds up first is a fraction of a micrometre.
  const double ux = b.vx + m.speed * b.y, uy = b.vy - m.speed * b.x, slip = std::hypot(ux, uy);
  if (m.body.ends.on() && slip > 0) {
    const double rub = m.body.ends.coefficient * m.gravity / slip;
    a[0] -= rub * ux;
    a[1] -= rub * uy;
  }
  return a;
}

}  // namespace tumble::sim
