#include <gtest/gtest.h>

#include "tests/support/balls.h"

namespace tumble::sim {
namespace {

struct Descent {
  double acceleration = 0;  // down the slope [m/s2]
  double slip = 0;          // speed of the contact point [m/s]
};

// A ball let go on a slope, looked at between 0.1 and 0.3 s.
Descent let_go(double slope, double friction) {
  const MillModel model = resting(smooth_mill(kFlat, {}, friction), 1e-5);
  RunningMill mill = start_mill(model, charge_of({on_floor(model, slope)}));
  const auto down = [&] { return -vx_of(mill, 0) * std::cos(slope) - vy_of(mill, 0) * std::sin(slope); };
  advance_by(mill, 0.1);
  const double before = down();
  advance_by(mill, 0.2);
  return {(down() - before) / 0.2, down() - spin_of(mill, 0) * 0.012};
}

// It rolls with 5/7 g sin a as long as tan a < 7/2 mu, and slides with g (sin a - mu cos a) beyond. 0.1 %: what the
// slope changes over the way, and the tremor of the start: the tangential spring has no dashpot.
TEST(Slope, RollsUpToSevenHalvesOfTheFrictionAndSlidesBeyond) {
  for (const double mu : {0.1, 0.3}) {
    const double limit = std::atan(3.5 * mu);
    for (const double slope : {0.2 * limit, 0.7 * limit, 0.98 * limit}) {
      const Descent run = let_go(slope, mu);
      EXPECT_NEAR(run.acceleration, 5.0 / 7 * kGravity * std::sin(slope), 1e-3 * run.acceleration) << "mu " << mu;
      EXPECT_LT(std::abs(run.slip), 1e-3) << "mu " << mu;
    }
    for (const double slope : {1.02 * limit, 1.3 * limit}) {
      const Descent run = let_go(slope, mu);
      const double expected = kGravity * (std::sin(slope) - mu * std::cos(slope));
      EXPECT_NEAR(run.acceleration, expected, 1e-3 * expected) << "mu " << mu;
      EXPECT_GT(run.slip, 5e-3) << "mu " << mu;
    }
  }
}

}  // namespace
}  // namespace tumble::sim
