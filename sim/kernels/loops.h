#pragma once
#include "sim/kernels/body_push.h"
#include "sim/kernels/meeting.h"

// The loops of sim/kernels/kernels.h for one kind of lanes. No function for plain doubles may be compiled for more than
// every machine can run: the linker might take it for all.
namespace tumble::sim {

// body(k, memory) for every batch of [first, last).
template <class Real, class Body>
inline void over_balls(int first, int last, const Body& body) {
  constexpr int kSize = Lanes<Real>::kSize;
  int k = first;
  for (; k + kSize <= last; k += kSize) body(k, Whole<Real>{});
  if constexpr (kSize > 1)
    if (k < last) body(k, Rest<Real>{last - k});
}

template <class Real>
Real or_zero(const typename Lanes<Real>::Mask& yes, const Real& v) {
  return select(yes, v, Real(0));
}

template <class Real, bool kPlain>
BasicReaction<Real> step_of(const ContactModel& law, const Meeting<Real>& m, const typename Lanes<Real>::Mask& goes_on,
                            double time_step, double* numbers) {
  using L = Lanes<Real>;
  const auto load = [&](Column column) { return L::load(numbers + kGroup * column); };
  const auto keep = [&](Column column, const Real& next, const Real& old) {
    L::store(numbers + kGroup * column, select(goes_on, next, old));
  };
  BasicTouch<Real> now = m.now;
  now.damping = load(kDamping);
  BasicContactState<Real> s{load(kOverlap), load(kDashpot), load(kSpring), load(kNormalLost), load(kSlidingLost)};
  const BasicContactState<Real> before = s;
  BasicReaction<Real> r;
  if constexpr (kPlain) {
    r = touch(law.springs, now, false, time_step, s);
    keep(kDashpot, s.dashpot, before.dashpot);
  } else {
    BasicTermState<Real> t{load(kForce), load(kStored), load(kTermDamping), load(kRoll)};
    const BasicTermState<Real> t_before = t;
    r = touch(law, now, m.pair, false, time_step, s, t);
    keep(kForce, t.force, t_before.force);
    keep(kStored, t.stored, t_before.stored);
    keep(kRoll, t.roll, t_before.roll);
  }
  keep(kOverlap, s.overlap, before.overlap);
  keep(kSpring, s.spring, before.spring);
  keep(kNormalLost, s.normal_lost, before.normal_lost);
  keep(kSlidingLost, s.sliding_lost, before.sliding_lost);
  return r;
}

template <class Real>
struct Loops {
  using L = Lanes<Real>;

  [[gnu::flatten]] static int near_of(const GridView& g, int p, int first, int last, double skin, bool smaller,
                                      int* out_p, int* out_q) {
    const Real x = g.x[p], y = g.y[p], radius = g.radius[p], reach = g.radius[p] + skin;
    int found = 0;
    for (int q = first; q < last; q += L::kSize) {
      const Real dx = L::load(g.x + q) - x, dy = L::load(g.y + q) - y, other = L::load(g.radius + q);
      const auto near = balls_touch(dx, dy, reach + other) & (smaller ? other < radius : other <= radius);
      L::fill(out_p + found, p);
      found += L::append(out_q + found, q, L::bits(near) & L::below(last - q));
    }
    return found;
  }

  [[gnu::flatten]] static void gaps(const GridView& g, const int* p, const int* q, int n, double* gap) {
    using std::sqrt;
    for (int k = 0; k < n; k += L::kSize) {
      const Real dx = L::gather(g.x, q + k) - L::gather(g.x, p + k), dy = L::gather(g.y, q + k) - L::gather(g.y, p + k);
      const Real reach = L::gather(g.radius, p + k) + L::gather(g.radius, q + k);
      L::store(gap + k, select(balls_touch(dx, dy, reach), Real(-1), sqrt(dx * dx + dy * dy) - reach));
    }
  }

