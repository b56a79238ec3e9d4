#pragma once
#include <opencv2/core.hpp>
#include <vector>

namespace tumble::analysis {

// A ball's outline as a sharp film shows it: one edge of the same radius all round every ball of a class. It then tells
// the centre more exactly than any look at the ball as a whole. In the films of real mills outlines fade into their
// neighbours, and nothing is learned.

struct RimFit {
  double u = 0, v = 0;  // centre [px]
  double share = 0;     // of the directions in which the edge lies on the circle
  double spread = 0;    // of the edge about the circle, standard [px]
};

// The centre, from near by, of a ball whose outline has its edge at `rim` from it [px]. `grey`: 32-bit.
RimFit fit_rim(const cv::Mat& grey, const cv::Point2d& near, double rim);

// Radius of the outline's edge [px] of balls that are supposed to have this radius; NaN where it is not sharp.
double learn_rim(const std::vector<cv::Mat>& greys, const std::vector<std::vector<cv::Point2d>>& centres,
                 double radius);

// What fit_rim takes.
cv::Mat grey_of(const cv::Mat& bgr);

}  // namespace tumble::analysis
