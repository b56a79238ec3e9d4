#include <gtest/gtest.h>

#include "tests/support/balls.h"

namespace tumble::sim {
namespace {

// Speed of the contact point of a ball that was set down at `v0` without spin, after `seconds` [m/s].
double slip_after(const Effects& effects, double friction, double v0, double seconds) {
  const MillModel model = resting(smooth_mill(kFlat, effects, friction), 1e-5);
  RunningMill mill = start_mill(model, charge_of({on_floor(model, 0, v0)}));
  advance_by(mill, seconds);
  return vx_of(mill, 0) + spin_of(mill, 0) * 0.012;
}

// friction_weakening: the slip falls as u' = -7/2 g mu (1 - D + D exp(-u / v_s)). With w = exp(u / v_s) this is solved
// by (1 - D) w + D = ((1 - D) w_0 + D) exp(-7/2 g mu (1 - D) t / v_s).
TEST(Friction, WeakensWithTheSlidingSpeed) {
  for (const double drop : {0.4, 0.9})
    for (const double t : {0.05, 0.15}) {
      const double mu = 0.1, v_s = 0.25, v0 = 1;
      const double start = (1 - drop) * std::exp(v0 / v_s) + drop;
      const double now = start * std::exp(-3.5 * kGravity * mu * (1 - drop) * t / v_s);
      const double expected = v_s * std::log((now - drop) / (1 - drop));
      EXPECT_NEAR(slip_after({{"friction_weakening", {{"drop", {drop}}, {"sliding_speed", {v_s}}}}}, mu, v0, t),
                  expected, 1e-3)
          << "drop " << drop << ", " << t << " s";
    }
}

// wall_friction: mu (1 + increase) at the wall, u' = -7/2 mu g; and nothing between balls.
TEST(Friction, IsAnotherAtTheWall) {
  for (const double increase : {-0.5, 1.0})
    EXPECT_NEAR(slip_after({{"wall_friction", {{"increase", {increase}}}}}, 0.1, 1, 0.1),
                1 - 0.1 * 3.5 * kGravity * 0.1 * (1 + increase), 1e-3);
  const MillModel model = resting(smooth_mill(kFlat, {{"wall_friction", {{"increase", {1}}}}}, 0.1));
  EXPECT_DOUBLE_EQ(model.ball.springs.friction, 0.1);
}

}  // namespace
}  // namespace tumble::sim
