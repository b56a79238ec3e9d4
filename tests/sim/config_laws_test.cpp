#include "sim/config_laws.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"
#include "tests/support/mills.h"

namespace tumble::sim {
namespace {

constexpr double kMass = 0.06, kRadius = 0.012;

ConfigLaws::Meeting balls_at(double closing, double slip, double roll = 0) {
  return {false, kMass, kRadius, kMass, kRadius, closing, slip, roll};
}

TEST(ConfigLaws, BallsReboundByTheRestitutionInForce) {
  Config config = paper_mill();
  config.effects["impact_restitution"] = {{"drop", {0.4}}, {"impact_speed", {0.5}}};
  const ConfigLaws laws(config);
  for (const double v : {0.1, 0.5, 2.0}) {
    const double share = 1 - 0.4 * (1 - std::exp(-v / 0.5));
    EXPECT_DOUBLE_EQ(laws.restitution(false, v), 0.8 * share);
    EXPECT_NEAR(laws.rebound(balls_at(v, 0)).parting, 0.8 * share * v, 4e-3 * v);
    EXPECT_NEAR(laws.rebound({true, kMass, kRadius, 0, 0, v, 0, 0}).parting, 0.4 * share * v, 4e-3 * v);
  }
}

// Who slides through takes mu times the normal impulse (of a dashpot that pulls at the end, a little more), whichever
// way it slides; who sticks at most what stops the slip.
TEST(ConfigLaws, FrictionActsAgainstTheSlip) {
  Config config = paper_mill();
  config.contact.restitution = 1;
  const ConfigLaws laws(config);
  EXPECT_NEAR(laws.rebound(balls_at(1, 3)).sliding, -0.1 * 2, 2e-3);
  EXPECT_NEAR(laws.rebound(balls_at(1, -3)).sliding, 0.1 * 2, 2e-3);
  EXPECT_LT(std::abs(laws.rebound(balls_at(1, 0.05)).sliding), 2 * 0.05 / 3.5);
}

TEST(ConfigLaws, RollingTakesItsShareOfTheImpulse) {
  Config config = paper_mill();
  config.contact.restitution = 1;
  config.effects["rolling_resistance"]["coefficient"] = {0.05};
  const double impulse = 2 * kMass / 2;  // of 1 m/s
  EXPECT_NEAR(ConfigLaws(config).rebound(balls_at(1, 0, 80)).couple, -0.05 * kRadius / 2 * impulse,
              0.02 * 0.05 * kRadius / 2 * impulse);
}

TEST(ConfigLaws, FliersFeelFluidPoolAndEnds) {
  Config config = paper_mill();
  const ConfigLaws::Flying ball{kRadius, kMass, 0.1, 0, 3, -4};
  EXPECT_EQ(ConfigLaws(config).acceleration(ball)[1], 0);
  config.effects["tabulated_drag"] = {{"speed", {0}}, {"coefficient", {0.3}}, {"radius_power", {0}}};
  EXPECT_NEAR(ConfigLaws(config).acceleration(ball)[0], -0.3 / kMass * 3, 1e-12);
  config.effects = {{"end_wall_friction", {{"coefficient", {0.05}}}}};
  const ConfigLaws ends(config);
  const auto a = ends.acceleration(ball);
  const double uy = -4 - ends.mill_speed() * 0.1;  // the end goes up there
  EXPECT_NEAR(std::hypot(a[0], a[1]), 0.05 * kGravity, 1e-12);
  EXPECT_NEAR(a[1] / a[0], uy / 3, 1e-12);
  config.effects = {
      {"slurry_pool", {{"density", {1500}}, {"viscosity", {0}}, {"level", {0.5}}, {"drag_coefficient", {0}}}}};
  EXPECT_NEAR(ConfigLaws(config).acceleration(ball)[1], 1500 * kGravity * 4.0 / 3 * kPi * std::pow(kRadius, 3) / kMass,
              1e-9);
}

}  // namespace
}  // namespace tumble::sim
