#include "analysis/ball_rim.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "core/units.h"

namespace tumble::analysis {
namespace {

// A disc that fades towards its lower side, inside a dark line, on a ground of its own: drawn finely, then averaged.
cv::Mat paint_disc(double u, double v, double radius, double line) {
  constexpr int kFine = 8;
  cv::Mat grey(60, 60, CV_32F);
  for (int i = 0; i < grey.rows; ++i)
    for (int j = 0; j < grey.cols; ++j) {
      double sum = 0;
      for (int a = 0; a < kFine; ++a)
        for (int b = 0; b < kFine; ++b) {
          const double x = j + (b + 0.5) / kFine - 0.5 - u, y = i + (a + 0.5) / kFine - 0.5 - v, d = std::hypot(x, y);
          sum += d > radius ? 70 : d > radius - line ? 15 : 150 - 60 * y / radius;
        }
      grey.at<float>(i, j) = static_cast<float>(sum / (kFine * kFine));
    }
  return grey;
}

TEST(BallRim, FindsTheCentreOfAShadedDiscFromAPixelAway) {
  for (const cv::Point2d& true_centre : {cv::Point2d(30.2, 29.7), cv::Point2d(29.51, 30.44)}) {
    const cv::Mat grey = paint_disc(true_centre.x, true_centre.y, 14, 1.4);
    const RimFit fit = fit_rim(grey, true_centre + cv::Point2d(0.8, -0.7), 12.6);
    EXPECT_NEAR(fit.u, true_centre.x, 0.08);
    EXPECT_NEAR(fit.v, true_centre.y, 0.08);  // shading pulls a little
    EXPECT_GT(fit.share, 0.9);
  }
}

TEST(BallRim, LearnsWhereTheEdgeOfTheOutlineIs) {
  std::vector<cv::Mat> greys;
  std::vector<std::vector<cv::Point2d>> centres;
  for (int i = 0; i < 14; ++i) {
    greys.push_back(paint_disc(30 + 0.07 * i, 30 - 0.05 * i, 14, 1.4));
    centres.push_back({{30.4, 29.8}});
  }
  EXPECT_NEAR(learn_rim(greys, centres, 13.5), 12.6, 0.15);
}

TEST(BallRim, LearnsNothingFromABlurOfNoise) {
  Random random(3);
  cv::Mat noise(60, 60, CV_32F);
  for (int i = 0; i < noise.rows; ++i)
    for (int j = 0; j < noise.cols; ++j) noise.at<float>(i, j) = static_cast<float>(255 * random.uniform());
  const std::vector<cv::Mat> greys(14, noise);
  EXPECT_TRUE(std::isnan(learn_rim(greys, std::vector<std::vector<cv::Point2d>>(14, {{30, 30}}), 14)));
}

}  // namespace
}  // namespace tumble::analysis
