#pragma once
#include <opencv2/core.hpp>
#include <vector>

#include "analysis/drum_pose.h"

namespace tumble::analysis {

// What stands still in front of the drum: bars, hubs, lettering, glare. There nothing ever changes, while lifters or
// balls pass everywhere else. A bare back plate that nothing passes does not change either; but it lacks what covers
// have: it blends into what surrounds it, and it does not reach into the ring of the lifters.

// 8 bit, 255 where the drum is covered. `mean`, `deviation`: of the pictures over time, CV_32F; `tip`, `shell`: radii
// of the lifter tips and the shell [px at the origin].
cv::Mat hidden_part(const cv::Mat& mean, const cv::Mat& deviation, const DrumPose& pose, double tip, double shell);

// Share of the ring between two radii that is hidden or out of the picture, by degree from 3 o'clock.
std::vector<double> hidden_share(const cv::Mat& hidden, const DrumPose& pose, double inner, double outer);

}  // namespace tumble::analysis
