#include "io/experiments_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "core/error.h"
#include "io/config_file.h"
#include "tests/io/folder.h"

namespace tumble::io {
namespace {

using ExperimentsInFolder = InFolder;

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;
using testing::StartsWith;

const char* const kMill = R"([mill]
diameter = 0.55
speed = 0.7
[charge]
count = 20
balls = [ { radius = 0.011, density = 7800 } ]
)";

std::string message_of(const std::string& toml) {
  try {
    parse_experiments(toml, "e.toml", ".");
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}

TEST_F(ExperimentsInFolder, ReadsEveryPartOfTheFormat) {
  std::ofstream(folder_ / "torque.csv") << "time_s,torque_N_m\n0,1\n";
  std::ofstream(folder_ / "e.toml") << R"([[experiment]]
name = "J35-70"
set = { "mill.speed" = 0.70, "charge.count" = 169, run.spin_up = "auto", "charge.balls" = [ { radius = 0.01, mass = 0.1 } ] }
power_W = 28.0
power_uncertainty_W = 0.5
toe_deg = 232
toe_uncertainty_deg = 2.5
shoulder_bulk_deg = 18.0

[[experiment]]
name = "second"
hold_out = true
torque_series = "torque.csv"

[uncertain]
"contact.friction" = 0.05
contact.wall.restitution = 0.1
"effects.rolling_resistance.coefficient" = 0.01
)";
  const Experiments all = read_experiments(folder_ / "e.toml");
  ASSERT_EQ(all.list.size(), 2u);
  const Experiment& first = all.list[0];
  EXPECT_EQ(first.power.value, 28);
  EXPECT_EQ(first.power.se, 0.5);
  EXPECT_EQ(first.toe_deg.se, 2.5);
  EXPECT_EQ(first.shoulder_bulk_deg.value, 18);
  EXPECT_TRUE(std::isnan(first.shoulder_bulk_deg.se));
  EXPECT_TRUE(std::isnan(first.torque.value));
  EXPECT_FALSE(first.hold_out);
  EXPECT_TRUE(all.list[1].hold_out);
  EXPECT_EQ(all.list[1].torque_series, folder_ / "torque.csv");
  ASSERT_EQ(all.uncertain.size(), 3u);

  const Config mill = config_of(parse_config(kMill, "mill.toml"), first, {"run.seed=7"});
  EXPECT_EQ(mill.mill.speed, 0.7);
  EXPECT_EQ(mill.charge.count, 169);
  EXPECT_TRUE(mill.run.spin_up_auto);
  EXPECT_EQ(mill.run.seed, 7u);
  ASSERT_EQ(mill.charge.balls.size(), 1u);
  EXPECT_EQ(mill.charge.balls[0].mass, 0.1);
}

TEST(ExperimentsFile, NamesPlaceFindingAndRemedy) {
  const std::string head = "[[experiment]]\nname = \"a\"\n";
  const std::vector<std::pair<std::string, std::string>> cases{
      {"", "e.toml: holds no experiment; give [[experiment]] tables"},
      {"[experiment]\nname = \"a\"\n",
       "e.toml:1: experiment: must be a list of tables: begin each experiment with "
       "[[experiment]]"},
      {"[[experiments]]\nname = \"a\"\n", "e.toml:1: experiments: unknown key; did you mean experiment?"},
      {"[[experiment]]\npower_W = 1\n", "e.toml:1: an experiment without a name; give name = \"...\""},
      {head,
       "e.toml:1: a: brings no data; give power_W, torque_N_m, toe_deg, shoulder_deg, film, motion, tracks or "
       "torque_series"},
      {head + "power_w = 1\n", "e.toml:3: a: power_w: unknown key; did you mean power_W?"},
      {head + "power_W = \"1\"\n", "e.toml:3: a: power_W: must be a number"},
      {head + "power_W = nan\n", "e.toml:3: a: power_W: must be a number"},
      {head + "power_W = 1\npower_uncertainty_W = 0\n", "e.toml:4: a: power_uncertainty_W: found 0, must be > 0 W"},
      {head + "power_W = 10\npower_uncertainty_W = 1e-6\n",
       "e.toml:4: a: power_uncertainty_W is 1e-06, less than a millionth of power_W; give one standard "
       "deviation of the measurement, such as 0.1 W"},
      {head + "power_W = 1\ntoe_uncertainty_deg = 2\n", "e.toml:4: a: toe_uncertainty_deg without toe_deg"},
      {head + "power_W = 1\ntorque_N_m = 2\n",
       "e.toml:4: a: torque_N_m given beside power_W, which says the same; keep one of the two"},
      {head + "toe_deg = 400\n", "e.toml:3: a: toe_deg: found 400, must be an angle in degrees, 0 to below 360"},
      {head + "film = \"nowhere.mp4\"\n", "e.toml:3: a: film: no such file: ./nowhere.mp4"},
      {head + "power_W = 1\nhold_out = 1\n", "e.toml:4: hold_out: must be true or false"},
      {head + "power_W = 1\n" + head + "power_W = 1\n", "e.toml:4: a second experiment named \"a\"; give each its own"},
      {head + "power_W = 1\n[uncertain]\n\"contact.frction\" = 1\n",
       "e.toml:5: uncertain: contact.frction: is no key of MILL.toml that holds a number; did you mean "
       "contact.friction?"},
      {head + "power_W = 1\n[uncertain]\n\"contact.law\" = 1\n",
       "e.toml:5: uncertain: contact.law: is no key of MILL.toml that holds a number; did you mean contact.friction?"},
      {head + "power_W = 1\nset = { mill.speed = 0.7, mill.speed_rpm = 40 }\n",
       "e.toml:1: a: sets mill.speed and mill.speed_rpm, which say the same; keep one of the two"},
      {head + "power_W = 1\n[uncertain]\n\"contact.friction\" = -1\n",
       "e.toml:5: uncertain: contact.friction: found -1, must be a standard deviation, > 0"},
  };
  for (const auto& [toml, message] : cases) EXPECT_EQ(message_of(toml), message);
  EXPECT_THAT(message_of("[[experiment]\n"), StartsWith("e.toml:1: not valid TOML"));
}

TEST(ExperimentsFile, SettingsThatDoNotFitTheMillNameTheExperiment) {
  const Config mill = parse_config(kMill, "mill.toml");
  const auto refusal = [&](const std::string& set) -> std::string {
    const auto all =
        parse_experiments("[[experiment]]\nname = \"a\"\npower_W = 1\nset = { " + set + " }\n", "e.toml", ".");
    try {
      config_of(mill, all.list[0]);
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  };
  EXPECT_EQ(refusal("\"mill.sped\" = 0.7"), "e.toml:1: a: mill.sped: unknown key; did you mean mill.speed?");
  EXPECT_THAT(refusal("\"charge.filling\" = 0.95"), StartsWith("e.toml:1: a: charge.filling: "));
  EXPECT_THAT(refusal("\"mill.speed\" = \"fast\""), HasSubstr("found the string \"fast\""));
}

TEST_F(ExperimentsInFolder, ReadsATableOfMeasurements) {
  std::ofstream(folder_ / "m.csv") << "# a comment\nmill.speed_rpm,power_W,power_uncertainty_W,hold_out\n"
                                      "20,5.5,0.5,\n30,9,,true\n";
  const Experiments all = read_measured(folder_ / "m.csv");
  ASSERT_EQ(all.list.size(), 2u);
  EXPECT_THAT(all.list[0].sets, ElementsAre(Pair("mill.speed_rpm", "20")));
  EXPECT_EQ(all.list[0].power.se, 0.5);
  EXPECT_TRUE(all.list[1].hold_out);
  std::ofstream(folder_ / "bad.csv") << "speed_rpm,power_W\n20,5.5\n";
  EXPECT_THROW(read_measured(folder_ / "bad.csv"), InputError);
}

TEST_F(ExperimentsInFolder, RefusesInATableWhatItRefusesInEXPERIMENTS) {
  const auto message = [&](const std::string& text) -> std::string {
    std::ofstream(folder_ / "m.csv") << text;
    try {
      read_measured(folder_ / "m.csv");
    } catch (const InputError& e) {
      return e.what();
    }
    return "no error";
  };
  EXPECT_THAT(message("mill.speed,toe_deg\n0.6,230\n0.7,400\n"),
              HasSubstr("m.csv:3:5: toe_deg: found 400, must be an angle in degrees, 0 to below 360"));
  EXPECT_THAT(message("mill.speed,power_W\n0.6,5\n0.7,\n"), HasSubstr("m.csv:3:1: brings no data; give power_W"));
  EXPECT_THAT(message("mill.speed\n0.6\n"), HasSubstr("m.csv:2:1: brings no data"));
  EXPECT_THAT(message("power_W,torque_N_m\n5,2\n"), HasSubstr("m.csv:2:3: torque_N_m given beside power_W"));
  EXPECT_THAT(message("toe_deg,power_uncertainty_W\n230,2\n"),
              HasSubstr("m.csv:2:5: power_uncertainty_W without power_W"));
  EXPECT_THAT(message("power_W,power_uncertainty_W\n5,-2\n"), HasSubstr("power_uncertainty_W: found -2, must be > 0"));
  EXPECT_THAT(message("charge.count,charge.filling,power_W\n5,0.3,7\n"),
              HasSubstr("which say the same; keep one of the two"));
}

}  // namespace
}  // namespace tumble::io
