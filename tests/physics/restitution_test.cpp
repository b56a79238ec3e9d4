#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/balls.h"

namespace tumble::sim {
namespace {

// Ratio of relative speeds after and before a head-on impact, `phase` of a step later than a whole number of steps.
double ball_on_ball(double e, double steps_per_contact, double phase) {
  const LinearSpringDashpot law = springs(e);
  const double speed = 1, dt = contact_time(law, 0.06 * 0.525 / 0.585) / steps_per_contact;
  const double gap = speed * dt * (20 + phase);
  RunningMill mill = start_mill(smooth_shell(1, 0, law, dt),
                                charge_of({{.x = 0, .vx = speed}, {.radius = 0.025, .mass = 0.525, .x = 0.037 + gap}}));
  advance_by(mill, dt * 4 * steps_per_contact);
  return (vx_of(mill, 1) - vx_of(mill, 0)) / speed;
}

double ball_on_wall(double e, double steps_per_contact, double phase) {
  const LinearSpringDashpot law = springs(e);
  const double speed = 1, dt = contact_time(law, 0.06) / steps_per_contact;
  const double gap = speed * dt * (20 + phase);
  RunningMill mill = start_mill(smooth_shell(1, 0, law, dt), charge_of({{.x = 1 - 0.012 - gap, .vx = speed}}));
  advance_by(mill, dt * 4 * steps_per_contact);
  return -vx_of(mill, 0) / speed;
}

double worst_error(double (*impact)(double, double, double), double e, double steps_per_contact) {
  double worst = 0;
  for (int k = 0; k < 32; ++k) worst = std::max(worst, std::abs(impact(e, steps_per_contact, k / 32.0) - e));
  return worst;
}

// Eq. 13 gives e exactly; the time step must not spoil it, wherever in a step the impact begins. Second order: at n
// steps per contact no phase errs by more than 3.5 / n^2, be the step as long as "auto" makes it (20) or very short.
TEST(Restitution, IsWhatTheConfigSaysToTheSecondOrder) {
  for (const double e : {0.1, 0.2, 0.4, 0.6, 0.8, 0.97, 1.0})
    for (const double n : {20.0, 50.0, 100.0, 400.0}) {
      EXPECT_LT(worst_error(ball_on_ball, e, n), 3.5 / (n * n)) << "balls, e " << e << ", " << n << " steps";
      EXPECT_LT(worst_error(ball_on_wall, e, n), 3.5 / (n * n)) << "wall, e " << e << ", " << n << " steps";
    }
}

// 50 steps per contact: within 2e-4 in the mean over the phases, which is what a charge sees; 1.04e-3 at the worst.
TEST(Restitution, IsWithinAThousandthAtFiftySteps) {
  for (int k = 1; k <= 10; ++k) {
    const double e = 0.1 * k;
    double balls = 0, wall = 0;
    EXPECT_LT(worst_error(ball_on_ball, e, 50), 1.1e-3);
    EXPECT_LT(worst_error(ball_on_wall, e, 50), 1.1e-3);
    for (int p = 0; p < 32; ++p) {
      balls += ball_on_ball(e, 50, p / 32.0) / 32;
      wall += ball_on_wall(e, 50, p / 32.0) / 32;
    }
    EXPECT_NEAR(balls, e, 2e-4);
    EXPECT_NEAR(wall, e, 2e-4);
  }
}

// What the accounts call lost is what the balls have lost, to rounding, and it is one impact in the spectrum.
TEST(Restitution, LossesAreThoseOfTheMotion) {
  const LinearSpringDashpot law = springs(0.5);
  const double dt = contact_time(law, 0.03) / 20;
  RunningMill mill = start_mill(smooth_shell(1, 0, law, dt), charge_of({{.x = 0, .vx = 2}, {.x = 0.03}}));
  mill.ledger.counting_impacts = true;
  const double before = energies_of(mill).kinetic;
  advance_by(mill, 50 * dt * 4);
  const double lost = before - energies_of(mill).kinetic;
  EXPECT_NEAR(mill.ledger.dissipated[std::size_t(Cause::kBallBallNormal)], lost, 1e-12);
  EXPECT_NEAR(lost, 0.5 * 0.03 * 4 * (1 - 0.25), 0.01 * lost);
  EXPECT_EQ(mill.ledger.impacts.ball_ball.total[std::size_t(spectrum_bin(lost))], 1);
}

}  // namespace
}  // namespace tumble::sim
