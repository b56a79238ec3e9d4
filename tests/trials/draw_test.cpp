#include "trials/draw.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "core/effects.h"
#include "core/error.h"
#include "core/random.h"
#include "core/units.h"
#include "tests/support/small_mill.h"
#include "trials/conditions.h"
#include "trials/key_file.h"

namespace tumble::trials {
namespace {

DrawPlan plan_of(std::vector<Kind> kinds, std::size_t n, Tier tier = Tier::kTracks) {
  return {
      small_mill(), {{"contact.friction", 0.05, ""}, {"contact.normal_stiffness", 3e3, ""}}, std::move(kinds), tier, n};
}
std::vector<TrialKey> draw(const DrawPlan& plan, std::uint64_t seed = 1) {
  Random random(seed);
  return draw_keys(plan, [&] { return random.next(); });
}
std::map<std::string, int> names_in(const std::vector<TrialKey>& keys) {
  std::map<std::string, int> count;
  for (const TrialKey& key : keys)
    for (const Hidden& h : key.hidden) ++count[h.name];
  return count;
}

TEST(Draw, KindsAndWhatHidesInThemComeEquallyOften) {
  const std::vector<TrialKey> keys = draw(plan_of({Kind::kSingle, Kind::kNone}, 64));
  const auto count = names_in(keys);
  EXPECT_EQ(count.size(), 16u);  // ten effects and six artefacts
  for (const auto& [name, n] : count) EXPECT_EQ(n, 2) << name;
  EXPECT_EQ(std::count_if(keys.begin(), keys.end(), [](const TrialKey& k) { return k.kind == Kind::kNone; }), 32);
}

TEST(Draw, TheOrderIsByChance) {
  const DrawPlan plan = plan_of({Kind::kNone, Kind::kUnknown}, 40);
  const auto kinds = [&](std::uint64_t seed) {
    std::vector<Kind> list;
    for (const TrialKey& key : draw(plan, seed)) list.push_back(key.kind);
    return list;
  };
  EXPECT_EQ(kinds(1), kinds(1));
  EXPECT_NE(kinds(1), kinds(2));
}

TEST(Draw, StrengthsAndNuisancesKeepTheirRanges) {
  bool weaker = false, far = false;
  for (const TrialKey& key : draw(plan_of({Kind::kSingle}, 480))) {
    const Hidden& h = key.hidden.at(0);
    EXPECT_LE(std::abs(h.strength), 1.101) << h.name;
    EXPECT_TRUE(h.name == "filling_error" || std::abs(h.strength) >= 0.349) << h.name;  // whole balls
    EXPECT_TRUE(h.nature == Nature::kArtefact || h.name == "wall_friction" || h.strength > 0) << h.name;
    EXPECT_TRUE(h.name != "hertz_contact" || h.value <= 1);
    weaker = weaker || (h.name == "wall_friction" && h.strength < 0);
    const double z = (key.uncertain.at(0).second - 0.2) / 0.05;
    EXPECT_LE(std::abs(z), 2);
    far = far || std::abs(z) > 1.5;
  }
  EXPECT_TRUE(weaker) << "wall friction is never lowered";
  EXPECT_TRUE(far) << "friction is never far off";
}

TEST(Draw, PairsAreTwoEffects) {
  for (const TrialKey& key : draw(plan_of({Kind::kPair}, 45))) {
    ASSERT_EQ(key.hidden.size(), 2u);
    EXPECT_NE(key.hidden[0].name, key.hidden[1].name);
    EXPECT_EQ(key.hidden[0].nature, Nature::kPhysics);
  }
}

TEST(Draw, ScalarsHideNothingThatNoAngleAndNoTorqueShows) {
  const auto count = names_in(draw(plan_of({Kind::kArtefact}, 40, Tier::kScalars)));
  EXPECT_EQ(count.size(), 4u);
  EXPECT_FALSE(count.contains("camera_scale"));
}

TEST(Draw, RefusesWhatThisMillCannotHave) {
  DrawPlan plan = plan_of({Kind::kSingle}, 4);
  plan.uncertain = {{"charge.filling", 0.01, ""}};
  EXPECT_THROW(draw(plan), InputError);
  plan.uncertain = {{"contact.wall.friction", 0.01, ""}};  // not given in this mill
  EXPECT_THROW(draw(plan), InputError);
}

TEST(Conditions, TruthHasWhatIsHiddenAndWhatIsHandedOutHasNot) {
  const Config mill = small_mill();
  const std::vector<Condition> conditions = conditions_of(mill, {{0.5, 0.7, 0.9}, {0.8}, {0.25}});
  ASSERT_EQ(conditions.size(), 5u);
  EXPECT_TRUE(conditions[3].hold_out && conditions[4].hold_out && !conditions[2].hold_out);
  for (const TrialKey& key : draw(plan_of({Kind::kSingle, Kind::kPair, Kind::kTurnLocked, Kind::kUnknown}, 160)))
    for (const Condition& c : conditions) {
      const Config truth = true_config(mill, c, key), stated = stated_config(mill, c);
      EXPECT_EQ(truth.contact.friction, key.uncertain.at(0).second);
      EXPECT_EQ(stated.contact.friction, 0.2);
      for (const Hidden& h : key.hidden) {
        const double wrong = 1 + h.value, balls = *stated.charge.count;
        const Errors errors = errors_of(key);
        EXPECT_FALSE(has_effect(stated, h.name));
        EXPECT_EQ(has_effect(truth, h.name), h.nature == Nature::kPhysics) << h.name;
        EXPECT_NEAR(truth.mill.speed / stated.mill.speed, h.name == "speed_error" ? wrong : 1, 1e-12);
        EXPECT_NEAR(*truth.charge.count / balls, h.name == "filling_error" ? wrong : 1, 0.51 / balls);
        EXPECT_NEAR(errors.camera.scale, h.name == "camera_scale" ? h.value : 0, 1e-12);
        EXPECT_NEAR(errors.camera.rotation, h.name == "camera_rotation" ? h.value * kPi / 180 : 0, 1e-12);
        EXPECT_NEAR(errors.camera.clock, h.name == "frame_clock" ? h.value : 0, 1e-12);
        EXPECT_NEAR(errors.torque_offset, h.name == "torque_offset" ? h.value : 0, 1e-12);
      }
    }
}

TEST(Keys, ComeBackAsTheyWere) {
  for (const TrialKey& key : draw(plan_of({Kind::kTurnLocked, Kind::kPair, Kind::kUnknown}, 30))) {
    const std::string text = key_text(key);
    EXPECT_EQ(key_text(parse_key(text, "key")), text);
    EXPECT_EQ(parse_key(text, "key").uncertain, key.uncertain);
    EXPECT_EQ(parse_key(text, "key").seed, key.seed);
    EXPECT_EQ(key.salt.size(), 64u);
  }
}

}  // namespace
}  // namespace tumble::trials
