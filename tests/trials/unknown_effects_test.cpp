#include "trials/unknown_effects.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/effects.h"
#include "core/units.h"
#include "tests/support/small_mill.h"

namespace tumble::trials {
namespace {

using sim::BallState;
using sim::OutsidePush;

constexpr double kRadius = 0.012, kMass = 0.056, kShell = 0.15;

BallState ball() {
  BallState b;
  b.time = 10;
  b.mill_speed = 5;
  b.x = 0.03;
  b.y = -0.04;
  b.vx = 0.6;
  b.vy = -0.8;
  b.spin = 20;
  b.radius = kRadius;
  b.mass = kMass;
  return b;
}
OutsidePush push(const char* name, double value, const BallState& b) { return force_of(name, value, small_mill())(b); }
double outwards(const OutsidePush& p, const BallState& b) { return (p.fx * b.x + p.fy * b.y) / std::hypot(b.x, b.y); }
BallState at(double distance, double angle) {
  BallState b = ball();
  b.x = distance * std::cos(angle);
  b.y = distance * std::sin(angle);
  b.vx = b.vy = 0;
  return b;
}

TEST(UnknownEffects, AreNotInTheRegistry) {
  for (const UnknownEffect& e : unknown_effects()) {
    EXPECT_EQ(find_effect(e.name), nullptr) << e.name;
    EXPECT_TRUE(force_of(e.name, e.full, small_mill())) << e.name;
  }
}

TEST(UnknownEffects, MagnusLiftIsAcrossTheVelocity) {
  const OutsidePush p = push("magnus_lift", 1000, ball());
  const double lift = 1000 * kPi * std::pow(kRadius, 3) * 20;
  EXPECT_DOUBLE_EQ(p.fx, lift * 0.8);
  EXPECT_DOUBLE_EQ(p.fy, lift * 0.6);
  EXPECT_FALSE(p.reacts_on_mill);
}

// 24 mm is twice the mean radius: e-fold.
TEST(UnknownEffects, MagnetsFadeWithTheGap) {
  const double weight = kMass * kGravity;
  for (const char* name : {"shell_magnet", "magnetic_sector"}) {
    BallState b = at(kShell - kRadius, 0.5);
    EXPECT_NEAR(outwards(push(name, 0.8, b), b), 0.8 * weight, 1e-12);
    b = at(kShell - kRadius - 0.024, 0.5);
    EXPECT_NEAR(outwards(push(name, 0.8, b), b), 0.8 * weight / std::exp(1), 1e-12);
    b = at(kShell - kRadius, 1.2);  // beyond 60 degrees
    EXPECT_NEAR(outwards(push(name, 0.8, b), b), name[0] == 's' ? 0.8 * weight : 0, 1e-12);
    b.mill_angle = 0.7 + 4 * kPi;  // the shell has come round
    EXPECT_NEAR(outwards(push(name, 0.8, b), b), 0.8 * weight, 1e-12);
  }
}

// Eight lifters of 10 mm: 90 degrees of the shell are 8 mm nearer. It never pulls.
TEST(UnknownEffects, PackedPocketsHoldBallsOff) {
  BallState b = at(kShell - kRadius - 0.008 + 0.001, 1);
  EXPECT_NEAR(outwards(push("packed_pockets", 0.8, b), b), -3e4 * 0.001, 1e-9);
  b.vx = -10 * std::cos(1.0);
  b.vy = -10 * std::sin(1.0);
  EXPECT_EQ(outwards(push("packed_pockets", 0.8, b), b), 0);
  b = at(kShell - kRadius - 0.008 - 0.001, 1);
  EXPECT_EQ(push("packed_pockets", 0.8, b).fx, 0);
  b = at(kShell - kRadius, 2);
  EXPECT_EQ(push("packed_pockets", 0.8, b).fx, 0);
  b = at(kShell - kRadius, 1);
  b.time = 0;  // nothing has grown yet
  EXPECT_NEAR(push("packed_pockets", 0.8, b).fx, 0, 1e-9);
}

TEST(UnknownEffects, CentreTubeHoldsBallsOff) {
  BallState b = at(0.3 * kShell + kRadius - 0.002, 3);
  EXPECT_NEAR(outwards(push("centre_tube", 0.3, b), b), 3e4 * 0.002, 1e-9);
  b = at(0.3 * kShell + kRadius + 0.002, 3);
  EXPECT_EQ(push("centre_tube", 0.3, b).fx, 0);
  EXPECT_EQ(push("centre_tube", 0.3, at(0, 0)).fx, 0);
}

TEST(UnknownEffects, SwirlingFluidLetsBallsBeThatTurnWithIt) {
  BallState b = ball();
  b.vx = -b.mill_speed * b.y;
  b.vy = b.mill_speed * b.x;
  b.spin = b.mill_speed;
  OutsidePush p = push("swirling_fluid", 0.1, b);
  EXPECT_EQ(p.fx, 0);
  EXPECT_EQ(p.fy, 0);
  EXPECT_EQ(p.couple, 0);
  b.vx += 1;
  p = push("swirling_fluid", 0.1, b);
  EXPECT_NEAR(p.fx, -6 * kPi * 0.1 * kRadius, 1e-12);
  EXPECT_TRUE(p.reacts_on_mill);
}

TEST(UnknownEffects, WaterJetBlowsAboveTheAxis) {
  EXPECT_DOUBLE_EQ(push("water_jet", 0.2, at(0.1, 1)).fx, 0.2 * kMass * kGravity);
  EXPECT_EQ(push("water_jet", 0.2, ball()).fx, 0);
}

TEST(UnknownEffects, StandingGlassBrakesWhateverTheSpeed) {
  BallState b = ball();
  const OutsidePush p = push("standing_glass", 0.1, b);
  EXPECT_NEAR(p.fx, -0.1 * kMass * kGravity * 0.6, 1e-12);
  EXPECT_NEAR(p.fy, 0.1 * kMass * kGravity * 0.8, 1e-12);
  b.vx = b.vy = 0;
  EXPECT_EQ(push("standing_glass", 0.1, b).fx, 0);
}

}  // namespace
}  // namespace tumble::trials
