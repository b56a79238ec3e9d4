#include "sim/running_mill.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"

namespace tumble::sim {
namespace {

[[noreturn]] void left_physics(const RunningMill& mill, const std::string& what) {
  throw WorkError("simulation",
                  fmt::format("step {}, time {:.6g} s: {}; take a smaller run.time_step (now {:.3g} s) or a larger "
                              "contact.normal_stiffness",
                              mill.step, double(mill.step) * mill.model.time_step, what, mill.model.time_step));
}

[[noreturn]] void overlap_too_large(const RunningMill& mill, int i, int j, double overlap, double radius) {
  const std::string other = j < 0 ? std::string("the wall") : fmt::format("ball {}", j);
  left_physics(mill, fmt::format("ball {} overlaps {} by {:.3g} mm, more than half a radius ({:.3g} mm)", i, other,
                                 1e3 * overlap, 1e3 * radius / 2));
}

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
  mill.moved += std::max(mill.fastest, std::abs(m.speed) * m.shell.radius) * m.time_step;
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

void end_impact(const RunningMill& mill, std::array<double, kBins>& bins, ContactState& state) {
  if (mill.ledger.counting_impacts) bins[spectrum_bin(state.lost)] += 1;
  state = {};
}

// Forces between balls: gather, law, scatter. The scatter runs in the order of the list, as a sum per ball would.
void ball_forces(RunningMill& mill) {
  const MillModel& m = mill.model;
  const double dt = m.time_step;
  Charge& c = mill.charge;
  ContactList& list = mill.ball_contacts;

  std::size_t close = 0;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const Contact& contact = list.contacts[k];
    const double dx = c.x[contact.j] - c.x[contact.i], dy = c.y[contact.j] - c.y[contact.i];
    mill.close[close] = static_cast<std::uint32_t>(k);
    close += static_cast<std::size_t>((dx * dx + dy * dy < contact.reach * contact.reach) | list.touching[k]);
  }

  double normal_loss = mill.ledger.dissipated[static_cast<std::size_t>(Cause::kBallBallNormal)];
  double sliding_loss = mill.ledger.dissipated[static_cast<std::size_t>(Cause::kBallBallSliding)];
  for (std::size_t q = 0; q < close; ++q) {
    const std::size_t k = mill.close[q];
    const Contact& contact = list.contacts[k];
    const int i = contact.i, j = contact.j;
    ContactState& state = list.states[k];

    const double dx = c.x[j] - c.x[i], dy = c.y[j] - c.y[i];
    const double d2 = dx * dx + dy * dy;
    const double d = std::sqrt(d2);
    const double nx = dx / d, ny = dy / d;
    const double dvx = c.vx[j] - c.vx[i], dvy = c.vy[j] - c.vy[i];
    const double dax = c.ax[j] - c.ax[i], day = c.ay[j] - c.ay[i];
    Touch now;
    now.overlap = contact.reach - d;
    now.approach = -(dvx * nx + dvy * ny) * dt;
    now.closing = -((dvx + dax) * nx + (dvy + day) * ny);
    now.damping = contact.damping;
    // The contact lies half the overlap inside either ball.
    const double arm_i = c.radius[i] - 0.5 * now.overlap, arm_j = c.radius[j] - 0.5 * now.overlap;
    now.slide = (dvy * nx - dvx * ny - (arm_i * c.spin[i] + arm_j * c.spin[j])) * dt;

    if (!(d2 < contact.reach * contact.reach)) {
      const Reaction r = part(m.ball, now, state);
      normal_loss += r.normal_loss;
      sliding_loss += r.sliding_loss;
      end_impact(mill, mill.ledger.impacts.ball_ball, state);
      list.touching[k] = 0;
      continue;
    }
    if (now.overlap > 0.5 * std::min(c.radius[i], c.radius[j]))
      overlap_too_large(mill, i, j, now.overlap, std::min(c.radius[i], c.radius[j]));
    const Reaction r = touch(m.ball, now, !list.touching[k], dt, state);
    list.touching[k] = 1;
    normal_loss += r.normal_loss;
    sliding_loss += r.sliding_loss;

    const double fx = r.normal * nx - r.tangential * ny, fy = r.normal * ny + r.tangential * nx;  // on j
    c.fx[i] -= fx;
    c.fy[i] -= fy;
    c.moment[i] -= arm_i * r.tangential;
    c.fx[j] += fx;
    c.fy[j] += fy;
    c.moment[j] -= arm_j * r.tangential;
  }
  mill.ledger.dissipated[static_cast<std::size_t>(Cause::kBallBallNormal)] = normal_loss;
  mill.ledger.dissipated[static_cast<std::size_t>(Cause::kBallBallSliding)] = sliding_loss;
}

// Forces of shell and lifters on the balls, and their moment about the axis.
void wall_forces(RunningMill& mill, double angle) {
  const MillModel& m = mill.model;
  const Shell& shell = m.shell;
  const double dt = m.time_step;
  Charge& c = mill.charge;
  ContactList& list = mill.wall_contacts;
  const ShellPose pose = pose_of(angle);

  double normal_loss = mill.ledger.dissipated[static_cast<std::size_t>(Cause::kBallWallNormal)];
  double sliding_loss = mill.ledger.dissipated[static_cast<std::size_t>(Cause::kBallWallSliding)];
  double torque = 0, torque_shear = 0;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const Contact& contact = list.contacts[k];
    const int i = contact.i;
    const double x = c.x[i], y = c.y[i];
    if (!list.touching[k] && !may_touch(shell, pose, contact.j, x, y, contact.reach)) continue;
    const auto [distance, nx, ny, face] = nearest_on_wall(shell, pose, contact.j, x, y);
    const bool touches = distance < contact.reach;
    if (!touches && !list.touching[k]) continue;

    ContactState& state = list.states[k];
    const double px = x + distance * nx, py = y + distance * ny;  // on the wall
    const double dvx = -m.speed * py - c.vx[i], dvy = m.speed * px - c.vy[i];
    Touch now;
    now.overlap = contact.reach - distance;
    now.approach = -(dvx * nx + dvy * ny) * dt;
    now.closing = -((dvx - c.ax[i]) * nx + (dvy - c.ay[i]) * ny);
    now.damping = contact.damping;
    now.slide = (dvy * nx - dvx * ny - distance * c.spin[i]) * dt;

    if (!touches) {
      const Reaction r = part(m.wall, now, state);
      normal_loss += r.normal_loss;
      sliding_loss += r.sliding_loss;
      end_impact(mill, mill.ledger.impacts.ball_wall, state);
      list.touching[k] = 0;
      continue;
    }
    if (now.overlap > 0.5 * contact.reach) overlap_too_large(mill, i, -1, now.overlap, contact.reach);
    const Reaction r = touch(m.wall, now, !list.touching[k], dt, state);
    list.touching[k] = 1;
    normal_loss += r.normal_loss;
    sliding_loss += r.sliding_loss;

    const double sx = r.tangential * ny, sy = -r.tangential * nx;  // on the ball
    const double fx = sx - r.normal * nx, fy = sy - r.normal * ny;
    c.fx[i] += fx;
    c.fy[i] += fy;
    c.moment[i] -= distance * r.tangential;
    torque += px * fy - py * fx;
    torque_shear += px * sy - py * sx;
  }
  mill.ledger.dissipated[static_cast<std::size_t>(Cause::kBallWallNormal)] = normal_loss;
  mill.ledger.dissipated[static_cast<std::size_t>(Cause::kBallWallSliding)] = sliding_loss;
  mill.ledger.torque += torque;
  mill.ledger.torque_shear += torque_shear;
  mill.ledger.drive_work += torque * m.speed * dt;
}

