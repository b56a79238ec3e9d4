#include <gtest/gtest.h>

#include "tests/support/balls.h"

namespace tumble::sim {
namespace {

Effects rolling(double coefficient) { return {{"rolling_resistance", {{"coefficient", {coefficient}}}}}; }

// A sphere that rolls on a plane is slowed by 5/7 mu_r g: m a r = I a / r + mu_r r m g with I = 2/5 m r^2.
TEST(RollingResistance, SlowsARollingBall) {
  for (const double mu_r : {0.01, 0.1}) {
    const MillModel model = resting(smooth_mill(kFlat, rolling(mu_r), 0.5), 1e-5);
    Ball ball = on_floor(model, 0, 1);
    ball.spin = -1 / ball.radius;
    RunningMill mill = start_mill(model, charge_of({ball}));
    advance_by(mill, 0.3);
    const double slowed = 5.0 / 7 * mu_r * kGravity * 0.3;
    EXPECT_NEAR(1 - vx_of(mill, 0), slowed, 6e-4) << mu_r << ": less than the tremor of the start";
    const double lost = 0.7 * 0.06 * (1 - std::pow(1 - slowed, 2));
    EXPECT_NEAR(lost_by(mill, Cause::kRolling), lost, 0.01 * lost) << mu_r;
  }
}

// On a slope it stays where tan a < mu_r, and rolls off with 5/7 g (sin a - mu_r cos a) where the slope is steeper.
TEST(RollingResistance, HoldsOnASlope) {
  const double mu_r = 0.1;
  const MillModel model = resting(smooth_mill(kFlat, rolling(mu_r), 0.5), 1e-5);
  for (const double slope : {0.05, 0.099, 0.101, 0.2}) {
    RunningMill mill = start_mill(model, charge_of({on_floor(model, slope)}));
    advance_by(mill, 0.2);
    const double before = -vx_of(mill, 0) / std::cos(slope);
    advance_by(mill, 0.2);
    const double gained = -vx_of(mill, 0) / std::cos(slope) - before;
    const double expected = 0.2 * 5.0 / 7 * kGravity * (std::sin(slope) - mu_r * std::cos(slope));
    EXPECT_NEAR(gained, std::max(0.0, expected), 2e-4) << "slope " << slope;
  }
}

// Two balls that spin against each other and meet without friction: while the couple is at its limit it turns each
// ball's spin by mu_r R J / I, J the impulse (1 + e) m v, R = r / 2.
TEST(RollingResistance, BrakesSpinBetweenBalls) {
  const double mu_r = 0.05, spin = 200, v = 0.5;
  MillModel model = resting(smooth_mill(kFlat, rolling(mu_r), 0, 1));
  RunningMill mill =
      start_mill(model, charge_of({{.x = -0.0125, .vx = v, .spin = spin}, {.x = 0.0125, .spin = -spin}}));
  advance_by(mill, 0.01);
  const double change = mu_r * 0.006 * (2 * 0.03 * v) / inertia(0.06, 0.012);
  EXPECT_NEAR(spin - spin_of(mill, 0), change, 0.01 * change) << "the couple takes 0.5 % of the impact to build up";
  EXPECT_NEAR(spin_of(mill, 0) + spin_of(mill, 1), 0, 1e-9);
}

}  // namespace
}  // namespace tumble::sim
