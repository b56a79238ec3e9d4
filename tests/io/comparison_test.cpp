#include "io/comparison_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"

namespace tumble::io {
namespace {

using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

constexpr int kCells = 4;

// A comparison of two small motions: two quantities, one field of 4 x 4 cells of which one is beyond chance, one line.
struct Story {
  ChargeMotion a, b;
  Deviation deviation;
  Comparison comparison;

  Story() {
    for (ChargeMotion* m : {&a, &b}) {
      m->mill_radius = 0.25;
      m->tip_radius = 0.23;
      m->frames = 100;
      m->field.n = kCells;
      m->field.cell = 0.125;
      m->field.occupancy.assign(kCells * kCells, 0.5);
      m->surface = {{-0.1, 0, 0.01}, {0.1, 0.05, 0.01}};
    }
    a.origin = "folder/<script>alert(1)</script>.h5";
    b.origin = "folder/film & run.mp4";
    b.source = MotionSource::kFilm;
    a.toe_deg = {225, 1};
    b.toe_deg = {231, 1};
    deviation.differences = {{.name = "toe_deg",
                              .unit = "deg",
                              .a = a.toe_deg,
                              .b = b.toe_deg,
                              .difference = 6,
                              .se = 1.4,
                              .z = 4.3,
                              .chance = 1e-4,
                              .significant = true},
                             {.name = "torque_N_m", .unit = "N m", .a = {9.5, 0.2}, .note = "only A has it"}};
    SampledDifference field{.name = "occupancy", .n = kCells, .cell = 0.5};
    field.a = field.b = field.a_se = field.b_se = field.difference = field.se = field.z =
        std::vector<double>(kCells * kCells, 0.25);
    field.z[3] = kNotGiven;
    field.significant.assign(kCells * kCells, 0);
    field.significant[6] = 1;
    field.compared = 15;
    field.beyond_chance = 1;
    field.where = "at the toe";
    SampledDifference ring{.name = "ring_occupancy", .x_name = "angle", .x_unit = "deg", .x = {0.5, 1.5}};
    ring.a = ring.b = ring.a_se = ring.b_se = ring.difference = ring.se = ring.z = {0.1, 0.2};
    ring.significant = {0, 1};
    deviation.fields = {field};
    deviation.lines = {ring};
    deviation.chi = 1.7;
    deviation.chi_limit = 1.3;
    deviation.verdict = Verdict::kDiffer;
    deviation.sentence = "They differ. B against A: toe +6.0° (4.3 sigma).";
    comparison.deviation = &deviation;
    for (auto [side, motion] : {std::pair{&comparison.a, &a}, {&comparison.b, &b}}) {
      side->motion = motion;
      side->shape.radius = motion->mill_radius;
      side->shape.tip_radius = motion->tip_radius;
      side->paths = {{.ball = 3, .share = 0.5, .time = {0, 0.01}, .x = {0.1, 0.1}, .y = {0, 0.01}}};
    }
    comparison.version = "0.0";
  }
};

Json data_of(const std::string& page) {
  const std::string open = "<script type=\"application/json\" id=\"data\">";
  const std::size_t from = page.find(open) + open.size();
  return Json::parse(page.substr(from, page.find("</script>", from) - from));
}

TEST(ComparisonPage, HoldsTheMapTheDialAndThePathsInUnitsOfTheMillsRadius) {
  const Story story;
  const Json data = data_of(comparison_page(story.comparison));
  const Json& map = data["map"]["fields"]["occupancy"];
  EXPECT_EQ(data["map"]["n"], kCells);
  EXPECT_EQ(map["named"][6], 1);
  EXPECT_TRUE(map["z"][3].is_null()) << "what was not compared is not zero";
  EXPECT_EQ(data["sides"][1]["toe"][0], 231);
  EXPECT_TRUE(data["sides"][0]["shoulder"][0].is_null());
  EXPECT_NEAR(data["sides"][0]["surface"][1][0].get<double>(), 0.4, 1e-9);
  EXPECT_NEAR(data["sides"][0]["paths"][0]["points"][0][0].get<double>(), 0.4, 1e-9);
  EXPECT_NEAR(data["tip"].get<double>(), 0.92, 1e-9);
}

TEST(ComparisonPage, NamesOfFilesAreTextAndWhatOnlyOneHasIsListed) {
  const Story story;
  const std::string page = comparison_page(story.comparison);
  EXPECT_THAT(page, Not(HasSubstr("<script>alert")));
  EXPECT_THAT(page, HasSubstr("film &amp; run.mp4"));
  EXPECT_THAT(page, HasSubstr("only A has it"));
  EXPECT_THAT(page, HasSubstr("class=\"far\"><th scope=\"row\">Toe<"));
  EXPECT_THAT(page, Not(HasSubstr("<video"))) << "without films there is no player";
}

TEST(ComparisonPage, AMillOfUnknownSizeHasAPageToo) {
  Story story;
  for (ComparedSource* side : {&story.comparison.a, &story.comparison.b}) {
    side->shape = {};
    side->paths.clear();
  }
  story.a.mill_radius = story.b.mill_radius = story.a.tip_radius = kNotGiven;
  story.deviation.fields.clear();
  const Json data = data_of(comparison_page(story.comparison));
  EXPECT_EQ(data["tip"], 1);
  EXPECT_TRUE(data["sides"][0]["surface"].empty());
}

TEST(ComparisonPage, AFilmThatIsNotThereIsAnError) {
  Story story;
  story.comparison.a.film.file = "no/such/film.mp4";
  EXPECT_THROW(comparison_page(story.comparison), WorkError);
}

TEST(DeviationJson, HasEveryDifferenceWithItsErrorAndZ) {
  const Story story;
  const Json json = Json::parse(deviation_json(story.comparison));
  EXPECT_EQ(json["verdict"], "differ");
  EXPECT_EQ(json["number"]["value"], 1.7);
  EXPECT_EQ(json["quantities"][0]["z"], 4.3);
  EXPECT_TRUE(json["quantities"][1]["difference"].is_null());
  EXPECT_EQ(json["quantities"][1]["note"], "only A has it");
  EXPECT_EQ(json["fields"][0]["z"].size(), 16u);
  EXPECT_TRUE(json["fields"][0]["z"][3].is_null());
  EXPECT_EQ(json["fields"][0]["beyond_chance_at"], Json({6}));
  EXPECT_EQ(json["lines"][0]["x"], Json({0.5, 1.5}));
  const Json summary = Json::parse(deviation_summary(story.comparison));
  EXPECT_EQ(summary["quantities"], json["quantities"]);
  EXPECT_FALSE(summary["fields"][0].contains("z"));
}

}  // namespace
}  // namespace tumble::io
