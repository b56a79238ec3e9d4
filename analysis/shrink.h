#pragma once
#include <opencv2/core.hpp>

namespace tumble::analysis {

// A picture (8-bit BGR) made smaller along both sides: every pixel is the mean of what it covers, as by cv::resize with
// INTER_AREA, whose loops are not vectorised for ratios that are no whole numbers: a third of its time.
cv::Mat shrink(const cv::Mat& bgr, cv::Size size);

}  // namespace tumble::analysis
