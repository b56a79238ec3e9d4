#include <gtest/gtest.h>

#include "tests/support/balls.h"

namespace tumble::sim {
namespace {

// e(v) = e (1 - drop (1 - exp(-v / v_e))), v the normal speed at first touch: of ball on ball, and of a ball on the
// wall that goes along it ten times as fast.
TEST(ImpactRestitution, FallsWithTheNormalSpeed) {
  const double e = 0.9, drop = 0.4, v_e = 0.5;
  const Effects effects{{"impact_restitution", {{"drop", {drop}}, {"impact_speed", {v_e}}}}};
  for (const double v : {0.01, 0.1, 0.5, 2.0}) {
    const double expected = e * (1 - drop * (1 - std::exp(-v / v_e)));
    const MillModel model = resting(smooth_mill(kFlat, effects, 0, e));
    MillModel weightless = model;
    weightless.gravity = 0;
    RunningMill balls = start_mill(weightless, charge_of({{.x = -0.013, .vx = v}, {.x = 0.013}}));
    advance_by(balls, 0.005 + 0.003 / v);
    EXPECT_NEAR((vx_of(balls, 1) - vx_of(balls, 0)) / v, expected, 1e-3) << v << " m/s, balls";

    RunningMill wall = start_mill(weightless, charge_of({{.x = kFlat - 0.013, .vx = v, .vy = 10 * v}}));
    advance_by(wall, 0.005 + 0.003 / v);
    EXPECT_NEAR(-vx_of(wall, 0) / v, expected, 2e-3) << v << " m/s, wall";
  }
}

}  // namespace
}  // namespace tumble::sim
