#include "core/slow_motion.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble {
namespace {

constexpr double kGap = 0.04;  // between stored frames [s]

// Balls of 12 mm that fly through each other's places, so that they must have met between the frames.
Frame at(double time, const std::vector<double>& x, const std::vector<double>& vx) {
  Frame f;
  f.time = time;
  f.x = x;
  f.vx = vx;
  f.y = f.vy = f.angle = f.spin = std::vector<double>(x.size(), 0.0);
  return f;
}

double apart(const Frame& f) { return std::abs(f.x[1] - f.x[0]); }

TEST(SlowMotion, BallsDoNotPassThroughOneAnother) {
  const Balls balls{{0.012, 0.012}, {0.06, 0.06}};
  const Frame a = at(0, {0, 0.05}, {1, -1}), b = at(kGap, {0.05, 0}, {1, -1});  // as if nothing were in the way
  double least = 1;
  for (int k = 1; k < 40; ++k) {
    const double time = kGap * k / 40;
    least = std::min(least, apart(between(a, b, time)));
    EXPECT_GE(apart(slow_motion(a, b, balls, time)), 0.9 * 0.024 - 0.1 * 0.012) << time;
  }
  EXPECT_LT(least, 0.003);  // the paths cross
}

TEST(SlowMotion, KeepsAnOverlapThatTheFramesHave) {
  const Balls balls{{0.012, 0.012}, {0.06, 0.06}};
  const Frame a = at(0, {0, 0.016}, {0.1, 0.1}), b = at(kGap, {0.004, 0.020}, {0.1, 0.1});
  EXPECT_NEAR(apart(slow_motion(a, b, balls, 0.01)), 0.016, 1e-12);
}

TEST(SlowMotion, LeavesStoredFramesAndFreeBallsAlone) {
  const Balls balls{{0.012, 0.012}, {0.06, 0.06}};
  const Frame a = at(0, {0, 0.05}, {1, 1}), b = at(kGap, {0.04, 0.09}, {1, 1});
  EXPECT_EQ(slow_motion(a, b, balls, kGap / 3).x, between(a, b, kGap / 3).x);
  const Frame through = at(0, {0, 0.001}, {1, -1});
  EXPECT_EQ(slow_motion(through, b, balls, 0).x, through.x);
}

}  // namespace
}  // namespace tumble
