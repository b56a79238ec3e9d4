#include "analysis/shrink.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>

namespace tumble::analysis {
namespace {

TEST(Shrink, IsTheMeanOfWhatAPixelCovers) {
  cv::Mat picture(61, 47, CV_8UC3), known;
  cv::RNG(7).fill(picture, cv::RNG::UNIFORM, 0, 256);
  for (const cv::Size size : {cv::Size(29, 38), cv::Size(16, 16), picture.size()}) {
    cv::resize(picture, known, size, 0, 0, cv::INTER_AREA);
    EXPECT_LE(cv::norm(shrink(picture, size), known, cv::NORM_INF), 1) << size;
  }
}

}  // namespace
}  // namespace tumble::analysis