  // Those of n for which the mask of `touches(k)` is set.
  template <class Touches>
  static int hits_of(int n, int* hits, const Touches& touches) {
    int found = 0;
    for (int k = 0; k < n; k += L::kSize) {
      const unsigned bits = L::bits(touches(k)) & L::below(n - k);
      if (bits != 0) found += L::append(hits + found, k, bits);
    }
    return found;
  }
  [[gnu::flatten]] static int touching_pairs(const ChargeView& c, const int* i, const int* j, int n, int* hits) {
    return hits_of(n, hits, [&](int k) {
      const Real dx = L::gather(c.x, j + k) - L::gather(c.x, i + k), dy = L::gather(c.y, j + k) - L::gather(c.y, i + k);
      return balls_touch(dx, dy, L::gather(c.radius, i + k) + L::gather(c.radius, j + k));
    });
  }
  [[gnu::flatten]] static int touching_plate(const ChargeView& c, double shell_radius, const int* i, int n, int* hits) {
    return hits_of(n, hits, [&](int k) {
      const auto at = nearest_on_plate(shell_radius, L::gather(c.x, i + k), L::gather(c.y, i + k));
      return at.distance < L::gather(c.radius, i + k);
    });
  }
  [[gnu::flatten]] static int touching_lifters(const ChargeView& c, const ConvexLifters& lifters, const int* i,
                                               const int* j, int n, int* hits) {
    return hits_of(n, hits, [&](int k) {
      const auto at = nearest_on_convex(lifters, j + k, L::gather(c.x, i + k), L::gather(c.y, i + k));
      return at.distance < L::gather(c.radius, i + k);
    });
  }

  [[gnu::flatten]] static std::uint64_t nearest_of_runs(const ChargeView& c, const LifterRuns& lifters, const int* i,
                                                        const int* j, int n, WallPoints& out) {
    std::uint64_t unsure = 0;
    for (int k = 0; k < n; k += L::kSize) {
      const RunPoint<Real> p =
          nearest_on_runs(lifters, j + k, L::gather(c.x, i + k), L::gather(c.y, i + k), L::gather(c.radius, i + k));
      L::store(out.distance + k, p.at.distance);
      L::store(out.nx + k, p.at.nx);
      L::store(out.ny + k, p.at.ny);
      unsure |= std::uint64_t{L::bits(p.unsure) & L::below(n - k)} << k;
    }
    return unsure;
  }

  // `meet(k)`: how contact k meets; `push_of` what follows from the reaction.
  template <bool kPlain, bool kAtWall, class Meet, class PushOf>
  static void block(const ContactModel& law, double time_step, const ContactColumns& columns, int first, int last,
                    Pushes& out, ContactSums& sums, const Meet& meet, const PushOf& push_of) {
    Real normal = 0, sliding = 0, rolling = 0, torque = 0, shear = 0;
    std::uint64_t touching = 0, too_deep = 0;
    for (int k = first; k < last; k += L::kSize) {
      const Meeting<Real> m = meet(k);
      const auto goes_on = m.touches & L::first(last - k);
      const BasicReaction<Real> r = step_of<Real, kPlain>(law, m, goes_on, time_step, columns.of(k));
      const Push<Real> p = push_of(m, r);
      const int b = k % kBlock;
      touching |= std::uint64_t{L::bits(goes_on)} << b;
      too_deep |= std::uint64_t{L::bits(goes_on & m.too_deep)} << b;
      const Real fx = or_zero(goes_on, p.fx), fy = or_zero(goes_on, p.fy), pressure = or_zero(goes_on, p.pressure);
      const Real on_i_x = kAtWall ? fx : -fx, on_i_y = kAtWall ? fy : -fy;
      L::store_rows(out.on_i + kRow * b, on_i_x, on_i_y, or_zero(goes_on, p.moment_i), pressure);
      if constexpr (!kAtWall) L::store_rows(out.on_j + kRow * b, fx, fy, or_zero(goes_on, p.moment_j), pressure);
      normal += or_zero(goes_on, p.normal_loss);
      sliding += or_zero(goes_on, p.sliding_loss);
      if constexpr (kAtWall) {
        torque += or_zero(goes_on, p.torque);
        shear += or_zero(goes_on, p.torque_shear);
      }
      if constexpr (!kPlain) rolling += or_zero(goes_on, p.rolling_loss);
    }
    const int n = last - first;
    const std::uint64_t all = n == kBlock ? ~std::uint64_t{0} : (std::uint64_t{1} << n) - 1;
    out.parted = all & ~touching;
    out.too_deep = too_deep;
    sums.add({L::sum(normal), L::sum(sliding), L::sum(rolling), L::sum(torque), L::sum(shear)});
  }

