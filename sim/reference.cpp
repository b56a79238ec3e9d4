#include "sim/reference.h"

#include <cmath>

// Kept apart from sim/running_mill.cpp on purpose: only the contact law and the geometry of one lifter are shared. Sums
// run in the order (i, j), then (i, feature), which is also the order of the near lists; hence the same bits.
namespace tumble::sim {
namespace {

// Feels one contact and books its losses; no force where the two do not touch.
Reaction feel(const MillModel& model, const ContactModel& law, const Touch& now, const Pairing& pair, bool touches,
              ReferenceMill::Memory& memory, double& normal_loss, double& sliding_loss, double& rolling_loss) {
  Reaction r;
  if (touches) {
    r = model.plain() ? touch(law.springs, now, !memory.touching, model.time_step, memory.state)
                      : touch(law, now, pair, !memory.touching, model.time_step, memory.state, memory.terms);
  } else if (memory.touching) {
    r = model.plain() ? part(law.springs, now, memory.state) : part(law, now, pair, memory.state, memory.terms);
    memory = {};
  } else {
    return r;
  }
  memory.touching = touches;
  normal_loss += r.normal_loss;
  sliding_loss += r.sliding_loss;
  rolling_loss += r.rolling_loss;
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
                  Damping(mill.model.ball.springs, dt).of(effective_mass)};
  const Pairing rolling{effective_mass, c.radius[i] * c.radius[j] / reach, (c.spin[j] - c.spin[i]) * dt};
  const Reaction r =
      feel(mill.model, mill.model.ball, now, rolling, d2 < reach * reach, mill.with_ball[i * c.size() + j],
           mill.ledger.dissipated[0], mill.ledger.dissipated[1], mill.ledger.dissipated[4]);
  if (!(d2 < reach * reach)) return;
  const double fx = r.normal * nx - r.tangential * ny, fy = r.normal * ny + r.tangential * nx;
  push(c, i, -fx, -fy, -(arm_i * r.tangential));
  push(c, j, fx, fy, -(arm_j * r.tangential));
  if (!mill.model.plain()) {
    c.moment[i] -= r.couple;
    c.moment[j] += r.couple;
    c.pressure[i] += std::abs(r.normal);
    c.pressure[j] += std::abs(r.normal);
  }
}

// Ball i and the wall: n from the centre to the wall, the wall's point moves with Omega x p.
void wall(ReferenceMill& mill, std::size_t i, int feature, double angle, double& torque, double& torque_shear) {
  Charge& c = mill.charge;
  const MillModel& m = mill.model;
  const auto [distance, nx, ny, face] = nearest_on_wall(m.shell, pose_of(angle), feature, c.x[i], c.y[i]);
  const double px = c.x[i] + distance * nx, py = c.y[i] + distance * ny;
  const double speed = mill_speed_before(m, mill.step);
  const double faster = mill_speed(m, mill.step) - speed;
  const double vx = -speed * py - c.vx[i], vy = speed * px - c.vy[i];
  const double sliding = vy * nx - vx * ny - distance * c.spin[i];

  const Touch now{c.radius[i] - distance, -((vx - faster * py - c.ax[i]) * nx + (vy + faster * px - c.ay[i]) * ny),
                  -(vx * nx + vy * ny) * m.time_step, sliding * m.time_step,
                  Damping(m.wall.springs, m.time_step).of(c.mass[i])};
  const Pairing rolling{c.mass[i], c.radius[i], (speed - c.spin[i]) * m.time_step};
  const bool touches = distance < c.radius[i];
  const Reaction r =
      feel(m, m.wall, now, rolling, touches,
           mill.with_feature[i * static_cast<std::size_t>(feature_count(m.shell)) + static_cast<std::size_t>(feature)],
           mill.ledger.dissipated[2], mill.ledger.dissipated[3], mill.ledger.dissipated[4]);
  if (!touches) return;
  const double sx = r.tangential * ny, sy = -r.tangential * nx;
  const double fx = sx - r.normal * nx, fy = sy - r.normal * ny;
  push(c, i, fx, fy, -(distance * r.tangential));
  torque += px * fy - py * fx;
  torque_shear += px * sy - py * sx;
  if (m.plain()) return;
  c.moment[i] -= r.couple;
  torque -= r.couple;
  c.pressure[i] += std::abs(r.normal);
}

// Forces of the end walls and of the fluids on ball i; their losses, and their moment about the axis.
struct Fluid {
  double force = 0, couple = 0;  // over velocity, over spin
};
void body(ReferenceMill& mill, std::size_t i, const ShellPose& pose, Fluid& drag, Fluid& pool) {
  const MillModel& m = mill.model;
  Charge& c = mill.charge;
  const double dt = m.time_step, r = c.radius[i], speed = mill_speed_before(m, mill.step);
  if (const EndWallFriction& ends = m.body.ends; ends.on()) {
    const double mid_x = c.x[i] - 0.5 * dt * c.vx[i], mid_y = c.y[i] - 0.5 * dt * c.vy[i];
    const double ux = (c.vx[i] + speed * mid_y) * dt, uy = (c.vy[i] - speed * mid_x) * dt;
    const double wx = c.end_x[i] + ux * pose.cos + uy * pose.sin, wy = c.end_y[i] + uy * pose.cos - ux * pose.sin;
    const double limit = ends.coefficient * c.mass[i] * m.gravity + ends.pressure * c.pressure[i];
    const double length = std::sqrt(wx * wx + wy * wy);
    const double kept = ends.stiffness * length > limit ? limit / (ends.stiffness * length) : 1;
    const double sx = kept * wx, sy = kept * wy;
    mill.ledger.dissipated[7] += 0.5 * ends.stiffness * ((c.end_x[i] + sx) * (wx - sx) + (c.end_y[i] + sy) * (wy - sy));
    c.end_x[i] = sx;
    c.end_y[i] = sy;
    const double fx = -ends.stiffness * (sx * pose.cos - sy * pose.sin),
                 fy = -ends.stiffness * (sy * pose.cos + sx * pose.sin);
    push(c, i, fx, fy, 0);
    const double torque = c.x[i] * fy - c.y[i] * fx;
    mill.ledger.torque += torque;
    mill.ledger.drive_work += torque * mill_speed(m, mill.step) * dt;
  }
  const double vx = c.vx[i] + c.ax[i], vy = c.vy[i] + c.ay[i], w = c.spin[i] + c.alpha[i];
  const double v = std::sqrt(vx * vx + vy * vy), depth = m.body.pool.depth(c.y[i], r);
  double lift = 0;
  if (m.body.drag.on()) drag = {m.body.drag.per_velocity(r, v), m.body.drag.per_spin(r)};
  if (m.body.pool.on() && depth > 0) {
    const double share = m.body.pool.volume(depth, r) / m.body.pool.volume(2 * r, r);
    pool = {share * m.body.pool.slurry.per_velocity(r, v), share * m.body.pool.slurry.per_spin(r)};
    lift = m.body.pool.lift(depth, r);
  }
  const double fx = -(drag.force + pool.force) * vx, fy = lift - (drag.force + pool.force) * vy;
  const double couple = -(drag.couple + pool.couple) * w;
  push(c, i, fx, fy, couple);
  mill.ledger.torque_external += c.x[i] * fy - c.y[i] * fx + couple;
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
  mill.ledger.drive_work += torque * mill_speed(mill.model, mill.step) * dt;

  double mass_moment = 0;
  const ShellPose pose = pose_of(angle);
  for (std::size_t i = 0; i < c.size(); ++i) {
    Fluid drag, pool;
    const double vx = c.vx[i] + c.ax[i], vy = c.vy[i] + c.ay[i], w = c.spin[i] + c.alpha[i];
    if (mill.model.body.on()) body(mill, i, pose, drag, pool);
    c.pressure[i] = 0;
    c.ax[i] = c.fx[i] * (0.5 * dt / c.mass[i]);
    c.ay[i] = c.fy[i] * (0.5 * dt / c.mass[i]) - 0.5 * mill.model.gravity * dt;
    c.alpha[i] = c.moment[i] * (0.5 * dt / inertia(c.mass[i], c.radius[i]));
    if (mill.model.body.on()) {
      const double along = (vx * (c.vx[i] + c.ax[i]) + vy * (c.vy[i] + c.ay[i])) * dt;
      const double around = w * (c.spin[i] + c.alpha[i]) * dt;
      mill.ledger.dissipated[5] += drag.force * along + drag.couple * around;
      mill.ledger.dissipated[6] += pool.force * along + pool.couple * around;
    }
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
