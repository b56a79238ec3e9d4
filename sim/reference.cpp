#include "sim/reference.h"

#include <cmath>

// Kept apart from sim/running_mill.cpp on purpose: only the contact law and the geometry of one lifter are shared. Sums
// run in the order (i, j), then (i, feature), which is also the order of the near lists; hence the same bits.
namespace tumble::sim {
namespace {

// Feels one contact and books its losses; no force where the two do not touch.
Reaction feel(const LinearSpringDashpot& law, const Touch& now, bool touches, double time_step,
              ReferenceMill::Memory& memory, double& normal_loss, double& sliding_loss) {
  Reaction r;
  if (touches) {
    r = touch(law, now, !memory.touching, time_step, memory.state);
  } else if (memory.touching) {
    r = part(law, now, memory.state);
    memory.state = {};
  } else {
    return r;
  }
  memory.touching = touches;
  normal_loss += r.normal_loss;
  sliding_loss += r.sliding_loss;
  return r;
}

void push(Charge& c, std::size_t i, double fx, double fy, double moment) {
  c.fx[i] += fx;
  c.fy[i] += fy;
  c.moment[i] += moment;
}

// Ball i and ball j: n from i to j, t = n turned by 90 degrees; all velocities are of j against i.
void pair(ReferenceMill& mill, std::size_t i, std::size_t j) {
  Charge& c = mill.charge;
  const double dt = mill.model.time_step, reach = c.radius[i] + c.radius[j];
  const double dx = c.x[j] - c.x[i], dy = c.y[j] - c.y[i], d2 = dx * dx + dy * dy, d = std::sqrt(d2);
  const double nx = dx / d, ny = dy / d, overlap = reach - d;
  const double arm_i = c.radius[i] - 0.5 * overlap, arm_j = c.radius[j] - 0.5 * overlap;
  const double vx = c.vx[j] - c.vx[i], vy = c.vy[j] - c.vy[i];
  const double foreseen_x = vx + (c.ax[j] - c.ax[i]), foreseen_y = vy + (c.ay[j] - c.ay[i]);
  const double sliding = vy * nx - vx * ny - (arm_i * c.spin[i] + arm_j * c.spin[j]);
  const double effective_mass = c.mass[i] * c.mass[j] / (c.mass[i] + c.mass[j]);

  const Touch now{overlap, -(foreseen_x * nx + foreseen_y * ny), -(vx * nx + vy * ny) * dt, sliding * dt,
                  Damping(mill.model.ball, dt).of(effective_mass)};
  const Reaction r = feel(mill.model.ball, now, d2 < reach * reach, dt, mill.with_ball[i * c.size() + j],
                          mill.ledger.dissipated[0], mill.ledger.dissipated[1]);
  if (!(d2 < reach * reach)) return;
  const double fx = r.normal * nx - r.tangential * ny, fy = r.normal * ny + r.tangential * nx;
  push(c, i, -fx, -fy, -(arm_i * r.tangential));
  push(c, j, fx, fy, -(arm_j * r.tangential));
}

// Ball i and the wall: n from the centre to the wall, the wall's point moves with Omega x p.
void wall(ReferenceMill& mill, std::size_t i, int feature, double angle, double& torque, double& torque_shear) {
  Charge& c = mill.charge;
  const MillModel& m = mill.model;
  const auto [distance, nx, ny, face] = nearest_on_wall(m.shell, pose_of(angle), feature, c.x[i], c.y[i]);
  const double px = c.x[i] + distance * nx, py = c.y[i] + distance * ny;
  const double vx = -m.speed * py - c.vx[i], vy = m.speed * px - c.vy[i];
  const double sliding = vy * nx - vx * ny - distance * c.spin[i];

  const Touch now{c.radius[i] - distance, -((vx - c.ax[i]) * nx + (vy - c.ay[i]) * ny),
                  -(vx * nx + vy * ny) * m.time_step, sliding * m.time_step,
                  Damping(m.wall, m.time_step).of(c.mass[i])};
  const bool touches = distance < c.radius[i];
  const Reaction r =
      feel(m.wall, now, touches, m.time_step,
           mill.with_feature[i * static_cast<std::size_t>(feature_count(m.shell)) + static_cast<std::size_t>(feature)],
           mill.ledger.dissipated[2], mill.ledger.dissipated[3]);
  if (!touches) return;
  const double sx = r.tangential * ny, sy = -r.tangential * nx;
  const double fx = sx - r.normal * nx, fy = sy - r.normal * ny;
  push(c, i, fx, fy, -(distance * r.tangential));
  torque += px * fy - py * fx;
  torque_shear += px * sy - py * sx;
}

}  // namespace

ReferenceMill make_reference_mill(const MillModel& model, Charge charge) {
  ReferenceMill mill{model, std::move(charge), {}, 0, {}, {}};
  Charge& c = mill.charge;
  for (std::size_t i = 0; i < c.size(); ++i) {
    c.ax[i] = c.alpha[i] = 0;
    c.ay[i] = -(0.5 * model.gravity * model.time_step);
    c.vy[i] += c.ay[i];
  }
  mill.with_ball.resize(c.size() * c.size());
  mill.with_feature.resize(c.size() * static_cast<std::size_t>(feature_count(model.shell)));
  return mill;
}

void advance(ReferenceMill& mill) {
  Charge& c = mill.charge;
  const double dt = mill.model.time_step;
  const double angle = mill_angle(mill.model, ++mill.step);

  for (std::size_t i = 0; i < c.size(); ++i) {
    c.x[i] += c.vx[i] * dt;
    c.y[i] += c.vy[i] * dt;
    c.angle[i] += c.spin[i] * dt;
  }

  for (std::size_t i = 0; i < c.size(); ++i)
    for (std::size_t j = i + 1; j < c.size(); ++j) pair(mill, i, j);
  double torque = 0, torque_shear = 0;
  for (std::size_t i = 0; i < c.size(); ++i)
    for (int feature = 0; feature < feature_count(mill.model.shell); ++feature)
      wall(mill, i, feature, angle, torque, torque_shear);
  mill.ledger.torque += torque;
  mill.ledger.torque_shear += torque_shear;
  mill.ledger.drive_work += torque * mill.model.speed * dt;

  double mass_moment = 0;
  for (std::size_t i = 0; i < c.size(); ++i) {
    c.ax[i] = c.fx[i] * (0.5 * dt / c.mass[i]);
    c.ay[i] = c.fy[i] * (0.5 * dt / c.mass[i]) - 0.5 * mill.model.gravity * dt;
    c.alpha[i] = c.moment[i] * (0.5 * dt / inertia(c.mass[i], c.radius[i]));
    c.vx[i] += 2 * c.ax[i];
    c.vy[i] += 2 * c.ay[i];
    c.spin[i] += 2 * c.alpha[i];
    c.fx[i] = c.fy[i] = c.moment[i] = 0;
    mass_moment += c.mass[i] * c.x[i];
  }
  mill.ledger.mass_moment += mass_moment;
  ++mill.ledger.steps;
}

}  // namespace tumble::sim
