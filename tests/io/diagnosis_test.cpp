#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/effects.h"
#include "core/suspect_words.h"
#include "io/config_file.h"
#include "io/diagnosis_file.h"
#include "io/diagnosis_words.h"
#include "io/experiments_file.h"

namespace tumble::io {
namespace {

using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

const std::string kMill = R"(# Ours, in the hall.
[mill]
diameter = 0.545              # inside the shell, “as drawn”
speed = 0.7                   # by the tachometer
[mill.lifters]
count = 12
profile = "rectangle"
height = 0.02
width = 0.02
[charge]
count = 100                   # counted
balls = [ { radius = 0.012, mass = 0.060, share = 1.0 } ]
[contact]
friction = 0.2
[effects.fluid_drag]
viscosity = 0                 # dry
)";

FoundEffect effect(const char* name, NameKind kind, const char* parameter, double value, double se,
                   double probability = 0.98) {
  return {name, kind, {{parameter, "", {value, se}}}, probability, {}};
}

Diagnosis missing(std::vector<FoundEffect> effects, Finding finding = Finding::kMissingEffect) {
  Diagnosis d;
  d.finding = finding;
  d.effects = std::move(effects);
  return d;
}

Config repaired(const Diagnosis& d, const std::string& mill = kMill) {
  return parse_config(repaired_mill(mill, "mill.toml", d), "model.toml");
}

Diagnosis with_everything() {
  Diagnosis d = missing({effect("rolling_resistance", NameKind::kPhysics, "coefficient", 0.0213, 0.0031)});
  d.ranking = {{"rolling_resistance", NameKind::kPhysics, 0.98, {"coefficient", "", {0.0213, 0.0031}}, 1.1, ""},
               {"none", NameKind::kNone, 1e-9, {}, 5.2, "spin, at 0.9"}};
  d.where = {{"J35-70", "spin", "at 225 deg, 0.80 R", 7.1, 0.4}};
  d.gaps = {{"J35-70", false, 3, 1, 2, {9, 0.1}, {8, 0.1}, {9.1, 0.1}},
            {"J35-90", false, 4, 1, 2, {}, {}, {}},
            {"J25-70", true, 5, 1.2, 4, {}, {}, {}}};
  d.runner_up = "fluid_drag";
  d.next = {{{{"mill.speed", 0.9}, {"charge.count", 169}}, "film it", {"a", "b"}, 4.2, 1}};
  d.checks = {{"J35-70", "free fall", "m/s2", 9.81, kNotGiven, 0.05, kNotGiven, "fits"}};
  d.simulations = 212;
  d.seconds = 480.5;
  return d;
}

TEST(TabulatedMill, HasTheTablesAndTheRefittedKeysAndAllElseAsItWas) {
  Diagnosis d = missing({}, Finding::kUnknownEffect);
  d.keys = {{"contact.friction", 0.2, 0.05, {0.231, 0.01}}};
  const std::string text =
      tabulated_mill(kMill, "mill.toml", d,
                     {"effects.tabulated_drag.speed=[0, 1, 2]", "effects.tabulated_drag.coefficient=[0.01, 0.02, 0.03]",
                      "effects.fluid_drag.viscosity=0"});
  EXPECT_THAT(text, HasSubstr("# Ours, in the hall.\n"));
  const Config c = parse_config(text, "model_tabulated.toml");
  EXPECT_EQ(c.contact.friction, 0.231);
  EXPECT_EQ(c.effects.at("tabulated_drag").at("coefficient"), (std::vector<double>{0.01, 0.02, 0.03}));
  EXPECT_EQ(repaired_mill(kMill, "mill.toml", d), kMill) << "the verdict stays unknown_effect";
}

TEST(DiagnosisJson, HasTheMembersOthersRelyOn) {
  const Json j = Json::parse(diagnosis_json(with_everything()));
  EXPECT_EQ(j["verdict"], "missing_effect");
  ASSERT_EQ(j["effects"].size(), 1u);
  EXPECT_EQ(j["effects"][0]["name"], "rolling_resistance");
  EXPECT_EQ(j["effects"][0]["parameters"]["coefficient"]["value"], 0.0213);
  EXPECT_EQ(j["effects"][0]["parameters"]["coefficient"]["se"], 0.0031);
  EXPECT_EQ(j["effects"][0]["probability"], 0.98);
  ASSERT_EQ(j["ranking"].size(), 2u);
  EXPECT_EQ(j["ranking"][1]["name"], "none");
  EXPECT_EQ(j["ranking"][1]["kind"], "none");
  EXPECT_EQ(j["ranking"][1]["probability"], 1e-9) << "small is not nothing";
  EXPECT_EQ(j["where"][0]["experiment"], "J35-70");
  EXPECT_EQ(j["where"][0]["observable"], "spin");
  EXPECT_EQ(j["where"][0]["region"], "at 225 deg, 0.80 R");
  EXPECT_EQ(j["where"][0]["z"], 7.1);
  EXPECT_NEAR(j["gap"]["before"]["fit"].get<double>(), std::sqrt((9. + 16) / 2), 1e-3);
  EXPECT_EQ(j["gap"]["before"]["hold_out"], 5);
  EXPECT_EQ(j["gap"]["after"]["fit"], 1);
  EXPECT_EQ(j["gap"]["after"]["hold_out"], 1.2);
  EXPECT_EQ(j["next_experiment"]["set"]["mill.speed"], 0.9);
  EXPECT_TRUE(j["next_experiment"]["set"]["charge.count"].is_number_integer());
  EXPECT_EQ(j["next_experiment"]["separates"], Json({"a", "b"}));
  EXPECT_EQ(j["next_experiment"]["expected_log_evidence"], 4.2);
  EXPECT_EQ(j["simulations"], 212);
  EXPECT_EQ(j["seconds"], 480.5);
}

TEST(DiagnosisJson, WhatIsNotKnownIsNull) {
  Diagnosis d;
  const Json none = Json::parse(diagnosis_json(d));
  EXPECT_EQ(none["verdict"], "agreement");
  EXPECT_TRUE(none["next_experiment"].is_null());
  EXPECT_TRUE(none["gap"]["after"]["hold_out"].is_null());
  EXPECT_EQ(none["effects"], Json::array());
  EXPECT_EQ(none["ranking"], Json::array());
  EXPECT_EQ(none["where"], Json::array());
  EXPECT_TRUE(Json::parse(diagnosis_json(with_everything()))["checks"][0]["expected"].is_null());
}

TEST(DiagnosisWords, EverySuspectHasSome) {
  for (const Effect& e : all_effects()) {
    if (std::string(e.name).starts_with("tabulated_")) continue;  // measured laws, no suspects
    EXPECT_THAT(statement_of_suspect(e.name, 1), Not(HasSubstr("The model lacks"))) << e.name;
  }
  EXPECT_NE(statement_of_suspect("camera_scale", 1), statement_of_suspect("camera_scale", -1));
}

TEST(DiagnosisWords, TheSentenceHasTheNumbers) {
  const std::string text = diagnosis_sentence(with_everything());
  for (const char* part : {"The balls roll less freely", "coefficient 0.0213\u00a0±\u00a00.0031", "probability 0.98",
                           "falls from 3.5 to 1.0", "falls from 5.0 to 1.2"})
    EXPECT_THAT(text, HasSubstr(part));
}

// --- model.toml

TEST(RepairedMill, AddsAnEffectAndLeavesTheRestAsItWas) {
  const std::string text = repaired_mill(
      kMill, "mill.toml", missing({effect("rolling_resistance", NameKind::kPhysics, "coefficient", 0.02134, 0.0031)}));
  EXPECT_THAT(text, testing::StartsWith(kMill));
  EXPECT_THAT(
      text,
      HasSubstr(
          "\n[effects.rolling_resistance]\ncoefficient = 0.0213  # rolling resistance, ± 0.0031, probability 0.98\n"));
  EXPECT_EQ(effect_value(parse_config(text, "m"), "rolling_resistance", "coefficient"), 0.0213);
}

TEST(RepairedMill, ChangesWhatIsThereInItsPlace) {
  const std::string text =
      repaired_mill(kMill, "mill.toml", missing({effect("fluid_drag", NameKind::kPhysics, "viscosity", 0.09, 0.01)}));
  EXPECT_THAT(text, HasSubstr("# was 0; drag of a fluid, ± 0.01, probability 0.98\n"));
  EXPECT_THAT(text, HasSubstr("viscosity = 0.09              # dry\n")) << "the author's remark stays";
  EXPECT_EQ(effect_value(parse_config(text, "m"), "fluid_drag", "viscosity"), 0.09);
}

TEST(RepairedMill, WhatWasToldOfTheMillIsCorrected) {
  const Config speed = repaired(missing({effect("speed_error", NameKind::kArtefact, "relative", 0.03, 0.001)}));
  EXPECT_DOUBLE_EQ(speed.mill.speed, 0.721);
  EXPECT_DOUBLE_EQ(speed.measurement.speed_error, 0.03);
  const Config filling = repaired(missing({effect("filling_error", NameKind::kArtefact, "relative", -0.0496, 0.004)}));
  EXPECT_EQ(filling.charge.count, 95);
  EXPECT_DOUBLE_EQ(filling.measurement.filling_error, -0.0496);
  EXPECT_EQ(filling.mill.speed, 0.7);
}

TEST(RepairedMill, ErrorsOfMeasuringAreOnTopOfThoseKnown) {
  const std::string known = kMill + "[measurement]\ncamera_scale = 0.01\ncamera_rotation_deg = 1\n";
  const Config twice =
      repaired(missing({effect("camera_scale", NameKind::kArtefact, "relative", 0.02, 0.0001)}), known);
  EXPECT_DOUBLE_EQ(twice.measurement.camera_scale, 0.0302);
  const Config turned =
      repaired(missing({effect("camera_rotation", NameKind::kArtefact, "angle_deg", -0.5, 0.01)}), known);
  EXPECT_DOUBLE_EQ(turned.measurement.camera_rotation_deg, 0.5);
  EXPECT_DOUBLE_EQ(
      repaired(missing({effect("frame_clock", NameKind::kArtefact, "relative", 0.02, 0.0001)})).measurement.frame_clock,
      0.02);
  Diagnosis torque = missing({effect("torque_offset", NameKind::kArtefact, "relative", 0.04, 0.01)});
  torque.gaps = {{"a", false, 3, 1, 1, {9, 0.1}, {}, {}},
                 {"b", false, 3, 1, 1, {11, 0.1}, {}, {}},
                 {"c", true, 3, 1, 1, {99, 1}, {}, {}}};
  EXPECT_DOUBLE_EQ(repaired(torque).measurement.torque_offset_N_m, 0.4);
}

TEST(RepairedMill, SingleLiftersAndRefittedKeysComeWithIt) {
  Diagnosis d = missing(
      {effect("lifter_wear", NameKind::kPhysics, "height_loss", 0.42, 0.02),
       {"missing_lifters", NameKind::kPhysics, {{"count", "", {1, 0}}}, 0.9, {"effects.missing_lifters.lifters=[7]"}}});
  d.effects[0].sets = {"effects.lifter_wear.height_loss=0.41999", "effects.lifter_wear.lifters=[4]"};
  d.keys = {{"contact.friction", 0.2, 0.03, {0.2312, 0.011}}, {"contact.wall.restitution", 0.4, 0.05, {0.38, 0.02}}};
  const Config c = repaired(d);
  EXPECT_EQ(effect_value(c, "lifter_wear", "height_loss"), 0.42);
  EXPECT_EQ(effect_list(c, "lifter_wear", "lifters"), std::vector<int>{4});
  EXPECT_EQ(effect_list(c, "missing_lifters", "lifters"), std::vector<int>{7});
  EXPECT_EQ(c.contact.friction, 0.231);
  EXPECT_EQ(c.contact.wall.restitution, 0.38);
}

TEST(RepairedMill, AddsNothingWhereNothingWasFound) {
  for (const Finding finding : {Finding::kAgreement, Finding::kUnknownEffect}) {
    Diagnosis d = missing({effect("cohesion", NameKind::kPhysics, "force", 0.3, 0.1, 0.4)}, finding);
    d.keys = {{"contact.friction", 0.2, 0.03, {0.23, 0.01}}};
    EXPECT_EQ(repaired_mill(kMill, "mill.toml", d), kMill);
  }
}

TEST(RepairedMill, OfRivalsTheLikeliestIsAddedAndTheOthersNamed) {
  const std::string text =
      repaired_mill(kMill, "mill.toml",
                    missing({effect("cohesion", NameKind::kPhysics, "force", 0.3, 0.1, 0.4),
                             effect("rolling_resistance", NameKind::kPhysics, "coefficient", 0.02, 0.001, 0.55)},
                            Finding::kAmbiguous));
  const Config c = parse_config(text, "m");
  EXPECT_TRUE(has_effect(c, "rolling_resistance"));
  EXPECT_FALSE(has_effect(c, "cohesion"));
  EXPECT_THAT(text, HasSubstr("# cohesion (probability 0.40) explains the data about as well; in its place: --set "
                              "effects.cohesion.force=0.3\n"));
}

TEST(RepairedMill, ReadsTheSameHoweverTheFileIsWritten) {
  const Diagnosis d = missing({effect("fluid_drag", NameKind::kPhysics, "viscosity", 0.09, 0.01),
                               effect("speed_error", NameKind::kArtefact, "relative", 0.03, 0.001)});
  std::string windows;
  for (const char c : kMill) windows += c == '\n' ? "\r\n" : std::string(1, c);
  const std::string rest =
      "lifters.count = 0\nlifters.profile = \"none\"\n[charge]\ncount = 100\nballs = [ { radius = 0.012, mass = 0.060 "
      "} ]\n";
  for (const std::string& mill : std::vector<std::string>{
           windows,
           "mill = { diameter = 0.5, speed = 0.7 }\n[charge]\ncount = 100\nballs = [ { radius = 0.012, mass = 0.060 } "
           "]\n",
           "[mill]\ndiameter = 0.5\nspeed = 0.7\n" + rest + "[effects]\nfluid_drag.density = 1",
           "effects.cohesion = { force = 1 }\n[mill]\ndiameter = 0.5 # “\"é”\nspeed = 0.7\n" + rest}) {
    const Config c = repaired(d, mill);
    EXPECT_DOUBLE_EQ(c.mill.speed, 0.721) << mill;
    EXPECT_EQ(effect_value(c, "fluid_drag", "viscosity"), 0.09) << mill;
    EXPECT_EQ(c.charge.count, 100) << mill;
  }
  Diagnosis filling = missing({effect("speed_error", NameKind::kArtefact, "relative", 0.03, 0.001)});
  filling.keys = {{"charge.filling", 0.24, 0.01, {0.25, 0.01}}};  // the file has a count
  const Config c = repaired(filling);
  EXPECT_EQ(c.charge.filling, 0.25);
  EXPECT_FALSE(c.charge.count);
}

TEST(Measurement, WhatExperimentsSetIsPutRight) {
  const Config mill = parse_config(kMill + "[measurement]\nspeed_error = 0.1\nfilling_error = -0.05\n", "mill.toml");
  EXPECT_EQ(mill.mill.speed, 0.7) << "MILL.toml's own value is put right where it stands";
  Experiment e;
  EXPECT_EQ(config_of(mill, e).mill.speed, 0.7);
  e.sets = {{"mill.speed", "0.5"}, {"charge.count", "200"}};
  EXPECT_DOUBLE_EQ(config_of(mill, e).mill.speed, 0.55);
  EXPECT_EQ(config_of(mill, e).charge.count, 190);
  EXPECT_EQ(config_of(mill, e, {"mill.speed=0.6"}).mill.speed, 0.6) << "what is tried is true";
}

}  // namespace
}  // namespace tumble::io
