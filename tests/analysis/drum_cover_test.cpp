#include "analysis/drum_cover.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::analysis {
namespace {

// A bar before the charge, with a sharp outline; the film's compression smears what moves beside it into the bar, and
// leaves the ground without any noise.
TEST(DrumCover, ABarIsFoundWhereCompressionSmearsTheChargeIntoIt) {
  constexpr double kShell = 140, kTip = 130;
  const cv::Size size(400, 320);
  const DrumPose pose = frontal_pose(size, {200, 160});
  cv::Mat mean(size, CV_32F), deviation(size, CV_32F);
  for (int v = 0; v < size.height; ++v)
    for (int u = 0; u < size.width; ++u) {
      const double r = std::hypot(u - 200, v - 160);
      const bool bar = std::abs(u - 200) < 10, inside = r < kShell;
      mean.at<float>(v, u) = bar ? 120.0F : inside ? 70.0F : 90.0F;
      deviation.at<float>(v, u) = !inside ? 0.0F : bar ? 1.8F : 40.0F;
    }
  const cv::Mat hidden = hidden_part(mean, deviation, pose, kTip, kShell);
  for (const int v : {60, 160, 260}) {
    EXPECT_EQ(hidden.at<uchar>(v, 200), 255) << v;
    EXPECT_EQ(hidden.at<uchar>(v, 230), 0) << v;
  }
}

}  // namespace
}  // namespace tumble::analysis