  template <bool kPlain>
  [[gnu::flatten]] static void balls_by(const ContactStep& step, const ContactColumns& columns, int first, int last,
                                        Pushes& out, ContactSums& sums) {
    block<kPlain, false>(
        *step.law, step.time_step, columns, first, last, out, sums,
        [&](int k) { return balls_meet<Real, kPlain>(*step.balls, columns.i + k, columns.j + k, step.time_step); },
        [&](const Meeting<Real>& m, const BasicReaction<Real>& r) { return push_of_balls(m, r, *step.exact); });
  }
  static void balls(const ContactStep& step, const ContactColumns& columns, int first, int last, Pushes& out,
                    ContactSums& sums) {
    const auto loop = columns.columns == kPlainColumns ? balls_by<true> : balls_by<false>;
    loop(step, columns, first, last, out, sums);
  }

  template <bool kPlain, class Point>
  [[gnu::flatten]] static void wall_by(const ContactStep& step, const ContactColumns& columns, int first, int last,
                                       Pushes& out, ContactSums& sums, const Point& point) {
    block<kPlain, true>(
        *step.law, step.time_step, columns, first, last, out, sums,
        [&](int k) {
          const NearestPoint<Real> at = point(k);
          return wall_meets<Real, kPlain>(*step.balls, columns.i + k, step.wall, at.distance, at.nx, at.ny,
                                          step.time_step);
        },
        [&](const Meeting<Real>& m, const BasicReaction<Real>& r) { return push_of_wall(m, r, *step.exact); });
  }
  template <class Point>
  static void wall(const ContactStep& step, const ContactColumns& columns, int first, int last, Pushes& out,
                   ContactSums& sums, const Point& point) {
    const auto loop = columns.columns == kPlainColumns ? wall_by<true, Point> : wall_by<false, Point>;
    loop(step, columns, first, last, out, sums, point);
  }
  static void plate(const ContactStep& step, const ContactColumns& columns, int first, int last, Pushes& out,
                    ContactSums& sums) {
    const ChargeView& c = *step.balls;
    wall(step, columns, first, last, out, sums, [&](int k) {
      return nearest_on_plate(step.wall.shell_radius, L::gather(c.x, columns.i + k), L::gather(c.y, columns.i + k));
    });
  }
  static void lifters(const ContactStep& step, const ContactColumns& columns, int first, int last,
                      const WallPoints& points, Pushes& out, ContactSums& sums) {
    const ChargeView& c = *step.balls;
    if (step.lifters->faces > 0)
      wall(step, columns, first, last, out, sums, [&](int k) {
        return nearest_on_convex(*step.lifters, columns.j + k, L::gather(c.x, columns.i + k),
                                 L::gather(c.y, columns.i + k));
      });
    else
      wall(step, columns, first, last, out, sums, [&](int k) {
        const int b = k % kBlock;
        return NearestPoint<Real>{L::load(points.distance + b), L::load(points.nx + b), L::load(points.ny + b)};
      });
  }

  static void scatter(const double* rows, const int* at, int n, const ForceView& force) {
    // Said to the compiler, which does not see it by itself: a row goes as one.
    typedef double Row __attribute__((vector_size(kRow * sizeof(double)), aligned(sizeof(double)), may_alias));
    const Row* from = reinterpret_cast<const Row*>(rows);
    Row* sums = reinterpret_cast<Row*>(force.rows);
    for (int k = 0; k < n; ++k) sums[at[k] & force.mask] += from[k];
  }

  [[gnu::flatten]] static void drift(const ChargeView& c, double time_step, int first, int last) {
    using std::max;
    over_balls<Real>(first, last, [&](int i, const auto& at) {
      at.store(c.x + i, at.load(c.x + i) + at.load(c.vx + i) * time_step);
      const Real y = at.load(c.y + i) + at.load(c.vy + i) * time_step, apex = at.load(c.apex + i);
      at.store(c.y + i, y);
      // Few balls rise freely: most of the time there is nothing to write.
      if (L::bits(y > apex) != 0) at.store(c.apex + i, max(apex, y));
      at.store(c.angle + i, at.load(c.angle + i) + at.load(c.spin + i) * time_step);
    });
  }

