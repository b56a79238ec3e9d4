#include "sim/reference.h"

#include <cmath>

// Kept apart from sim/running_mill.cpp on purpose: only the contact law, the geometry of one lifter and the rounding of
// what is summed up are shared.
namespace tumble::sim {
namespace {

struct Losses {
  double normal = 0, sliding = 0, rolling = 0;
};

// Sums of one step.
struct StepSums {
  std::vector<double> fx, fy, moment, pressure;
  Losses balls, wall;
  double torque = 0, torque_shear = 0;
};

// Feels one contact and books its losses; no force where the two do not touch.
Reaction feel(const MillModel& model, const ContactModel& law, const Touch& now, const Pairing& pair, bool touches,
              ReferenceMill::Memory& memory, const ExactSum& exact, Losses& losses) {
  Reaction r;
  if (touches) {
    if (!memory.touching) memory.terms.damping = damping_from(law, now, pair, model.time_step);
    r = model.plain() ? touch(law.springs, now, !memory.touching, model.time_step, memory.state)
                      : touch(law, now, pair, !memory.touching, model.time_step, memory.state, memory.terms);
  } else if (memory.touching) {
    r = model.plain() ? part(law.springs, now, memory.state) : part(law, now, pair, memory.state, memory.terms);
    memory = {};
  } else {
    return r;
  }
  memory.touching = touches;
  losses.normal += exact(r.normal_loss);
  losses.sliding += exact(r.sliding_loss);
  losses.rolling += exact(r.rolling_loss);
  return r;
}

void push(StepSums& s, std::size_t i, double fx, double fy, double moment) {
  s.fx[i] += fx;
  s.fy[i] += fy;
  s.moment[i] += moment;
}

// Ball i and ball j: n from i to j, t = n turned by 90 degrees; all velocities are of j against i.
void pair(ReferenceMill& mill, std::size_t i, std::size_t j, StepSums& sums) {
  Charge& c = mill.charge;
  const double dt = mill.model.time_step, reach = c.radius[i] + c.radius[j];
  const double dx = c.x[j] - c.x[i], dy = c.y[j] - c.y[i], d2 = dx * dx + dy * dy, d = std::sqrt(d2);
  const double nx = dx * (1 / d), ny = dy * (1 / d), overlap = reach - d;
  const double arm_i = c.radius[i] - 0.5 * overlap, arm_j = c.radius[j] - 0.5 * overlap;
  const double vx = c.vx[j] - c.vx[i], vy = c.vy[j] - c.vy[i];
  const double foreseen_x = vx + (c.ax[j] - c.ax[i]), foreseen_y = vy + (c.ay[j] - c.ay[i]);
  const double sliding = vy * nx - vx * ny - (arm_i * c.spin[i] + arm_j * c.spin[j]);
  const double effective_mass = c.mass[i] * c.mass[j] / (c.mass[i] + c.mass[j]);

  const Touch now{overlap, -(foreseen_x * nx + foreseen_y * ny), -(vx * nx + vy * ny) * dt, sliding * dt,
                  Damping(mill.model.ball.springs, dt).of(effective_mass)};
  const Pairing rolling{effective_mass, c.radius[i] * c.radius[j] / reach, (c.spin[j] - c.spin[i]) * dt};
  const Reaction r = feel(mill.model, mill.model.ball, now, rolling, d2 < reach * reach,
                          mill.with_ball[i * c.size() + j], mill.exact.loss, sums.balls);
  if (!(d2 < reach * reach)) return;
  const double fx = mill.exact.force(r.normal * nx - r.tangential * ny),
               fy = mill.exact.force(r.normal * ny + r.tangential * nx);
  push(sums, i, -fx, -fy, mill.exact.moment(-(arm_i * r.tangential) - r.couple));
  push(sums, j, fx, fy, mill.exact.moment(-(arm_j * r.tangential) + r.couple));
  sums.pressure[i] += mill.exact.force(std::abs(r.normal));
  sums.pressure[j] += mill.exact.force(std::abs(r.normal));
}

// Ball i and the wall: n from the centre to the wall, the wall's point moves with Omega x p.
void wall(ReferenceMill& mill, std::size_t i, int feature, double angle, StepSums& sums) {
  Charge& c = mill.charge;
  const MillModel& m = mill.model;
  const auto [distance, nx, ny, face] = nearest_on_wall(m.shell, pose_of(angle), feature, c.x[i], c.y[i]);
  const double px = c.x[i] + distance * nx, py = c.y[i] + distance * ny;
  const double speed = mill_speed_before(m, mill.step);
  const double faster = mill_speed(m, mill.step) - speed;
  const double vx = -speed * py - c.vx[i], vy = speed * px - c.vy[i];
  const double sliding = vy * nx - vx * ny - distance * c.spin[i];

  const Touch now{c.radius[i] - distance, -((vx + (-faster * py - c.ax[i])) * nx + (vy + (faster * px - c.ay[i])) * ny),
                  -(vx * nx + vy * ny) * m.time_step, sliding * m.time_step,
                  Damping(m.wall.springs, m.time_step).of(c.mass[i])};
  const Pairing rolling{c.mass[i], c.radius[i], (speed - c.spin[i]) * m.time_step};
  const bool touches = distance < c.radius[i];
  const std::size_t of_ball = i * static_cast<std::size_t>(feature_count(m.shell));
  const Reaction r = feel(m, m.wall, now, rolling, touches,
                          mill.with_feature[of_ball + static_cast<std::size_t>(feature)], mill.exact.loss, sums.wall);
  if (!touches) return;
  const double sx = r.tangential * ny, sy = -r.tangential * nx;
  const double fx = sx - r.normal * nx, fy = sy - r.normal * ny;
  push(sums, i, mill.exact.force(fx), mill.exact.force(fy), mill.exact.moment(-(distance * r.tangential) - r.couple));
  sums.pressure[i] += mill.exact.force(std::abs(r.normal));
  sums.torque += mill.exact.torque(px * fy - py * fx - r.couple);
  sums.torque_shear += mill.exact.torque(px * sy - py * sx);
}

// Forces of the end walls and of the fluids on ball i, and what they take.
struct Body {
  double fx = 0, fy = 0, couple = 0;
  double ends_torque = 0, ends_loss = 0, external = 0;
  double drag = 0, drag_spin = 0, pool = 0, pool_spin = 0;  // force over velocity, couple over spin
};
Body body(ReferenceMill& mill, std::size_t i, const ShellPose& pose, double pressed) {
  const MillModel& m = mill.model;
  Charge& c = mill.charge;
  Body b;
  const double dt = m.time_step, r = c.radius[i], speed = mill_speed_before(m, mill.step);
  if (const EndWallFriction& ends = m.body.ends; ends.on()) {
    const double mid_x = c.x[i] - 0.5 * dt * c.vx[i], mid_y = c.y[i] - 0.5 * dt * c.vy[i];
    const double ux = (c.vx[i] + speed * mid_y) * dt, uy = (c.vy[i] - speed * mid_x) * dt;
    const double wx = c.end_x[i] + ux * pose.cos + uy * pose.sin, wy = c.end_y[i] + uy * pose.cos - ux * pose.sin;
    const double most = ends.most_wound(c.mass[i], m.gravity, pressed);
    const double length = std::sqrt(wx * wx + wy * wy);
    const double kept = length > most ? most / length : 1;
    const double sx = kept * wx, sy = kept * wy;
    b.ends_loss = 0.5 * ends.stiffness * ((c.end_x[i] + sx) * (wx - sx) + (c.end_y[i] + sy) * (wy - sy));
    c.end_x[i] = sx;
    c.end_y[i] = sy;
    b.fx = -ends.stiffness * (sx * pose.cos - sy * pose.sin);
    b.fy = -ends.stiffness * (sy * pose.cos + sx * pose.sin);
    b.ends_torque = c.x[i] * b.fy - c.y[i] * b.fx;
  }
  if (!m.body.in_fluid()) return b;
  const double vx = c.vx[i] + c.ax[i], vy = c.vy[i] + c.ay[i], w = c.spin[i] + c.alpha[i];
  const double v = std::sqrt(vx * vx + vy * vy), depth = m.body.pool.depth(c.y[i], r);
  double lift = 0;
  if (m.body.drag.on()) {
    b.drag = m.body.drag.per_velocity(r, v);
    b.drag_spin = m.body.drag.per_spin(r);
  }
  if (m.body.tabulated.on()) b.drag += m.body.tabulated.per_velocity(r, v);
  if (m.body.pool.on() && depth > 0) {
    const double share = m.body.pool.volume(depth, r) / m.body.pool.volume(2 * r, r);
    b.pool = share * m.body.pool.slurry.per_velocity(r, v);
    b.pool_spin = share * m.body.pool.slurry.per_spin(r);
    lift = m.body.pool.lift(depth, r);
  }
  const double fx = -(b.drag + b.pool) * vx, fy = lift - (b.drag + b.pool) * vy;
  b.couple = -(b.drag_spin + b.pool_spin) * w;
  b.fx += fx;
  b.fy += fy;
  b.external = c.x[i] * fy - c.y[i] * fx + b.couple;
  return b;
}

}  // namespace

ReferenceMill make_reference_mill(const MillModel& model, Charge charge) {
  ReferenceMill mill;
  mill.model = model;
  mill.exact = exact_sums(model, charge);
  mill.charge = std::move(charge);
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

  StepSums sums;
  for (auto* v : {&sums.fx, &sums.fy, &sums.moment, &sums.pressure}) v->assign(c.size(), 0.0);
  for (std::size_t i = 0; i < c.size(); ++i)
    for (std::size_t j = i + 1; j < c.size(); ++j) pair(mill, i, j, sums);
  for (std::size_t i = 0; i < c.size(); ++i)
    for (int feature = 0; feature < feature_count(mill.model.shell); ++feature) wall(mill, i, feature, angle, sums);

  const ExactSums& exact = mill.exact;
  double mass_moment = 0, ends_torque = 0, ends_loss = 0, drag_loss = 0, pool_loss = 0, external = 0;
  const ShellPose pose = pose_of(angle);
  for (std::size_t i = 0; i < c.size(); ++i) {
    const double vx = c.vx[i] + c.ax[i], vy = c.vy[i] + c.ay[i], w = c.spin[i] + c.alpha[i];
    const Body b = body(mill, i, pose, mill.model.body.ends.pressure != 0 ? sums.pressure[i] : 0);
    c.ax[i] = (sums.fx[i] + b.fx) * (0.5 * dt / c.mass[i]);
    c.ay[i] = (sums.fy[i] + b.fy) * (0.5 * dt / c.mass[i]) - 0.5 * mill.model.gravity * dt;
    c.alpha[i] = (sums.moment[i] + b.couple) * (0.5 * dt / inertia(c.mass[i], c.radius[i]));
    const double along = (vx * (c.vx[i] + c.ax[i]) + vy * (c.vy[i] + c.ay[i])) * dt;
    const double around = w * (c.spin[i] + c.alpha[i]) * dt;
    drag_loss += exact.loss(b.drag * along + b.drag_spin * around);
    pool_loss += exact.loss(b.pool * along + b.pool_spin * around);
    ends_loss += exact.loss(b.ends_loss);
    ends_torque += exact.torque(b.ends_torque);
    external += exact.torque(b.external);
    c.vx[i] += 2 * c.ax[i];
    c.vy[i] += 2 * c.ay[i];
    c.spin[i] += 2 * c.alpha[i];
    mass_moment += exact.mass_moment(c.mass[i] * c.x[i]);
  }

  Ledger& l = mill.ledger;
  const double losses[] = {sums.balls.normal,
                           sums.balls.sliding,
                           sums.wall.normal,
                           sums.wall.sliding,
                           sums.balls.rolling + sums.wall.rolling,
                           drag_loss,
                           pool_loss,
                           ends_loss};
  for (std::size_t k = 0; k < kCauses; ++k) l.dissipated[k] += losses[k];
  const double torque = sums.torque + ends_torque;
  l.torque += torque;
  l.torque_shear += sums.torque_shear;
  l.torque_external += external;
  l.drive_work += torque * mill_speed(mill.model, mill.step) * dt;
  l.mass_moment += mass_moment;
  ++l.steps;
}

}  // namespace tumble::sim
