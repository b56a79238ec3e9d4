#include "analysis/circles.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

#include "tests/analysis/painted_mill.h"

namespace tumble::analysis {
namespace {

TEST(Circles, FitPassesThroughPointsOfAnArc) {
  std::vector<cv::Point2d> points;
  for (int k = 0; k < 40; ++k)
    points.push_back({320.25 + 150.5 * std::cos(0.03 * k), 200.75 + 150.5 * std::sin(0.03 * k)});
  const Circle c = fit_circle(points, std::vector<double>(points.size(), 1.0));
  EXPECT_NEAR(c.u, 320.25, 1e-6);
  EXPECT_NEAR(c.v, 200.75, 1e-6);
  EXPECT_NEAR(c.radius, 150.5, 1e-6);
}

TEST(Circles, FindTheShellOfAMillSubPixel) {
  PaintedMill mill;
  mill.angle = 0.1;
  cv::Mat grey;
  cv::cvtColor(paint(mill, packed_bed(mill, 8.0, 35, 1), 2), grey, cv::COLOR_BGR2GRAY);
  const auto rings = find_concentric_circles(grey, 50);
  ASSERT_FALSE(rings.empty());
  double nearest = 1e9, miss = 1e9;
  for (const RingEdge& r : rings)
    if (std::abs(r.circle.radius - mill.radius) < nearest) {
      nearest = std::abs(r.circle.radius - mill.radius);
      miss = std::hypot(r.circle.u - mill.u, r.circle.v - mill.v);
    }
  EXPECT_LT(nearest, 0.3);
  EXPECT_LT(miss, 0.5);
}

TEST(Circles, AreNotFoundInNoise) {
  cv::Mat grey(360, 480, CV_8U);
  Random random(4);
  for (int v = 0; v < grey.rows; ++v)
    for (int u = 0; u < grey.cols; ++u) grey.at<uchar>(v, u) = static_cast<uchar>(100 + random.below(40));
  for (const RingEdge& r : find_concentric_circles(grey, 50)) EXPECT_LT(r.coverage, 0.55);
}

}  // namespace
}  // namespace tumble::analysis
