#pragma once
#include "sim/kernels/kernels.h"
#include "sim/kernels/lanes.h"

// What acts on a ball by itself, at the positions' time.
namespace tumble::sim {

template <class Real>
struct EndsPush {
  Real fx = 0, fy = 0, torque = 0, loss = 0;
};

// Friction of the ends: a spring vector in the mill's frame, wound back to the limit. `pressed`: sum |F_n| [N].
template <class Real, class Memory>
EndsPush<Real> ends_push(const Memory& at, const ChargeView& c, const KickTerms& terms, const Real& pressed, int i,
                         const Real& x, const Real& y, const Real& vx, const Real& vy) {
  using std::sqrt;
  const EndWallFriction& ends = terms.body->ends;
  const double dt = terms.time_step, k = ends.stiffness;
  // Against the ends during the step, with the position in its middle: that at its end would let a ball that is held
  // drift outwards by W^2 r dt / 2.
  const Real mid_x = x - 0.5 * dt * vx, mid_y = y - 0.5 * dt * vy;
  const Real ux = (vx + terms.speed_before * mid_y) * dt, uy = (vy - terms.speed_before * mid_x) * dt;
  const Real end_x = at.load(c.end_x + i), end_y = at.load(c.end_y + i);
  const Real wound_x = end_x + ux * terms.cos + uy * terms.sin, wound_y = end_y + uy * terms.cos - ux * terms.sin;
  const Real most = ends.most_wound(at.load(c.mass + i), terms.gravity, pressed);
  const Real wound = sqrt(wound_x * wound_x + wound_y * wound_y);
  const Real kept = select(wound > most, most / wound, Real(1));
  const Real sx = kept * wound_x, sy = kept * wound_y;
  at.store(c.end_x + i, sx);
  at.store(c.end_y + i, sy);
  EndsPush<Real> p;
  p.loss = 0.5 * k * ((end_x + sx) * (wound_x - sx) + (end_y + sy) * (wound_y - sy));
  p.fx = -k * (sx * terms.cos - sy * terms.sin);
  p.fy = -k * (sy * terms.cos + sx * terms.sin);
  p.torque = x * p.fy - y * p.fx;
  return p;
}

template <class Real>
struct FluidPush {
  Real fx = 0, fy = 0, couple = 0;
  Real drag = 0, pool = 0;            // force over velocity [kg/s]
  Real drag_spin = 0, pool_spin = 0;  // couple over spin [N m s]
  Real vx = 0, vy = 0, spin = 0;      // velocities that these were taken at
};

template <class Real, class Memory>
FluidPush<Real> fluid_push(const Memory& at, const ChargeView& c, const KickTerms& terms, int i, const Real& y,
                           const Real& vx, const Real& vy, const Real& spin) {
  using std::sqrt;
  const BodyEffects& body = *terms.body;
  const Real r = at.load(c.radius + i);
  FluidPush<Real> p;
  p.vx = vx + at.load(c.ax + i);
  p.vy = vy + at.load(c.ay + i);
  p.spin = spin + at.load(c.alpha + i);
  const Real speed = sqrt(p.vx * p.vx + p.vy * p.vy);
  Real lift = 0;
  if (body.drag.on()) {
    p.drag = body.drag.per_velocity(r, speed);
    p.drag_spin = body.drag.per_spin(r);
  }
  if (body.tabulated.on()) p.drag += body.tabulated.per_velocity(r, speed);
  if (body.pool.on()) {
    const Real depth = body.pool.depth(y, r);
    const Real share = body.pool.volume(depth, r) / body.pool.volume(Real(2 * r), r);
    p.pool = share * body.pool.slurry.per_velocity(r, speed);
    p.pool_spin = share * body.pool.slurry.per_spin(r);
    lift = body.pool.lift(depth, r);
  }
  p.fx = -(p.drag + p.pool) * p.vx;
  p.fy = lift - (p.drag + p.pool) * p.vy;
  p.couple = -(p.drag_spin + p.pool_spin) * p.spin;
  return p;
}

}  // namespace tumble::sim
