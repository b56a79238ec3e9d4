#pragma once
#include <opencv2/core.hpp>
#include <vector>

#include "analysis/circles.h"
#include "analysis/edge_map.h"

namespace tumble::analysis {

struct Detection {
  double u = 0, v = 0;  // centre [px]
  double radius = 0;    // of its size class [px]
  double score = 0;     // share of the rim with an edge of the right sign, weighted by its clearness, [0, 1]
  int size_class = 0;
};

// What the balls look like in this film.
struct BallLook {
  std::vector<double> radii;  // of the size classes [px], ascending
  int polarity = 1;           // +1: brighter than what surrounds them, -1: darker
  double edge_level = 1;      // see EdgeMap
  double least_score = 0.20;  // of a ball that is looked at further
  double birth_score = 0.30;  // of a ball that is believed on its own
};

// Balls of known sizes in one picture, within `bound`. Centres from the rim alone (a circle through the edge points,
// robust), so that highlights, marks and holes do not pull them.
std::vector<Detection> detect_balls(const cv::Mat& bgr, const BallLook& look, const Circle& bound);

struct ScaleRange {  // pixels per unit of the known radii
  double least = 0, most = 1e9;
};

// Sizes, polarity and clearness of the balls from a few pictures of the film; radii empty where no balls are seen.
// `known` sizes (any unit, ascending) give the number of classes and their ratios; without them, classes are found.
// `scales` bounds that unknown: graded charges look alike one class up or down.
BallLook learn_look(const std::vector<cv::Mat>& pictures, const Circle& bound, const std::vector<double>& known,
                    ScaleRange scales = {});

// A circle of about `radius` at about (u, v) put onto the rim's edge points. With `free_radius` the radius is fitted
// too.
Detection refine_on_rim(const EdgeMap& edges, int polarity, double u, double v, double radius, bool free_radius);

}  // namespace tumble::analysis
