#include <gtest/gtest.h>

#include "tests/support/balls.h"

namespace tumble::sim {
namespace {

// theta = W t + (a / n) (sin(n W t + p) - sin p): its slope is the speed that walls and torque are computed with, the
// speed's extremes are W (1 +- a), and a revolution takes as long as without ripple.
TEST(SpeedRipple, VariesTheSpeedAboutItsMean) {
  const double a = 0.3, n = 3, p = 50;
  MillModel model =
      resting(smooth_mill(1, {{"speed_ripple", {{"amplitude", {a}}, {"order", {n}}, {"phase_deg", {p}}}}}), 1e-4);
  const double w = model.speed = 2 * kPi / 2;  // 2 s a revolution: 20,000 steps
  double fastest = 0, slowest = INFINITY, worst = 0;
  for (std::int64_t k = 1; k < 20'000; ++k) {
    const double slope = (mill_angle(model, k + 1) - mill_angle(model, k - 1)) / 2e-4;
    worst = std::max(worst, std::abs(slope - mill_speed(model, k)));
    fastest = std::max(fastest, mill_speed(model, k));
    slowest = std::min(slowest, mill_speed(model, k));
  }
  EXPECT_LT(worst, 1e-6 * w);
  EXPECT_NEAR(fastest, w * (1 + a), 1e-5 * w);
  EXPECT_NEAR(slowest, w * (1 - a), 1e-5 * w);
  EXPECT_EQ(mill_angle(model, 0), 0);
  EXPECT_NEAR(mill_angle(model, 20'000), 2 * kPi, 1e-12);
  EXPECT_NEAR(mill_speed(model, 0), w * (1 + a * std::cos(p * kPi / 180)), 1e-12);
}

}  // namespace
}  // namespace tumble::sim
