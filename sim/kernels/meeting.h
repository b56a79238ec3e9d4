#pragma once
#include "sim/kernels/kernels.h"
#include "sim/kernels/lanes.h"

// How two bodies meet at one step: what the laws want to know, and which way the forces point.
namespace tumble::sim {

template <class Real>
struct Meeting {
  BasicTouch<Real> now;
  BasicPairing<Real> pair;  // of a model that is not plain
  Real nx = 0, ny = 0;      // unit vector from ball i to ball j, or into the wall
  Real arm_i = 0, arm_j = 0;
  typename Lanes<Real>::Mask touches{};
  typename Lanes<Real>::Mask too_deep{};
  Real px = 0, py = 0;  // on the wall [m]
};

// The square of a distance at which two balls begin to touch. Everybody asks in this way, so that all agree.
template <class Real>
auto balls_touch(const Real& dx, const Real& dy, const Real& reach) {
  return dx * dx + dy * dy < reach * reach;
}

template <class Real, bool kPlain>
Meeting<Real> balls_meet(const ChargeView& c, const int* i, const int* j, double time_step) {
  using L = Lanes<Real>;
  using std::sqrt;
  Meeting<Real> m;
  const Real dx = L::gather(c.x, j) - L::gather(c.x, i), dy = L::gather(c.y, j) - L::gather(c.y, i);
  const Real radius_i = L::gather(c.radius, i), radius_j = L::gather(c.radius, j), reach = radius_i + radius_j;
  const Real d = sqrt(dx * dx + dy * dy), per_d = 1 / d;
  m.touches = balls_touch(dx, dy, reach);
  m.nx = dx * per_d;
  m.ny = dy * per_d;
  const Real dvx = L::gather(c.vx, j) - L::gather(c.vx, i), dvy = L::gather(c.vy, j) - L::gather(c.vy, i);
  const Real dax = L::gather(c.ax, j) - L::gather(c.ax, i), day = L::gather(c.ay, j) - L::gather(c.ay, i);
  const Real spin_i = L::gather(c.spin, i), spin_j = L::gather(c.spin, j);
  m.now.overlap = reach - d;
  m.now.approach = -(dvx * m.nx + dvy * m.ny) * time_step;
  m.now.closing = -((dvx + dax) * m.nx + (dvy + day) * m.ny);
  // The contact lies half the overlap inside either ball.
  m.arm_i = radius_i - 0.5 * m.now.overlap;
  m.arm_j = radius_j - 0.5 * m.now.overlap;
  m.now.slide = (dvy * m.nx - dvx * m.ny - (m.arm_i * spin_i + m.arm_j * spin_j)) * time_step;
  m.too_deep = (m.now.overlap > 0.5 * radius_i) | (m.now.overlap > 0.5 * radius_j);
  if constexpr (!kPlain) {
    m.pair.effective_radius = radius_i * radius_j / reach;
    m.pair.roll = (spin_j - spin_i) * time_step;
  }
  return m;
}

// The wall's point moves with Omega x p.
template <class Real, bool kPlain>
Meeting<Real> wall_meets(const ChargeView& c, const int* i, const WallMotion& wall, const Real& distance,
                         const Real& nx, const Real& ny, double time_step) {
  using L = Lanes<Real>;
  Meeting<Real> m;
  const Real radius = L::gather(c.radius, i), spin = L::gather(c.spin, i);
  m.touches = distance < radius;
  m.nx = nx;
  m.ny = ny;
  m.arm_i = distance;
  m.px = L::gather(c.x, i) + distance * nx;
  m.py = L::gather(c.y, i) + distance * ny;
  const Real dvx = -wall.speed_before * m.py - L::gather(c.vx, i), dvy = wall.speed_before * m.px - L::gather(c.vy, i);
  const Real dax = -wall.faster * m.py - L::gather(c.ax, i), day = wall.faster * m.px - L::gather(c.ay, i);
  m.now.overlap = radius - distance;
  m.now.approach = -(dvx * nx + dvy * ny) * time_step;
  m.now.closing = -((dvx + dax) * nx + (dvy + day) * ny);
  m.now.slide = (dvy * nx - dvx * ny - distance * spin) * time_step;
  m.too_deep = m.now.overlap > 0.5 * radius;
  if constexpr (!kPlain) {
    m.pair.effective_radius = radius;
    m.pair.roll = (wall.speed_before - spin) * time_step;
  }
  return m;
}

template <class Real>
struct NearestPoint {
  Real distance, nx, ny;
};
template <class Real>
NearestPoint<Real> nearest_on_plate(double shell_radius, const Real& x, const Real& y) {
  using std::sqrt;
  const Real rho = sqrt(x * x + y * y), per_rho = 1 / rho;
  return {shell_radius - rho, x * per_rho, y * per_rho};
}

// As nearest_on_wall of sim/shell.h, number by number; a centre in the steel comes out with the face it is nearest to.
template <class Real>
NearestPoint<Real> nearest_on_convex(const ConvexLifters& lifters, const int* feature, const Real& x, const Real& y) {
  using L = Lanes<Real>;
  using std::sqrt;
  const Real cos = L::gather(lifters.cos - 1, feature), sin = L::gather(lifters.sin - 1, feature);
  const Real u = x * cos + y * sin, v = y * cos - x * sin;
  Real out = (u - lifters.x[0]) * lifters.nx[0] + (v - lifters.y[0]) * lifters.ny[0];
  Real fx = lifters.x[0], fy = lifters.y[0], tx = lifters.tx[0], ty = lifters.ty[0];
  Real nx = lifters.nx[0], ny = lifters.ny[0], length = lifters.length[0];
  for (int f = 1; f < lifters.faces; ++f) {
    const Real d = (u - lifters.x[f]) * lifters.nx[f] + (v - lifters.y[f]) * lifters.ny[f];
    const auto farther = d > out;
    out = select(farther, d, out);
    fx = select(farther, Real(lifters.x[f]), fx);
    fy = select(farther, Real(lifters.y[f]), fy);
    tx = select(farther, Real(lifters.tx[f]), tx);
    ty = select(farther, Real(lifters.ty[f]), ty);
    nx = select(farther, Real(lifters.nx[f]), nx);
    ny = select(farther, Real(lifters.ny[f]), ny);
    length = select(farther, Real(lifters.length[f]), length);
  }
  const Real along = (u - fx) * tx + (v - fy) * ty;
  const Real end = select(along > Real(0), length, Real(0));
  const Real dx = fx + end * tx - u, dy = fy + end * ty - v;
  const Real d = sqrt(dx * dx + dy * dy), per_d = 1 / d;
  const auto on_face = ((along > Real(0)) & (along < length)) | (out <= Real(0));
  const Real px = select(on_face, -nx, dx * per_d), py = select(on_face, -ny, dy * per_d);
  return {select(on_face, out, d), px * cos - py * sin, px * sin + py * cos};
}

template <class Real>
struct RunPoint {
  NearestPoint<Real> at;
  typename Lanes<Real>::Mask unsure;  // within reach, but behind the run or on it
};

// As nearest_on_wall of sim/shell.h, number by number, for balls that touch what they see.
template <class Real>
RunPoint<Real> nearest_on_runs(const LifterRuns& lifters, const int* feature, const Real& x, const Real& y,
                               const Real& radius) {
  using L = Lanes<Real>;
  using Mask = typename L::Mask;
  using std::max;
  using std::min;
  using std::sqrt;
  const Real cos = L::gather(lifters.cos - 1, feature), sin = L::gather(lifters.sin - 1, feature);
  const Real u = x * cos + y * sin, v = y * cos - x * sin;
  const Real of_run = L::gather(lifters.run_of, feature), reach = 1.000001 * radius, reach2 = reach * reach;
  const auto reaches = [&](const auto& circle) {
    const Real dx = u - circle.x, dy = v - circle.y, span = reach + circle.reach;
    return dx * dx + dy * dy <= span * span;
  };
  Real face = 0;  // the nearest
  Mask near = Mask(false);
  for (int r = 0; r < lifters.count; ++r) {
    const Run& run = lifters.runs[r];
    const Mask mine = (of_run == Real(r)) & reaches(run);
    if (L::bits(mine) == 0) continue;
    if (run.convex) {
      Real out = -lifters.out_of_sight;
      for (int k = run.begin; k < run.end; ++k) {
        const LifterFace& f = lifters.faces[k];
        const Real d = out_of(f, u, v);
        face = select(mine & (d > out), Real(f.number), face);
        out = max(out, d);
      }
      near = near | (mine & (out < reach));
      continue;
    }
    Real d2 = reach2;
    for (int b = run.first_block; b < run.last_block; ++b) {
      if (L::bits(mine & reaches(lifters.blocks[b])) == 0) continue;
      for (int k = lifters.blocks[b].begin; k < lifters.blocks[b].end; ++k) {
        const LifterFace& f = lifters.faces[k];
        const Real square = foot_on(f, u, v).d2;
        face = select(mine & (square < d2), Real(f.number), face);
        d2 = min(d2, square);
      }
    }
    near = near | (mine & (d2 < reach2));
  }
  if (L::bits(near) == 0) return {{Real(lifters.out_of_sight), Real(1), Real(0)}, near};

  int at[L::kSize];
  L::store_ints(at, face * Real(sizeof(LifterFace) / sizeof(double)));
  const LifterFace* faces = lifters.faces;
  const BasicFace<Real> f{
      L::gather(&faces->x, at),  L::gather(&faces->y, at),  L::gather(&faces->tx, at),     L::gather(&faces->ty, at),
      L::gather(&faces->nx, at), L::gather(&faces->ny, at), L::gather(&faces->length, at), face};
  L::store_ints(at, face * Real(sizeof(FaceCorners) / sizeof(double)));
  const FaceCorners* corners = lifters.corners;
  const Foot<Real> foot = foot_on(f, u, v);
  const Mask found = near & (foot.d2 < reach2);
  const Mask at_start = foot.along <= Real(0), at_corner = at_start | (foot.along >= f.length);
  const Real cx = select(at_start, L::gather(&corners->sx, at), L::gather(&corners->ex, at));
  const Real cy = select(at_start, L::gather(&corners->sy, at), L::gather(&corners->ey, at));
  const Real out = out_of(f, u, v);
  const Real in_front = select(at_corner, -(foot.dx * cx + foot.dy * cy), out);
  const Real d = sqrt(foot.d2), per_d = 1 / d;
  const Real distance = select(at_corner, d, out);
  const Real px = select(at_corner, foot.dx * per_d, -f.nx), py = select(at_corner, foot.dy * per_d, -f.ny);
  const Mask unsure = found & ((in_front < Real(0)) | (foot.d2 <= Real(0)));
  return {{select(found, distance, Real(lifters.out_of_sight)), select(found, px * cos - py * sin, Real(1)),
           select(found, px * sin + py * cos, Real(0))},
          unsure};
}

// What a contact does to its two bodies, every number rounded for the sums it goes into.
template <class Real>
struct Push {
  Real fx = 0, fy = 0, moment_i = 0, moment_j = 0, pressure = 0;
  Real normal_loss = 0, sliding_loss = 0, rolling_loss = 0;
  Real torque = 0, torque_shear = 0;
};

template <class Real>
Push<Real> push_of_balls(const Meeting<Real>& m, const BasicReaction<Real>& r, const ExactSums& exact) {
  using std::abs;
  Push<Real> p;
  p.fx = exact.force(r.normal * m.nx - r.tangential * m.ny);
  p.fy = exact.force(r.normal * m.ny + r.tangential * m.nx);
  p.moment_i = exact.moment(-(m.arm_i * r.tangential) - r.couple);
  p.moment_j = exact.moment(-(m.arm_j * r.tangential) + r.couple);
  p.pressure = exact.force(abs(r.normal));
  p.normal_loss = exact.loss(r.normal_loss);
  p.sliding_loss = exact.loss(r.sliding_loss);
  p.rolling_loss = exact.loss(r.rolling_loss);
  return p;
}

template <class Real>
Push<Real> push_of_wall(const Meeting<Real>& m, const BasicReaction<Real>& r, const ExactSums& exact) {
  using std::abs;
  Push<Real> p;
  const Real sx = r.tangential * m.ny, sy = -r.tangential * m.nx;
  const Real fx = sx - r.normal * m.nx, fy = sy - r.normal * m.ny;
  p.fx = exact.force(fx);
  p.fy = exact.force(fy);
  p.moment_i = exact.moment(-(m.arm_i * r.tangential) - r.couple);
  p.pressure = exact.force(abs(r.normal));
  p.normal_loss = exact.loss(r.normal_loss);
  p.sliding_loss = exact.loss(r.sliding_loss);
  p.rolling_loss = exact.loss(r.rolling_loss);
  p.torque = exact.torque(m.px * fy - m.py * fx - r.couple);
  p.torque_shear = exact.torque(m.px * sy - m.py * sx);
  return p;
}

}  // namespace tumble::sim
