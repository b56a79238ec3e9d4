#pragma once
#include <opencv2/core.hpp>
#include <vector>

namespace tumble::analysis {

struct Circle {
  double u = 0, v = 0, radius = 0;  // [px], v down, integer = pixel centre
};

struct RingEdge {  // one of the circles that a round thing seen from the front shows
  Circle circle;
  double strength = 0;  // mean step of brightness across it, outside minus inside [grey levels]
  double coverage = 0;  // share of the directions in which it was found
};

// Concentric circles in a grey picture (8 bit or float, 0 to 255): a common centre from the lines along the gradients,
// then each circle by itself, sub-pixel. Strongest first; empty where nothing round is seen. Circles smaller than
// `least_radius` are not looked for.
std::vector<RingEdge> find_concentric_circles(const cv::Mat& grey, double least_radius);

// Where the lines along the gradients of pictures of one size meet, sub-pixel; only those of pixels in `where` (8 bit,
// or empty for all). NaN where there are hardly any.
cv::Point2d centre_of_circles(const std::vector<cv::Mat>& greys, const cv::Mat& where, double least_radius);

// Algebraic circle fit (Taubin 1991) with weights; radius 0 where the points do not tell.
Circle fit_circle(const std::vector<cv::Point2d>& points, const std::vector<double>& weights);

}  // namespace tumble::analysis
