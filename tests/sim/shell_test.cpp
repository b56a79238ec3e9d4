#include "sim/shell.h"

#include <gtest/gtest.h>

#include "core/random.h"
#include "core/units.h"
#include "tests/support/mills.h"

namespace tumble::sim {
namespace {

// Distance to the nearest of many points on the lifter's edge: a different way to the same number.
double sampled_distance(const MillShape& shape, double x, double y) {
  double nearest = INFINITY;
  for (std::size_t i = 0; i < shape.lifter.size(); ++i) {
    const Eigen::Vector2d a = shape.lifter[i], b = shape.lifter[(i + 1) % shape.lifter.size()];
    for (int k = 0; k <= 2000; ++k)
      nearest = std::min(nearest, (a + (b - a) * k / 2000.0 - Eigen::Vector2d(x, y)).norm());
  }
  return nearest;
}

TEST(Shell, NearestPointOfALifter) {
  for (const LifterProfile profile : {LifterProfile::kRectangle, LifterProfile::kTriangle}) {
    Config config = paper_mill();
    config.mill.lifters.profile = profile;
    const MillShape shape = make_mill_shape(config.mill);
    const Shell shell = make_shell(shape);
    Random random(1);
    for (int k = 0; k < 200; ++k) {
      const double x = random.uniform(0.2, 0.26), y = random.uniform(-0.05, 0.05);
      const Nearest n = nearest_on_lifter(shell, x, y);
      EXPECT_NEAR(n.nx * n.nx + n.ny * n.ny, 1, 1e-12);
      if (n.distance > 0) {
        EXPECT_NEAR(n.distance, sampled_distance(shape, x, y), 1e-5);
        EXPECT_LT(sampled_distance(shape, x + n.distance * n.nx, y + n.distance * n.ny), 2e-5) << "points at the edge";
      } else {
        EXPECT_LT(nearest_on_lifter(shell, x - 1e-3 * n.nx, y - 1e-3 * n.ny).distance, n.distance + 1.001e-3);
        EXPECT_GT(nearest_on_lifter(shell, x - 1e-3 * n.nx, y - 1e-3 * n.ny).distance, n.distance) << "points out";
      }
    }
  }
}

// Looking up by angle finds what looking at all lifters finds, for any mill angle and ball size.
TEST(Shell, FeaturesNearABall) {
  Config config = paper_mill();
  for (const int lifters : {1, 2, 18, 60}) {
    config.mill.lifters.count = lifters;
    config.mill.lifters.width = lifters == 60 ? 0.005 : 0.02;
    const Shell shell = make_shell(make_mill_shape(config.mill));
    Random random(7);
    for (int k = 0; k < 500; ++k) {
      const double angle = random.uniform(0, 1000), direction = random.uniform(0, 2 * kPi);
      const double rho = random.uniform(0, 0.26), reach = random.uniform(0.005, 0.12);
      const double x = rho * std::cos(direction), y = rho * std::sin(direction);
      std::vector<int> expected, found;
      if (rho + reach > shell.radius) expected.push_back(0);
      for (int l = 0; l < lifters; ++l) {
        const Direction d = lifter_direction(shell, pose_of(angle), l);
        if (nearest_on_lifter(shell, x * d.cos + y * d.sin, y * d.cos - x * d.sin).distance < reach)
          expected.push_back(l + 1);
      }
      features_near(shell, angle, x, y, reach, found);
      EXPECT_EQ(found, expected);
    }
  }
}

}  // namespace
}  // namespace tumble::sim
