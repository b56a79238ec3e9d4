#include "diagnose/suspects.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/effects.h"

namespace tumble::diagnose {
namespace {

std::set<std::string> names_of(const std::vector<Suspect>& suspects) {
  std::set<std::string> names;
  for (const Suspect& s : suspects) names.insert(s.name);
  return names;
}

Config mill() {
  Config config;
  config.mill.speed = 0.7;
  config.mill.lifters.profile = LifterProfile::kRectangle;
  config.mill.lifters.count = 18;
  config.charge.count = 112;
  return config;
}

TEST(Suspects, AreAllEffectsThatHaveAStrengthAndAllErrorsOfMeasurement) {
  const std::set<std::string> names = names_of(suspects_of(mill()));
  for (const Effect& e : all_effects())  // a table can say anything
    EXPECT_EQ(names.contains(e.name), !std::string(e.name).starts_with("tabulated")) << e.name;
  for (const char* artefact :
       {"camera_scale", "camera_rotation", "frame_clock", "filling_error", "speed_error", "torque_offset"})
    EXPECT_TRUE(names.contains(artefact)) << artefact;
}

TEST(Suspects, WhatTheMillHasAlreadyIsNone) {
  Config config = mill();
  config.effects["rolling_resistance"]["coefficient"] = {0.01};
  config.mill.lifters.profile = LifterProfile::kNone;
  const std::set<std::string> names = names_of(suspects_of(config));
  EXPECT_FALSE(names.contains("rolling_resistance"));
  EXPECT_FALSE(names.contains("lifter_wear"));
}

TEST(Suspects, StrengthsBecomeKeysOfTheMill) {
  for (const Suspect& s : suspects_of(mill())) {
    if (s.name == "rolling_resistance") {
      EXPECT_EQ(sets_at(s, 0.5), std::vector<std::string>{"effects.rolling_resistance.coefficient=0.01"});
    } else if (s.name == "filling_error") {
      EXPECT_EQ(sets_at(s, -1), std::vector<std::string>{"charge.count=106"});
    }
    EXPECT_TRUE(s.low <= 0 || s.low == s.high);
    EXPECT_GT(s.high, 0);
    EXPECT_NE(s.is_simulated(),
              s.torque_offset != 0 || s.observer.scale != 0 || s.observer.rotation != 0 || s.observer.clock != 0);
  }
}

}  // namespace
}  // namespace tumble::diagnose
