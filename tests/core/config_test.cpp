#include "core/config.h"
#include "core/effects.h"

#include <gmock/gmock.h>

#include "core/error.h"
#include "tests/support/mills.h"

namespace tumble {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string complaint(const Config& config) {
  try {
    check_complete(config);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(Config, PaperMillHasThePapersNumbers) {
  Config config = paper_mill();
  EXPECT_EQ(complaint(config), "");
  EXPECT_THAT(class_counts(config), ElementsAre(79, 24, 9));
  EXPECT_NEAR(critical_speed_rpm(config.mill), 57.3, 0.05);  // 42.3 / sqrt(D): the paper's 57.8 takes D - d
  EXPECT_NEAR(slice_mass(config, {79, 24, 9}), 79 * 0.06 + 24 * 0.195 + 9 * 0.525, 1e-12);
  // 127 kg of balls in the mill, of 14 kg a slice: the paper's nine slices.
  config.mill.length = 0.304;
  config.charge.count.reset();
  config.charge.filling = 0.385;
  EXPECT_NEAR(slice_count(config), 9.4, 0.3);
}

TEST(Config, FillingChoosesTheNearestNumberOfBalls) {
  Config config = paper_mill();
  config.charge.count.reset();
  config.charge.filling = 0.3;
  const auto counts = class_counts(config);
  const double found = filling_of(config, counts);
  const double one_ball = 0.025 * 0.025 / (0.82 * 0.2725 * 0.2725);
  EXPECT_NEAR(found, 0.3, one_ball / 2);
}

TEST(Config, OneLayerIsOneSlice) {
  Config config = paper_mill();
  EXPECT_EQ(slice_count(config), 1);  // no length
  config.mill.length = 0.03;          // below 1.5 mean diameters
  EXPECT_EQ(slice_count(config), 1);
  config.mill.slices = 9;
  EXPECT_EQ(slice_count(config), 9);
}

TEST(Config, RefusesWhatCannotBeAMillAndNamesTheKey) {
  const auto broken = [](auto&& change) {
    Config config = paper_mill();
    change(config);
    return complaint(config);
  };
  EXPECT_THAT(broken([](Config& c) { c.mill.diameter = -0.5; }), HasSubstr("mill.diameter: is -0.5"));
  EXPECT_THAT(broken([](Config& c) { c.mill.diameter = kNotGiven; }), HasSubstr("mill.diameter: is missing"));
  EXPECT_THAT(broken([](Config& c) { c.mill.speed_rpm = 40; }), HasSubstr("excludes mill.speed"));
  EXPECT_THAT(broken([](Config& c) { c.mill.speed = 70; }), HasSubstr("mill.speed_rpm"));  // per cent, or rev/min
  EXPECT_THAT(broken([](Config& c) {
                c.mill.speed = kNotGiven;
                c.mill.speed_rpm = 1e6;
              }),
              HasSubstr("mill.speed_rpm: is 1e+06"));
  EXPECT_THAT(broken([](Config& c) { c.run.revolutions = 1e9; }), HasSubstr("run.revolutions"));
  EXPECT_THAT(broken([](Config& c) { c.run.frames_per_second = 1e-9; }), HasSubstr("run.frames_per_second"));
  EXPECT_THAT(broken([](Config& c) { c.mill.lifters.count = 90; }), HasSubstr("overlap"));
  EXPECT_THAT(broken([](Config& c) { c.mill.lifters.height = 0.3; }), HasSubstr("axis"));
  EXPECT_THAT(broken([](Config& c) { c.charge.balls[0].radius = 12; }), HasSubstr("does not fit"));
  EXPECT_THAT(broken([](Config& c) { c.charge.balls.clear(); }), HasSubstr("charge.balls: is missing"));
  EXPECT_THAT(broken([](Config& c) { c.charge.filling = 0.3; }), HasSubstr("excludes charge.filling"));
  EXPECT_THAT(broken([](Config& c) { c.charge.count = 400; }), HasSubstr("charge.count: 400 balls fill 1.4"));
  EXPECT_THAT(broken([](Config& c) {
                c.charge.count.reset();
                c.charge.filling = 0.95;
              }),
              HasSubstr("at most 0.8"));
  EXPECT_THAT(broken([](Config& c) { c.contact.restitution = 1.2; }), HasSubstr("contact.restitution"));
  EXPECT_THAT(broken([](Config& c) { c.origin["contact.friction"] = "my.toml:7", c.contact.friction = -1; }),
              HasSubstr("my.toml:7: contact.friction"));
}

// A partial file for the analyser may know the filling and not yet the balls.
TEST(Config, AcceptsAFillingOfBallsWithoutARadius) {
  Config config = paper_mill();
  config.charge.count.reset();
  config.charge.filling = 0.3;
  config.charge.balls = {BallClass{}};
  EXPECT_NO_THROW(check(config));
}

TEST(Config, WallTakesTheBallsValuesUnlessItHasItsOwn) {
  Config config = paper_mill();
  config.contact.friction = 0.3;
  config.contact.wall.friction = kNotGiven;
  config.contact.wall.restitution = 0.4;
  const Contact wall = wall_contact(config);
  EXPECT_EQ(wall.friction, 0.3);
  EXPECT_EQ(wall.restitution, 0.4);
  EXPECT_EQ(wall.normal_stiffness, config.contact.normal_stiffness);
}

TEST(Config, FrictionFallsLinearlyWithTheMillsSpeedAndNeverBelowZero) {
  Config config = paper_mill();
  config.contact.friction = 0.4;
  config.contact.wall.friction = 0.2;
  config.contact.friction_drop_at_critical = 0.5;
  config.mill.speed = 0.8;
  EXPECT_DOUBLE_EQ(ball_contact(config).friction, 0.4 * (1 - 0.5 * 0.8));
  EXPECT_DOUBLE_EQ(wall_contact(config).friction, 0.2 * (1 - 0.5 * 0.8));
  config.mill.speed = 2.5;
  EXPECT_EQ(ball_contact(config).friction, 0);
}

TEST(Config, AnEffectOfStrengthZeroCountsAsAbsent) {
  Config config = paper_mill();
  config.effects["wall_friction"]["increase"] = {0};
  EXPECT_FALSE(has_effect(config, "wall_friction"));
  config.effects["wall_friction"]["increase"] = {0.5};
  EXPECT_TRUE(has_effect(config, "wall_friction"));
}

TEST(Config, RefusesTablesThatAreNone) {
  const auto with = [](std::vector<double> speed, std::vector<double> friction) {
    Config config = paper_mill();
    config.effects["tabulated_friction"] = {{"speed", std::move(speed)}, {"friction", std::move(friction)}};
    return complaint(config);
  };
  EXPECT_EQ(with({0, 0.5, 1}, {0.2, 0.1, 0.3}), "");
  EXPECT_THAT(with({0, 0.5}, {0.2}),
              HasSubstr("tabulated_friction.friction: has 1 rows and speed 2, must have as many"));
  EXPECT_THAT(with({}, {0.2}), HasSubstr("must have as many"));
  EXPECT_THAT(with({0, 1, 0.5}, {0.2, 0.2, 0.2}), HasSubstr("goes from 1 to 0.5, must ascend"));
  EXPECT_THAT(with({0, 1}, {0.2, -0.1}), HasSubstr("must lie between 0 and 10"));
  EXPECT_THAT(with(std::vector<double>(33, 1), std::vector<double>(33, 0.2)), HasSubstr("at most 32"));
}

TEST(Config, RefusesEffectsOutOfRangeWithoutStrengthOrOfLiftersThatTheMillHasNot) {
  const auto with = [](const char* effect, const char* key, double value) {
    Config config = paper_mill();
    config.effects[effect][key] = {value};
    return complaint(config);
  };
  EXPECT_THAT(with("friction_weakening", "drop", 1.5), HasSubstr("effects.friction_weakening.drop"));
  EXPECT_THAT(with("friction_weakening", "sliding_speed", 0.25), HasSubstr("has no strength; give drop"));
  EXPECT_THAT(with("missing_lifters", "lifters", 18), HasSubstr("the mill's lifters are 0 to 17"));
  EXPECT_THAT(with("speed_ripple", "order", 1.5), HasSubstr("must be whole"));
}

}  // namespace
}  // namespace tumble
