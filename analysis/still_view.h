#pragma once
#include <opencv2/core.hpp>
#include <vector>

#include "analysis/circles.h"

namespace tumble::analysis {

// What a still gives away of the mill by itself, where nothing moves.

// Radius at which the charge ends outwards, seen from `centre` [px]: the largest step of its share across a circle,
// over the directions in which there is charge. 0 where there is none. `shares`: of charge_shares.
double charge_reach(const std::vector<cv::Mat>& shares, const Circle& centre);

struct StillLifters {
  int count = 0;          // 0: no period stands out
  double tip_radius = 0;  // [px]
};

// Lifters from the period of brightness round the shell, in directions free of charge: the order that stands out
// between 0.85 R and R, and how far inwards it reaches.
StillLifters find_still_lifters(const std::vector<cv::Mat>& pictures, const std::vector<cv::Mat>& shares,
                                const Circle& mill, int known_count);

}  // namespace tumble::analysis
