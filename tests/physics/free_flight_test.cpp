#include <gtest/gtest.h>

#include "tests/support/balls.h"

namespace tumble::sim {
namespace {

// Central differences follow a parabola without error: what remains is rounding over 10,000 steps.
TEST(FreeFlight, IsAParabola) {
  const double dt = 1e-5, t = 0.1;
  RunningMill mill =
      start_mill(smooth_shell(1, kGravity, springs(0.8), dt), charge_of({{.x = -0.2, .vx = 3, .vy = 1, .spin = 7}}));
  advance_by(mill, t);
  EXPECT_NEAR(mill.charge.x[0], -0.2 + 3 * t, 1e-12);
  EXPECT_NEAR(mill.charge.y[0], t - kGravity * t * t / 2, 1e-12);
  EXPECT_NEAR(vy_of(mill, 0), 1 - kGravity * t, 1e-12);
  EXPECT_NEAR(mill.charge.angle[0], 7 * t, 1e-12);
}

}  // namespace
}  // namespace tumble::sim
