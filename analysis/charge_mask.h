#pragma once
#include <opencv2/core.hpp>
#include <vector>

#include "analysis/ball_detector.h"
#include "analysis/ring_occupancy.h"

namespace tumble::analysis {

// Which pixels show charge, for pictures in which not every ball can be found: what colours the balls have that were
// found, against what the rest of the mill looks like.

// Shares of charge (0 to 1, CV_32F, one per picture) within the mill. Learned from all pictures together.
std::vector<cv::Mat> charge_shares(const std::vector<cv::Mat>& pictures,
                                   const std::vector<std::vector<Detection>>& balls, const Circle& mill);

// Areal occupancy of a ring (radii in pixels) by the pixels that show charge; angles counter-clockwise as seen,
// mirrored (x -> -x) where asked.
RingProfile mask_occupancy(const cv::Mat& share, const Circle& mill, const Ring& ring, bool mirror);

}  // namespace tumble::analysis