  template <bool kEnds, bool kFluids>
  [[gnu::flatten]] static void kick_by(const ChargeView& c, const KickTerms& terms, const ExactSums& exact,
                                       const ForceView& force, int first, int last, KickSums& sums) {
    using std::max;
    const double half_fall = 0.5 * terms.gravity * terms.time_step;
    Real fastest2 = 0, squares = 0, mass_moment = 0;
    Real ends_torque = 0, ends_loss = 0, drag_loss = 0, pool_loss = 0, external = 0;
    over_balls<Real>(first, last, [&](int i, const auto& at) {
      double* rows = force.rows + kRow * (i & force.mask);
      const Real x = at.load(c.x + i), y = at.load(c.y + i);
      Real vx = at.load(c.vx + i), vy = at.load(c.vy + i), spin = at.load(c.spin + i);
      Real pushed_x = 0, pushed_y = 0, turned = 0, pressed = 0;
      at.take_rows(rows, pushed_x, pushed_y, turned, pressed);
      Real own_x = 0, own_y = 0, couple = 0;
      if constexpr (kEnds) {
        const EndsPush<Real> p = ends_push<Real>(at, c, terms, pressed, i, x, y, vx, vy);
        own_x += p.fx;
        own_y += p.fy;
        ends_torque += at.counted(exact.torque(p.torque));
        ends_loss += at.counted(exact.loss(p.loss));
      }
      FluidPush<Real> fluid;
      if constexpr (kFluids) {
        fluid = fluid_push<Real>(at, c, terms, i, y, vx, vy, spin);
        own_x += fluid.fx;
        own_y += fluid.fy;
        couple += fluid.couple;
        external += at.counted(exact.torque(x * fluid.fy - y * fluid.fx + fluid.couple));
      }
      const Real per_force = at.load(c.half_step_per_mass + i);
      const Real ax = (pushed_x + own_x) * per_force, ay = (pushed_y + own_y) * per_force - half_fall;
      const Real alpha = (turned + couple) * at.load(c.half_step_per_inertia + i);
      if constexpr (kFluids) {
        // Forces at the step's middle, mean of the velocities before and after.
        const Real along = (fluid.vx * (vx + ax) + fluid.vy * (vy + ay)) * terms.time_step;
        const Real around = fluid.spin * (spin + alpha) * terms.time_step;
        drag_loss += at.counted(exact.loss(fluid.drag * along + fluid.drag_spin * around));
        pool_loss += at.counted(exact.loss(fluid.pool * along + fluid.pool_spin * around));
      }
      vx += 2 * ax;
      vy += 2 * ay;
      spin += 2 * alpha;
      at.store(c.ax + i, ax);
      at.store(c.ay + i, ay);
      at.store(c.alpha + i, alpha);
      at.store(c.vx + i, vx);
      at.store(c.vy + i, vy);
      at.store(c.spin + i, spin);
      mass_moment += exact.mass_moment(at.load(c.mass + i) * x);
      const Real square = at.counted(vx * vx + vy * vy);
      squares += square;
      fastest2 = max(fastest2, square);
    });
    const double moment_sum = L::sum(mass_moment);
    sums.add({L::largest(fastest2), moment_sum, L::sum(ends_torque), L::sum(ends_loss), L::sum(drag_loss),
              L::sum(pool_loss), L::sum(external), std::isfinite(moment_sum + L::sum(squares))});
  }
  static void kick(const ChargeView& c, const KickTerms& terms, const ExactSums& exact, const ForceView& force,
                   int first, int last, KickSums& sums) {
    const bool ends = terms.body->ends.on(), fluids = terms.body->in_fluid();
    const auto loop = ends ? (fluids ? kick_by<true, true> : kick_by<true, false>)
                           : (fluids ? kick_by<false, true> : kick_by<false, false>);
    loop(c, terms, exact, force, first, last, sums);
  }
};

template <class Real>
constexpr Kernels kernels_of(const char* name) {
  using Loop = Loops<Real>;
  return {name,
          Loop::near_of,
          Loop::gaps,
          Loop::touching_pairs,
          Loop::touching_plate,
          Loop::touching_lifters,
          Loop::nearest_of_runs,
          Loop::balls,
          Loop::plate,
          Loop::lifters,
          Loop::scatter,
          Loop::drift,
          Loop::kick};
}

}  // namespace tumble::sim
