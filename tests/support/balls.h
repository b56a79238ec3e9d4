#pragma once
#include <cmath>
#include <vector>

#include "core/config.h"
#include "core/units.h"
#include "sim/running_mill.h"

// Small scenes for the physics tests: a resting smooth shell, a few balls, one contact law.
namespace tumble::sim {

struct Ball {
  double radius = 0.012, mass = 0.06;
  double x = 0, y = 0, vx = 0, vy = 0, spin = 0;
};

inline Charge charge_of(const std::vector<Ball>& balls) {
  Balls bodies;
  for (const Ball& b : balls) {
    bodies.radius.push_back(b.radius);
    bodies.mass.push_back(b.mass);
  }
  Charge c = make_charge(bodies);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    c.x[i] = balls[i].x;
    c.y[i] = balls[i].y;
    c.vx[i] = balls[i].vx;
    c.vy[i] = balls[i].vy;
    c.spin[i] = balls[i].spin;
  }
  return c;
}

// The paper's springs; no friction unless asked for.
inline LinearSpringDashpot springs(double restitution, double friction = 0) {
  return {4e5, 3e5, friction, restitution};
}

inline MillModel smooth_shell(double radius, double gravity, const LinearSpringDashpot& law, double time_step) {
  MillModel m;
  m.shell.radius = m.shell.tip_radius = radius;
  m.ball = m.wall = law;
  m.gravity = gravity;
  m.time_step = time_step;
  return m;
}

// Effects as MILL.toml names them: {{"cohesion", {{"force", {0.6}}}}}.
using Effects = std::map<std::string, EffectSettings>;

// Steps per impact of two 60 g balls on the paper's springs: fine enough that only the claim is measured.
inline constexpr double kFineStep = 4e-6;

// A smooth mill of 12 mm balls that stands still, through the same door as any config: so that an effect's row in the
// registry is proven with its physics. `friction`, `restitution` of every contact.
inline Config smooth_mill(double radius, const Effects& effects, double friction = 0, double restitution = 0.4) {
  Config c;
  c.mill.diameter = 2 * radius;
  c.mill.speed = 0.7;
  c.charge.count = 1;
  c.charge.balls = {{0.012, 0.06, 1}};
  c.contact.friction = friction;
  c.contact.restitution = restitution;
  c.effects = effects;
  return c;
}
inline MillModel resting(const Config& config, double time_step = kFineStep) {
  MillModel m = make_mill_model(config);
  m.speed = 0;
  m.time_step = time_step;
  return m;
}

// The bottom of a shell so wide that it is flat over the metre that a test needs; a slope where the shell rises.
inline constexpr double kFlat = 1000;  // [m]

// A ball at rest on its springs, `slope` [rad] up the shell to the right, with `speed` uphill. `pressed`: by what force
// beside its weight [N].
inline Ball on_floor(const MillModel& m, double slope = 0, double speed = 0, double pressed = 0) {
  Ball b;
  const double sag = (b.mass * m.gravity * std::cos(slope) + pressed) / m.wall.springs.normal_stiffness;
  const double path = m.shell.radius - b.radius + sag;
  b.x = path * std::sin(slope);
  b.y = -path * std::cos(slope);
  b.vx = speed * std::cos(slope);
  b.vy = speed * std::sin(slope);
  return b;
}

// For scenes that begin under forces: start_mill gives the velocities their first half step of gravity alone, which is
// right for a charge at rest; here they get that of springs and fluids too, so that the order of the method shows.
inline RunningMill start_under_forces(const MillModel& model, Charge charge) {
  constexpr double kInstant = 1e-10;
  MillModel instant = model;
  instant.time_step = kInstant;
  RunningMill probe = start_mill(instant, charge);
  advance(probe);
  const double steps = model.time_step / kInstant;
  for (std::size_t i = 0; i < charge.size(); ++i) {
    charge.vx[i] += probe.charge.ax[i] * steps;
    charge.vy[i] += probe.charge.ay[i] * steps + 0.5 * model.gravity * model.time_step;
    charge.spin[i] += probe.charge.alpha[i] * steps;
  }
  return start_mill(model, charge);
}

inline void advance_by(RunningMill& mill, double seconds) {
  const auto steps = std::llround(seconds / mill.model.time_step);
  for (std::int64_t k = 0; k < steps; ++k) advance(mill);
}

// Velocities at the positions' own time.
inline double vx_of(const RunningMill& mill, std::size_t i) { return mill.charge.vx[i] - mill.charge.ax[i]; }
inline double vy_of(const RunningMill& mill, std::size_t i) { return mill.charge.vy[i] - mill.charge.ay[i]; }
inline double spin_of(const RunningMill& mill, std::size_t i) { return mill.charge.spin[i] - mill.charge.alpha[i]; }

inline double lost_by(const RunningMill& mill, Cause cause) {
  return mill.ledger.dissipated[static_cast<std::size_t>(cause)];
}

}  // namespace tumble::sim
