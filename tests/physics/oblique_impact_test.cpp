#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/balls.h"

namespace tumble::sim {
namespace {

// The plane impact of spheres by the linear model, in time and not in steps: normal oscillator (m, k_n, C) for its half
// wave, and the slip u at the contact, which has the inertia 2/7 m, on a spring that is wound back to mu |F_n|. Both
// motions are exact within an interval; 1e5 intervals leave 1e-5 where sticking turns to sliding.
// Returns the slip at parting.
double slip_after_impact(const LinearSpringDashpot& law, double m, double normal_speed, double slip) {
  const double z = -std::log(law.restitution) / std::hypot(std::log(law.restitution), kPi);
  const double w0 = std::sqrt(law.normal_stiffness / m), wd = w0 * std::sqrt(1 - z * z);
  const double m_t = 2.0 / 7 * m, wt = std::sqrt(law.tangential_stiffness / m_t);
  const int intervals = 100'000;
  const double h = kPi / wd / intervals, c = std::cos(wt * h), s = std::sin(wt * h);
  const auto force = [&](double t) {  // k_n d + C v: what brakes the normal motion
    const double decay = normal_speed * std::exp(-z * w0 * t);
    const double d = decay * std::sin(wd * t) / wd, v = decay * std::cos(wd * t) - z * w0 * d;
    return m * (w0 * w0 * d + 2 * z * w0 * v);
  };
  double u = slip, spring = 0;
  for (int k = 0; k < intervals; ++k) {
    const double stuck = spring * c + u / wt * s, limit = law.friction * std::abs(force((k + 1) * h));
    if (std::abs(stuck) * law.tangential_stiffness <= limit) {
      u = u * c - spring * wt * s;
      spring = stuck;
    } else {
      spring = std::copysign(limit / law.tangential_stiffness, stuck);
      u -= std::copysign(law.friction * std::abs(force((k + 0.5) * h)) * h / m_t, stuck);
    }
  }
  return u;
}

constexpr double kSpeed = 0.002;  // so slow that the overlap does not shorten the arm: the linear model has no scale

// The simulator's slip at parting, over the speed of the impact, at this angle from the normal.
double on_the_wall(const LinearSpringDashpot& law, double degrees_from_normal, double steps, double phase = 0.3) {
  const double a = degrees_from_normal * kPi / 180, vn = kSpeed * std::cos(a), vt = kSpeed * std::sin(a);
  const double dt = contact_time(law, 0.06) / steps;
  RunningMill mill = start_mill(smooth_shell(100, 0, law, dt),
                                charge_of({{.x = 100 - 0.012 - (2 + phase) * vn * dt, .vx = vn, .vy = vt}}));
  advance_by(mill, 2.5 * steps * dt);
  EXPECT_NEAR(spin_of(mill, 0) * 0.012, 2.5 * (vy_of(mill, 0) - vt), 1e-4 * kSpeed) << "the impulse turns as it brakes";
  return (vy_of(mill, 0) + 0.012 * spin_of(mill, 0)) / kSpeed;
}

double ball_on_ball(const LinearSpringDashpot& law, double degrees_from_normal, double steps, double phase) {
  const double a = degrees_from_normal * kPi / 180, vn = kSpeed * std::cos(a), vt = kSpeed * std::sin(a);
  const double dt = contact_time(law, 0.06 * 0.525 / 0.585) / steps;
  RunningMill mill =
      start_mill(smooth_shell(2, 0, law, dt), charge_of({{.x = -0.012 - (2 + phase) * vn * dt, .vx = vn, .vy = vt},
                                                         {.radius = 0.025, .mass = 0.525, .x = 0.025}}));
  advance_by(mill, 2.5 * steps * dt);
  return (vy_of(mill, 0) + 0.012 * spin_of(mill, 0) - vy_of(mill, 1) + 0.025 * spin_of(mill, 1)) / kSpeed;
}

// Two limits in closed form. All sliding, no dashpot: the impulse is 2 m v_n mu, the slip falls by 7 mu v_n. All
// sticking, no dashpot: the slip swings as cos(w_t t) through the half wave of the normal oscillator. (With a dashpot
// F_n changes sign before the parting, and there the spring is wound back whatever mu.)
TEST(ObliqueImpact, SlidesOrSticksInClosedForm) {
  for (const double angle : {60.0, 80.0}) {
    const double a = angle * kPi / 180;
    EXPECT_NEAR(on_the_wall(springs(1, 0.1), angle, 200), std::sin(a) - 0.7 * std::cos(a), 2e-4) << angle;
  }
  const double expected = std::sin(40 * kPi / 180) * std::cos(kPi * std::sqrt(3.5 * 3e5 / 4e5));
  EXPECT_NEAR(on_the_wall(springs(1, 1e3), 40, 2000), expected, 2e-3);
}

// Everything between: sticking, sliding at first and at last, sliding throughout. The tangential part errs in the first
// order of the step, by what the phase of the impact within a step does to the spring: 2.5e-3 at 200 steps.
TEST(ObliqueImpact, FollowsTheLinearModelAtEveryAngle) {
  for (const double e : {0.4, 0.8, 1.0})
    for (const double mu : {0.1, 0.4}) {
      const LinearSpringDashpot law = springs(e, mu);
      for (double angle = 2; angle <= 80; angle += 6) {
        const double a = angle * kPi / 180;
        const double expected = slip_after_impact(law, 1, std::cos(a), std::sin(a));
        for (const double phase : {0.1, 0.5, 0.9}) {
          EXPECT_NEAR(on_the_wall(law, angle, 200, phase), expected, 2.5e-3)
              << "wall, e " << e << ", mu " << mu << ", " << angle;
          EXPECT_NEAR(ball_on_ball(law, angle, 200, phase), expected, 2.5e-3)
              << "balls, e " << e << ", mu " << mu << ", " << angle;
        }
      }
    }
}

}  // namespace
}  // namespace tumble::sim
