#include "core/frame.h"

#include <gtest/gtest.h>

namespace tumble {
namespace {

Frame in_flight(double t) {
  Frame f;
  f.time = t;
  f.mill_angle = 4 * t;
  f.x = {0.1 + 1.5 * t};
  f.y = {0.2 + 0.5 * t - 9.81 / 2 * t * t};
  f.vx = {1.5};
  f.vy = {0.5 - 9.81 * t};
  f.angle = {3 * t};
  f.spin = {3};
  return f;
}

TEST(Frame, BetweenTwoFramesAFlightIsExact) {
  const Frame f = between(in_flight(0.1), in_flight(0.15), 0.13), exact = in_flight(0.13);
  EXPECT_NEAR(f.y[0], exact.y[0], 1e-12);
  EXPECT_NEAR(f.vy[0], exact.vy[0], 1e-12);
  EXPECT_NEAR(f.x[0], exact.x[0], 1e-12);
  EXPECT_NEAR(f.angle[0], exact.angle[0], 1e-12);
  EXPECT_NEAR(f.mill_angle, exact.mill_angle, 1e-12);
}

TEST(Frame, BetweenStaysWithinItsTwoFrames) {
  EXPECT_EQ(between(in_flight(0.1), in_flight(0.2), 0.3).y[0], in_flight(0.2).y[0]);
  EXPECT_EQ(between(in_flight(0.1), in_flight(0.2), 0.0).y[0], in_flight(0.1).y[0]);
}

}  // namespace
}  // namespace tumble
