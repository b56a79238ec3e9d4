#include "core/mill_shape.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "tests/support/mills.h"

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

TEST(MillShape, TriangleIsSlantedInTheDirectionOfRotation) {
  const MillShape shape = make_mill_shape(mill_with(LifterProfile::kTriangle));
  ASSERT_EQ(shape.lifter.size(), 3u);
  EXPECT_NEAR(shape.lifter[2].y(), -0.01, 1e-12);  // apex over the trailing edge: the trailing face is radial
  EXPECT_NEAR(shape.lifter[2].x(), shape.tip_radius, 1e-12);
}

TEST(MillShape, TrapezoidFacesHaveTheirAngles) {
  Mill mill = mill_with(LifterProfile::kTrapezoid);
  mill.lifters.width = 0.04;
  mill.lifters.leading_angle_deg = 30;
  mill.lifters.trailing_angle_deg = 10;
  const MillShape shape = make_mill_shape(mill);
  ASSERT_EQ(shape.lifter.size(), 4u);
  const Eigen::Vector2d leading = shape.lifter[1] - shape.lifter[2], trailing = shape.lifter[0] - shape.lifter[3];
  EXPECT_NEAR(degrees(std::atan2(leading.y(), leading.x())), 30, 1e-9);
  EXPECT_NEAR(degrees(std::atan2(-trailing.y(), trailing.x())), 10, 1e-9);
  EXPECT_NEAR(shape.lifter[2].y(), 0.02 - 0.02 * std::tan(radians(30)), 1e-12);
}

TEST(MillShape, LifterIsConvexAndCounterClockwise) {
  for (const auto profile : {LifterProfile::kRectangle, LifterProfile::kTriangle}) {
    const auto p = make_mill_shape(mill_with(profile)).lifter;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Eigen::Vector2d a = p[(i + 1) % p.size()] - p[i], b = p[(i + 2) % p.size()] - p[(i + 1) % p.size()];
      EXPECT_GT(a.x() * b.y() - a.y() * b.x(), 0);
    }
  }
}

}  // namespace
}  // namespace tumble