void kick(RunningMill& mill) {
  Charge& c = mill.charge;
  const double dt = mill.model.time_step;
  const double half_fall = 0.5 * mill.model.gravity * dt;
  double fastest2 = 0, mass_moment = 0;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const double per_force = c.half_step_per_mass[i], per_moment = c.half_step_per_inertia[i];
    c.ax[i] = c.fx[i] * per_force;
    c.ay[i] = c.fy[i] * per_force - half_fall;
    c.alpha[i] = c.moment[i] * per_moment;
    c.vx[i] += 2 * c.ax[i];
    c.vy[i] += 2 * c.ay[i];
    c.spin[i] += 2 * c.alpha[i];
    c.fx[i] = c.fy[i] = c.moment[i] = 0;
    fastest2 = std::max(fastest2, c.vx[i] * c.vx[i] + c.vy[i] * c.vy[i]);
    mass_moment += c.mass[i] * c.x[i];
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
  mill.skin = 0.4 * *std::min_element(c.radius.begin(), c.radius.end());
  return mill;
}

void advance(RunningMill& mill) {
  ++mill.step;
  const double angle = mill_angle(mill.model, mill.step);
  drift(mill);
  renew_lists_if_needed(mill, angle);
  ball_forces(mill);
  wall_forces(mill, angle);
  kick(mill);
}

Energies energies_of(const RunningMill& mill) {
  const Charge& c = mill.charge;
  Energies e;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const double vx = c.vx[i] - c.ax[i], vy = c.vy[i] - c.ay[i], w = c.spin[i] - c.alpha[i];
    e.kinetic += 0.5 * c.mass[i] * (vx * vx + vy * vy) + 0.5 * inertia(c.mass[i], c.radius[i]) * w * w;
    e.potential += c.mass[i] * mill.model.gravity * c.y[i];
  }
  const auto add = [&](const ContactList& list, const LinearSpringDashpot& law) {
    for (std::size_t k = 0; k < list.size(); ++k)
      if (list.touching[k]) e.elastic += elastic_energy(law, list.states[k]);
  };
  add(mill.ball_contacts, mill.model.ball);
  add(mill.wall_contacts, mill.model.wall);
  return e;
}

}  // namespace tumble::sim
