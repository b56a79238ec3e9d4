#include "core/mill_shape.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/angle.h"
#include "core/error.h"
#include "tests/support/shells.h"

namespace tumble {
namespace {

double area(const std::vector<Eigen::Vector2d>& p) {
  double twice = 0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    const auto& a = p[i];
    const auto& b = p[(i + 1) % p.size()];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

Mill mill_with(LifterProfile profile) {
  Mill mill = paper_mill().mill;
  mill.lifters.profile = profile;
  return mill;
}

double area_of(const Config& config) { return area(outline(make_mill_shape(config), 1e-4)); }

TEST(MillShape, SmoothShellIsACircle) {
  const MillShape shape = make_mill_shape(mill_with(LifterProfile::kNone));
  EXPECT_EQ(shape.lifter_count, 0);
  EXPECT_EQ(shape.tip_radius, 0.2725);
  EXPECT_NEAR(area(outline(shape, 1e-3)), kPi * 0.2725 * 0.2725, 1e-5);
}

// The outline leaves out just what the lifters take: width x mean height above the round shell.
TEST(MillShape, LiftersTakeTheirCrossSection) {
  const double shell = kPi * 0.2725 * 0.2725;
  const double sagitta_area = 0.02 * 0.02 * 0.02 / (12 * 0.2725);  // between the foot's chord and the arc
  const double rectangle = (shell - area(outline(make_mill_shape(mill_with(LifterProfile::kRectangle)), 1e-4))) / 18;
  EXPECT_NEAR(rectangle, 0.02 * 0.02 - sagitta_area / 2, 1e-7);
  const double triangle = (shell - area(outline(make_mill_shape(mill_with(LifterProfile::kTriangle)), 1e-4))) / 18;
  EXPECT_NEAR(triangle, 0.02 * 0.02 / 2, 6e-6);
}

TEST(MillShape, WaveHasItsArea) {
  Config config = mill_with_profile(LifterProfile::kWave);
  for (const int count : {1, 2, 7, 18}) {
    config.mill.lifters.count = count;
    config.mill.lifters.height = 0.04;
    const double mean = 0.2725 - 0.02;  // r = R - h/2 (1 + cos(n theta)): mean of r^2 is mean^2 + h^2 / 8
    EXPECT_NEAR(area_of(config), kPi * (mean * mean + 0.04 * 0.04 / 8), 3e-6) << count;
    EXPECT_NEAR(make_mill_shape(config).tip_radius, 0.2725 - 0.04, 3e-6) << "chords have their sagitta";
  }
}

// A tilted bar keeps its area: what dips into the shell on one side comes out on the other.
TEST(MillShape, SwivelTilts) {
  Config config = mill_with_profile(LifterProfile::kSwivel);
  config.mill.lifters.width = 0.01;
  config.mill.lifters.height = 0.03;
  for (const double tilt : {-45.0, 0.0, 45.0}) {
    config.mill.lifters.swivel_angle_deg = tilt;
    const double bar = (kPi * 0.2725 * 0.2725 - area_of(config)) / 18;
    EXPECT_NEAR(bar, 0.01 * 0.03, 3e-6) << tilt;
    const auto chain = make_mill_shape(config).sections[0].chain;
    const Eigen::Vector2d top = (chain[1] + chain[2]) / 2;
    EXPECT_NEAR(degrees(std::atan2(-top.y(), 0.2725 - top.x())), tilt, 1e-9) << "> 0 leans back";
    EXPECT_NEAR((top - Eigen::Vector2d(0.2725, 0)).norm(), 0.03, 1e-12);
  }
}

TEST(MillShape, PolygonIsAsDrawn) {
  const Config config =
      mill_with_points({{0, -0.01}, {0.03, -0.01}, {0.03, 0.02}, {0.02, 0.02}, {0.02, 0.005}, {0, 0.005}});
  const double drawn = 0.03 * 0.015 + 0.01 * 0.015;
  EXPECT_NEAR((kPi * 0.2725 * 0.2725 - area_of(config)) / 18, drawn, 1e-6);
  EXPECT_NEAR(make_mill_shape(config).tip_radius, 0.2425, 1e-12);
}

TEST(MillShape, WearTakesHeightAndEdges) {
  const double sagitta_area = 0.02 * 0.02 * 0.02 / (24 * 0.2725);
  const double shell = kPi * 0.2725 * 0.2725;
  Config config = mill_with_profile(LifterProfile::kRectangle);
  config.effects["lifter_wear"] = {{"height_loss", {0.25}}, {"rounding", {0.006}}};
  const double worn = 0.02 * 0.015 - 2 * (1 - kPi / 4) * 0.006 * 0.006 - sagitta_area;
  const double whole = 0.02 * 0.02 - sagitta_area;
  EXPECT_NEAR((shell - area_of(config)) / 18, worn, 1e-7);
  EXPECT_NEAR(make_mill_shape(config).tip_radius, 0.2725 - 0.015, 1e-12);

  config.effects["lifter_wear"]["lifters"] = {2, 5, 6};
  config.effects["missing_lifters"] = {{"lifters", {6, 9}}};
  EXPECT_NEAR(shell - area_of(config), 2 * worn + 14 * whole, 1e-6);
  const MillShape shape = make_mill_shape(config);
  EXPECT_NEAR(shape.tip_radius, 0.2525, 1e-12) << "of the lifters that are not worn";
  EXPECT_EQ(shape.section_of[5], 1);
  EXPECT_EQ(shape.section_of[6], -1);
  EXPECT_EQ(shape.section_of[7], 0);
  EXPECT_EQ(shape.lifter_count, 18);

  // More rounding than the edges can hold: cut to fit, half a disc on top.
  config.effects.clear();
  config.effects["lifter_wear"] = {{"rounding", {1.0}}};
  EXPECT_NEAR((shell - area_of(config)) / 18, 0.02 * 0.02 - 2 * (1 - kPi / 4) * 1e-4 - sagitta_area, 4e-7);
}

TEST(MillShape, TriangleIsSlantedInTheDirectionOfRotation) {
  const MillShape shape = make_mill_shape(mill_with(LifterProfile::kTriangle));
  const auto& chain = shape.sections.at(0).chain;
  ASSERT_EQ(chain.size(), 3u);
  EXPECT_NEAR(chain[1].y(), -0.01, 1e-12);  // apex over the trailing edge: the trailing face is radial
  EXPECT_NEAR(chain[1].x(), 0.2525, 1e-12);
}

TEST(MillShape, TrapezoidFacesHaveTheirAngles) {
  Mill mill = mill_with(LifterProfile::kTrapezoid);
  mill.lifters.width = 0.04;
  mill.lifters.leading_angle_deg = 30;
  mill.lifters.trailing_angle_deg = 10;
  const auto chain = make_mill_shape(mill).sections.at(0).chain;
  ASSERT_EQ(chain.size(), 4u);
  const Eigen::Vector2d leading = chain[3] - chain[2], trailing = chain[0] - chain[1];
  EXPECT_NEAR(degrees(std::atan2(leading.y(), leading.x())), 30, 1e-9);
  EXPECT_NEAR(degrees(std::atan2(-trailing.y(), trailing.x())), 10, 1e-9);
  EXPECT_NEAR(chain[2].y(), 0.02 - 0.02 * std::tan(radians(30)), 1e-12);
}

// Steel on the right, ends in the shell; and what the outline says of each piece.
TEST(MillShape, OutlineNamesItsPieces) {
  for (const NamedMill& mill : mills_of_every_profile()) {
    const MillShape shape = make_mill_shape(mill.config);
    const auto points = labelled_outline(shape, 1e-3);
    EXPECT_GT(area(outline(shape, 1e-3)), 0) << mill.name << ": counter-clockwise";
    std::array<int, 4> faces{};
    std::vector<bool> lifters(static_cast<std::size_t>(shape.lifter_count), false);
    for (std::size_t i = 0; i < points.size(); ++i) {
      ++faces[static_cast<std::size_t>(points[i].face)];
      if (points[i].lifter >= 0) lifters[static_cast<std::size_t>(points[i].lifter)] = true;
      EXPECT_LT(points[i].at.norm(), shape.radius * (1 + 1e-12)) << mill.name;
      EXPECT_GT(points[i].at.norm(), shape.tip_radius * (1 - 1e-12)) << mill.name;
      EXPECT_GT((points[i].at - points[(i + 1) % points.size()].at).norm(), 1e-9) << mill.name << ": given once";
    }
    for (std::size_t k = 0; k < lifters.size(); ++k)
      EXPECT_EQ(lifters[k], shape.section_of[k] >= 0) << mill.name << " lifter " << k;
    EXPECT_GT(faces[static_cast<std::size_t>(Face::kLeading)], 0) << mill.name;
    EXPECT_GT(faces[static_cast<std::size_t>(Face::kTrailing)], 0) << mill.name;
  }
}

TEST(MillShape, FlawedLiftersAreRefused) {
  const auto refuses = [](Config config, const std::string& key, const std::string& word) {
    try {
      check(config);
      ADD_FAILURE() << "accepted: " << word;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(key), std::string::npos) << e.what();
      EXPECT_NE(std::string(e.what()).find(word), std::string::npos) << e.what();
    }
  };
  const std::string points = "mill.lifters.points";
  refuses(mill_with_points({{0, -0.01}, {0.02, 0.01}, {0.02, -0.01}, {0, 0.01}}), points, "crosses itself");
  refuses(mill_with_points({{0, 0.01}, {0.02, 0.01}, {0.02, -0.01}, {0, -0.01}}), points, "leading to the trailing");
  refuses(mill_with_points({{0.01, -0.01}, {0.02, 0}, {0, 0.01}}), points, "is a foot");
  refuses(mill_with_points({{0, -0.01}, {0.02, 0}, {-0.001, 0.005}, {0, 0.01}}), points, "above the shell");
  refuses(mill_with_points({{0, -0.08}, {0.02, 0}, {0, 0.08}}), points, "overlap");
  refuses(mill_with_points({{0, -0.04}, {0.001, -0.035}, {0.02, 0}, {0, 0.01}}), points, "dips into");
  refuses(mill_with_points({{0, -0.01}, {0.3, 0}, {0, 0.01}}), points, "further off");
  refuses(mill_with_points({{0, -0.01}, {0, 0.01}}), points, "3 to 64");
  refuses(mill_with_points(std::vector<std::array<double, 2>>(65)), points, "3 to 64");

  Config c = mill_with_profile(LifterProfile::kTrapezoid);
  c.mill.lifters.leading_angle_deg = 50;
  refuses(c, "mill.lifters.width", "cross below the top");
  c = mill_with_profile(LifterProfile::kTriangle);
  c.mill.lifters.leading_angle_deg = 20;
  c.mill.lifters.trailing_angle_deg = 10;
  refuses(c, "mill.lifters.width", "the two angles make");
  c.mill.lifters.trailing_angle_deg = kNotGiven;
  c.mill.lifters.leading_angle_deg = 60;
  refuses(c, "mill.lifters.leading_angle_deg", "at most 45 degrees");
  c = mill_with_profile(LifterProfile::kRectangle);
  c.mill.lifters.count = 100;
  refuses(c, "mill.lifters.count", "overlap");
  c.mill.lifters.count = 18;
  c.mill.lifters.swivel_angle_deg = 10;
  refuses(c, "mill.lifters.swivel_angle_deg", "no meaning");
  c = mill_with_profile(LifterProfile::kSwivel);
  c.mill.lifters.swivel_angle_deg = 60;
  c.mill.lifters.width = 0.03;
  refuses(c, "mill.lifters.swivel_angle_deg", "dips into");
  c = mill_with_profile(LifterProfile::kRectangle);
  c.mill.lifters.width = 0.08;
  c.effects["lifter_wear"] = {{"height_loss", {0.9}}};
  refuses(c, "effects.lifter_wear.height_loss", "leaves nothing");
  c = paper_mill();
  c.mill.lifters.profile = LifterProfile::kNone;
  EXPECT_THROW(check_complete(c), InputError) << "sizes without a profile";
}

}  // namespace
}  // namespace tumble
