#include "sim/contact_forces.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

// Each loop reads gather, law, scatter, and exists twice: for the plain law, and for any law (`kPlain` false). The
// scatter runs in the order of the list, as a sum per ball would.
namespace tumble::sim {
namespace {

[[noreturn]] void overlap_too_large(const RunningMill& mill, int i, int j, double overlap, double radius) {
  const std::string other = j < 0 ? std::string("the wall") : fmt::format("ball {}", j);
  left_physics(mill, fmt::format("ball {} overlaps {} by {:.3g} mm, more than half a radius ({:.3g} mm)", i, other,
                                 1e3 * overlap, 1e3 * radius / 2));
}

// A flight ends with the first contact and begins with the loss of the last one.
void land(RunningMill& mill, int i) {
  if (mill.flights.contacts[i]++ > 0 || !mill.ledger.counting_impacts) return;
  const double height = mill.flights.apex[i] - mill.charge.y[i];
  const int bin = static_cast<int>(kFallBins * height / (2 * mill.model.shell.radius));
  mill.ledger.impacts.falls[std::clamp(bin, 0, kFallBins - 1)] += 1;
}
void leave(RunningMill& mill, int i) {
  if (--mill.flights.contacts[i] == 0) mill.flights.apex[i] = mill.charge.y[i];
}

std::uint16_t place_of(Face face, double px, double py) {
  const double turn = std::atan2(py, px) / (2 * kPi);
  const int bin = std::min(kAngleBins - 1, static_cast<int>((turn < 0 ? turn + 1 : turn) * kAngleBins));
  return static_cast<std::uint16_t>(static_cast<int>(face) * kAngleBins + bin);
}

void end_wall_impact(RunningMill& mill, int feature, std::size_t place, const ContactState& state) {
  Impacts& impacts = mill.ledger.impacts;
  const double lost = state.normal_lost + state.sliding_lost;
  impacts.ball_wall.add(state.normal_lost, state.sliding_lost);
  impacts.wall_number[place] += 1;
  impacts.wall_energy[place] += lost;
  if (feature == 0) return;
  const auto lifter = static_cast<std::size_t>(lifter_of(mill.model.shell, feature));
  impacts.lifter_number[lifter] += 1;
  impacts.lifter_energy[lifter] += lost;
}

struct Losses {
  double normal = 0, sliding = 0, rolling = 0;
  void add(const Reaction& r) {
    normal += r.normal_loss;
    sliding += r.sliding_loss;
    rolling += r.rolling_loss;
  }
};

double& dissipated(RunningMill& mill, Cause cause) { return mill.ledger.dissipated[static_cast<std::size_t>(cause)]; }

// The law of a touching pair, by its memory at `k` of the list.
template <bool kPlain>
Reaction feel(const ContactModel& law, const Touch& now, const Pairing& pair, double time_step, ContactList& list,
              std::size_t k) {
  const bool first = !list.touching[k];
  list.touching[k] = 1;
  if constexpr (kPlain)
    return touch(law.springs, now, first, time_step, list.states[k]);
  else
    return touch(law, now, pair, first, time_step, list.states[k], list.terms[k]);
}

// The losses of the step in which the pair came apart. Its state is left for the count of impacts: `forget` comes next.
template <bool kPlain>
Reaction let_go(const ContactModel& law, const Touch& now, const Pairing& pair, ContactList& list, std::size_t k) {
  if constexpr (kPlain)
    return part(law.springs, now, list.states[k]);
  else
    return part(law, now, pair, list.states[k], list.terms[k]);
}

void forget(ContactList& list, std::size_t k) {
  list.touching[k] = 0;
  list.states[k] = {};
  if (!list.terms.empty()) list.terms[k] = {};
}

template <bool kPlain>
void ball_forces_by(RunningMill& mill) {
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

  Losses losses{dissipated(mill, Cause::kBallBallNormal), dissipated(mill, Cause::kBallBallSliding),
                dissipated(mill, Cause::kRolling)};
  for (std::size_t q = 0; q < close; ++q) {
    const std::size_t k = mill.close[q];
    const Contact& contact = list.contacts[k];
    const int i = contact.i, j = contact.j;

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
    Pairing pair;
    if constexpr (!kPlain)
      pair = {c.mass[i] * c.mass[j] / (c.mass[i] + c.mass[j]), c.radius[i] * c.radius[j] / contact.reach,
              (c.spin[j] - c.spin[i]) * dt};

    if (!(d2 < contact.reach * contact.reach)) {
      losses.add(let_go<kPlain>(m.ball, now, pair, list, k));
      const ContactState& state = list.states[k];
      if (mill.ledger.counting_impacts) mill.ledger.impacts.ball_ball.add(state.normal_lost, state.sliding_lost);
      forget(list, k);
      leave(mill, i);
      leave(mill, j);
      continue;
    }
    if (now.overlap > 0.5 * std::min(c.radius[i], c.radius[j]))
      overlap_too_large(mill, i, j, now.overlap, std::min(c.radius[i], c.radius[j]));
    if (!list.touching[k]) {
      land(mill, i);
      land(mill, j);
    }
    const Reaction r = feel<kPlain>(m.ball, now, pair, dt, list, k);
    losses.add(r);

    const double fx = r.normal * nx - r.tangential * ny, fy = r.normal * ny + r.tangential * nx;  // on j
    c.fx[i] -= fx;
    c.fy[i] -= fy;
    c.moment[i] -= arm_i * r.tangential;
    c.fx[j] += fx;
    c.fy[j] += fy;
    c.moment[j] -= arm_j * r.tangential;
    if constexpr (!kPlain) {
      c.moment[i] -= r.couple;
      c.moment[j] += r.couple;
      if (m.body.ends.pressure != 0) {
        c.pressure[i] += std::abs(r.normal);
        c.pressure[j] += std::abs(r.normal);
      }
    }
  }
  dissipated(mill, Cause::kBallBallNormal) = losses.normal;
  dissipated(mill, Cause::kBallBallSliding) = losses.sliding;
  dissipated(mill, Cause::kRolling) = losses.rolling;
}

// The wall's point moves with Omega x p; its forces on the balls have the moment that drives the mill.
template <bool kPlain>
void wall_forces_by(RunningMill& mill) {
  const MillModel& m = mill.model;
  const Shell& shell = m.shell;
  const double dt = m.time_step, speed = mill_speed(m, mill.step);
  const double speed_before = mill_speed_before(m, mill.step), faster = speed - speed_before;
  Charge& c = mill.charge;
  ContactList& list = mill.wall_contacts;
  const ShellPose pose = pose_of(mill_angle(m, mill.step));

  Losses losses{dissipated(mill, Cause::kBallWallNormal), dissipated(mill, Cause::kBallWallSliding),
                dissipated(mill, Cause::kRolling)};
  double torque = 0, torque_shear = 0;
  for (std::size_t k = 0; k < list.size(); ++k) {
    const Contact& contact = list.contacts[k];
    const int i = contact.i;
    const double x = c.x[i], y = c.y[i];
    if (!list.touching[k] && !may_touch(shell, pose, contact.j, x, y, contact.reach)) continue;
    const auto [distance, nx, ny, face] = nearest_on_wall(shell, pose, contact.j, x, y);
    const bool touches = distance < contact.reach;
    if (!touches && !list.touching[k]) continue;

    const double px = x + distance * nx, py = y + distance * ny;  // on the wall
    const double dvx = -speed_before * py - c.vx[i], dvy = speed_before * px - c.vy[i];
    Touch now;
    now.overlap = contact.reach - distance;
    now.approach = -(dvx * nx + dvy * ny) * dt;
    now.closing = -((dvx - faster * py - c.ax[i]) * nx + (dvy + faster * px - c.ay[i]) * ny);
    now.damping = contact.damping;
    now.slide = (dvy * nx - dvx * ny - distance * c.spin[i]) * dt;
    Pairing pair;
    if constexpr (!kPlain) pair = {c.mass[i], c.radius[i], (speed_before - c.spin[i]) * dt};

    if (!touches) {
      losses.add(let_go<kPlain>(m.wall, now, pair, list, k));
      if (mill.ledger.counting_impacts) end_wall_impact(mill, contact.j, list.place[k], list.states[k]);
      forget(list, k);
      leave(mill, i);
      continue;
    }
    if (now.overlap > 0.5 * contact.reach) overlap_too_large(mill, i, -1, now.overlap, contact.reach);
    if (!list.touching[k]) {
      land(mill, i);
      list.place[k] = place_of(face, px, py);
    }
    const Reaction r = feel<kPlain>(m.wall, now, pair, dt, list, k);
    losses.add(r);

    const double sx = r.tangential * ny, sy = -r.tangential * nx;  // on the ball
    const double fx = sx - r.normal * nx, fy = sy - r.normal * ny;
    c.fx[i] += fx;
    c.fy[i] += fy;
    c.moment[i] -= distance * r.tangential;
    torque += px * fy - py * fx;
    torque_shear += px * sy - py * sx;
    if constexpr (!kPlain) {
      c.moment[i] -= r.couple;
      torque -= r.couple;
      if (m.body.ends.pressure != 0) c.pressure[i] += std::abs(r.normal);
    }
  }
  dissipated(mill, Cause::kBallWallNormal) = losses.normal;
  dissipated(mill, Cause::kBallWallSliding) = losses.sliding;
  dissipated(mill, Cause::kRolling) = losses.rolling;
  mill.ledger.torque += torque;
  mill.ledger.torque_shear += torque_shear;
  mill.ledger.drive_work += torque * speed * dt;
}

}  // namespace

void ball_forces(RunningMill& mill) { mill.model.plain() ? ball_forces_by<true>(mill) : ball_forces_by<false>(mill); }
void wall_forces(RunningMill& mill) { mill.model.plain() ? wall_forces_by<true>(mill) : wall_forces_by<false>(mill); }

}  // namespace tumble::sim
