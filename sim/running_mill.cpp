#include "sim/running_mill.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "sim/contact_forces.h"

namespace tumble::sim {
void left_physics(const RunningMill& mill, const std::string& what) {
  throw WorkError("simulation",
                  fmt::format("step {}, time {:.6g} s: {}; take a smaller run.time_step (now {:.3g} s) or a larger "
                              "contact.normal_stiffness",
                              mill.step, double(mill.step) * mill.model.time_step, what, mill.model.time_step));
}

namespace {

void drift(RunningMill& mill) {
  Charge& c = mill.charge;
  const double dt = mill.model.time_step;
  for (std::size_t i = 0; i < c.size(); ++i) {
    c.x[i] += c.vx[i] * dt;
    c.y[i] += c.vy[i] * dt;
    c.angle[i] += c.spin[i] * dt;
  }
}

void renew_lists_if_needed(RunningMill& mill, double angle) {
  const MillModel& m = mill.model;
  const double shell = std::abs(m.speed) * (1 + m.ripple.amplitude) * m.shell.radius;
  mill.moved += std::max(mill.fastest, shell) * m.time_step;
  if (!mill.stale && mill.moved <= mill.skin / 2) return;
  for (std::size_t i = 0; i < mill.charge.size(); ++i) {
    if (!(std::hypot(mill.charge.x[i], mill.charge.y[i]) < m.shell.radius))
      left_physics(mill, fmt::format("ball {} is outside the shell", i));
  }
  renew_ball_contacts(m, mill.charge, mill.skin, mill.search, mill.ball_contacts);
  renew_wall_contacts(m, mill.charge, angle, mill.skin, mill.search, mill.wall_contacts);
  mill.close.resize(std::max(mill.close.size(), mill.ball_contacts.size()));
  mill.moved = 0;
  mill.stale = false;
}

// What acts on ball i by itself, at the positions' time: forces into the sums, and what is needed to book its losses.
struct BodyPush {
  double drag = 0, pool = 0;            // force over velocity [kg/s]
  double drag_spin = 0, pool_spin = 0;  // couple over spin [N m s]
  double vx = 0, vy = 0, spin = 0;      // velocities that these were taken at
  double external = 0;                  // moment of drag and pool about the axis [N m]
};

// Friction of the ends: a spring vector in the mill's frame, wound back to the limit.
void end_walls(RunningMill& mill, std::size_t i, const ShellPose& pose, double speed, double speed_before) {
  const EndWallFriction& ends = mill.model.body.ends;
  const double dt = mill.model.time_step;
  Charge& c = mill.charge;
  // Against the ends during the step, with the position in its middle: that at its end would let a ball that is held
  // drift outwards by W^2 r dt / 2.
  const double mid_x = c.x[i] - 0.5 * dt * c.vx[i], mid_y = c.y[i] - 0.5 * dt * c.vy[i];
  const double ux = (c.vx[i] + speed_before * mid_y) * dt, uy = (c.vy[i] - speed_before * mid_x) * dt;
  const double wound_x = c.end_x[i] + ux * pose.cos + uy * pose.sin,
               wound_y = c.end_y[i] + uy * pose.cos - ux * pose.sin;
  const double limit = ends.coefficient * c.mass[i] * mill.model.gravity + ends.pressure * c.pressure[i];
  const double wound = std::sqrt(wound_x * wound_x + wound_y * wound_y);
  const double kept = ends.stiffness * wound > limit ? limit / (ends.stiffness * wound) : 1;
  const double sx = kept * wound_x, sy = kept * wound_y;
  mill.ledger.dissipated[static_cast<std::size_t>(Cause::kEndWalls)] +=
      0.5 * ends.stiffness * ((c.end_x[i] + sx) * (wound_x - sx) + (c.end_y[i] + sy) * (wound_y - sy));
  c.end_x[i] = sx;
  c.end_y[i] = sy;
  const double fx = -ends.stiffness * (sx * pose.cos - sy * pose.sin),
               fy = -ends.stiffness * (sy * pose.cos + sx * pose.sin);
  c.fx[i] += fx;
  c.fy[i] += fy;
  const double torque = c.x[i] * fy - c.y[i] * fx;
  mill.ledger.torque += torque;
  mill.ledger.drive_work += torque * speed * dt;
}

BodyPush fluids(RunningMill& mill, std::size_t i) {
  const BodyEffects& body = mill.model.body;
  Charge& c = mill.charge;
  const double r = c.radius[i];
  BodyPush push;
  if (!body.drag.on() && !body.pool.on()) return push;
  push.vx = c.vx[i] + c.ax[i];
  push.vy = c.vy[i] + c.ay[i];
  push.spin = c.spin[i] + c.alpha[i];
  const double speed = std::sqrt(push.vx * push.vx + push.vy * push.vy);
  double lift = 0;
  if (body.drag.on()) {
    push.drag = body.drag.per_velocity(r, speed);
    push.drag_spin = body.drag.per_spin(r);
  }
  if (const double depth = body.pool.on() ? body.pool.depth(c.y[i], r) : 0; depth > 0) {
    const double share = body.pool.volume(depth, r) / body.pool.volume(2 * r, r);
    push.pool = share * body.pool.slurry.per_velocity(r, speed);
    push.pool_spin = share * body.pool.slurry.per_spin(r);
    lift = body.pool.lift(depth, r);
  }
  const double fx = -(push.drag + push.pool) * push.vx, fy = lift - (push.drag + push.pool) * push.vy;
  const double couple = -(push.drag_spin + push.pool_spin) * push.spin;
  c.fx[i] += fx;
  c.fy[i] += fy;
  c.moment[i] += couple;
  push.external = c.x[i] * fy - c.y[i] * fx + couple;
  return push;
}

// Work done against the fluids in the step: forces at its middle, mean of the velocities before and after.
void book_fluids(RunningMill& mill, const BodyPush& push, double vx, double vy, double spin) {
  const double along = (push.vx * vx + push.vy * vy) * mill.model.time_step,
               around = push.spin * spin * mill.model.time_step;
  auto& dissipated = mill.ledger.dissipated;
  dissipated[static_cast<std::size_t>(Cause::kFluidDrag)] += push.drag * along + push.drag_spin * around;
  dissipated[static_cast<std::size_t>(Cause::kSlurryPool)] += push.pool * along + push.pool_spin * around;
  mill.ledger.torque_external += push.external;
}

template <bool kBody>
void kick(RunningMill& mill) {
  Charge& c = mill.charge;
  const double dt = mill.model.time_step;
  const double half_fall = 0.5 * mill.model.gravity * dt;
  const ShellPose pose = kBody ? pose_of(mill_angle(mill.model, mill.step)) : ShellPose{};
  const double speed = kBody ? mill_speed(mill.model, mill.step) : 0;
  const double speed_before = kBody ? mill_speed_before(mill.model, mill.step) : 0;
  double fastest2 = 0, mass_moment = 0;
  for (std::size_t i = 0; i < c.size(); ++i) {
    BodyPush push;
    if constexpr (kBody) {
      if (mill.model.body.ends.on()) end_walls(mill, i, pose, speed, speed_before);
      push = fluids(mill, i);
      c.pressure[i] = 0;
    }
    const double per_force = c.half_step_per_mass[i], per_moment = c.half_step_per_inertia[i];
    c.ax[i] = c.fx[i] * per_force;
    c.ay[i] = c.fy[i] * per_force - half_fall;
    c.alpha[i] = c.moment[i] * per_moment;
    if constexpr (kBody) book_fluids(mill, push, c.vx[i] + c.ax[i], c.vy[i] + c.ay[i], c.spin[i] + c.alpha[i]);
    c.vx[i] += 2 * c.ax[i];
    c.vy[i] += 2 * c.ay[i];
    c.spin[i] += 2 * c.alpha[i];
    c.fx[i] = c.fy[i] = c.moment[i] = 0;
    fastest2 = std::max(fastest2, c.vx[i] * c.vx[i] + c.vy[i] * c.vy[i]);
    mass_moment += c.mass[i] * c.x[i];
    mill.flights.apex[i] = std::max(mill.flights.apex[i], c.y[i]);
  }
  if (!std::isfinite(mass_moment + fastest2)) {
    for (std::size_t i = 0; i < c.size(); ++i)
      if (!std::isfinite(c.x[i] + c.vx[i] + c.vy[i]))
        left_physics(mill, fmt::format("the motion of ball {} is not a number", i));
  }
  mill.fastest = std::sqrt(fastest2);
  mill.ledger.mass_moment += mass_moment;
  ++mill.ledger.steps;
}

}  // namespace

RunningMill start_mill(const MillModel& model, Charge charge) {
  RunningMill mill;
  mill.model = model;
  mill.charge = std::move(charge);
  Charge& c = mill.charge;
  c.half_step_per_mass.clear();
  c.half_step_per_inertia.clear();
  // Half a step of gravity brings the velocities to their place in the leapfrog.
  const double half_fall = 0.5 * model.gravity * model.time_step;
  for (std::size_t i = 0; i < c.size(); ++i) {
    c.half_step_per_mass.push_back(0.5 * model.time_step / c.mass[i]);
    c.half_step_per_inertia.push_back(0.5 * model.time_step / inertia(c.mass[i], c.radius[i]));
    c.ax[i] = 0;
    c.ay[i] = -half_fall;
    c.alpha[i] = 0;
    c.vy[i] -= half_fall;
    mill.fastest = std::max(mill.fastest, std::hypot(c.vx[i], c.vy[i]));
  }
  mill.flights.contacts.assign(c.size(), 0);
  mill.flights.apex = c.y;
  const auto lifters = static_cast<std::size_t>(model.shell.lifter_count);
  mill.ledger.impacts.lifter_number.assign(lifters, 0);
  mill.ledger.impacts.lifter_energy.assign(lifters, 0);
  mill.skin = 0.4 * *std::min_element(c.radius.begin(), c.radius.end());
  return mill;
}

void advance(RunningMill& mill) {
  ++mill.step;
  drift(mill);
  renew_lists_if_needed(mill, mill_angle(mill.model, mill.step));
  ball_forces(mill);
  wall_forces(mill);
  mill.model.body.on() ? kick<true>(mill) : kick<false>(mill);
}

Energies energies_of(const RunningMill& mill) {
  const Charge& c = mill.charge;
  Energies e;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const double vx = c.vx[i] - c.ax[i], vy = c.vy[i] - c.ay[i], w = c.spin[i] - c.alpha[i];
    e.kinetic += 0.5 * c.mass[i] * (vx * vx + vy * vy) + 0.5 * inertia(c.mass[i], c.radius[i]) * w * w;
    e.potential += c.mass[i] * mill.model.gravity * c.y[i];
  }
  const BodyEffects& body = mill.model.body;
  for (std::size_t i = 0; i < c.size(); ++i) {
    if (body.pool.on()) e.potential += body.pool.potential(c.y[i], c.radius[i]);
    if (body.ends.on()) e.elastic += 0.5 * body.ends.stiffness * (c.end_x[i] * c.end_x[i] + c.end_y[i] * c.end_y[i]);
  }
  const auto add = [&](const ContactList& list, const ContactModel& law, auto&& effective_radius) {
    for (std::size_t k = 0; k < list.size(); ++k) {
      if (!list.touching[k]) continue;
      e.elastic += mill.model.plain()
                       ? elastic_energy(law.springs, list.states[k])
                       : elastic_energy(law, effective_radius(list.contacts[k]), list.states[k], list.terms[k]);
    }
  };
  add(mill.ball_contacts, mill.model.ball,
      [&](const Contact& k) { return c.radius[k.i] * c.radius[k.j] / (c.radius[k.i] + c.radius[k.j]); });
  add(mill.wall_contacts, mill.model.wall, [&](const Contact& k) { return c.radius[k.i]; });
  return e;
}

}  // namespace tumble::sim
