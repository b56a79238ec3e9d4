#pragma once
#include <opencv2/core.hpp>
#include <vector>

#include "analysis/ball_detector.h"
#include "analysis/ring_occupancy.h"
#include "analysis/view.h"

namespace tumble::analysis {

// Which pixels show charge, for pictures in which not every ball can be found.

// What the net takes for balls, by pixel of the picture (0 to 1, CV_32F).
cv::Mat charge_share(const Detections& seen, cv::Size picture);

// Balls that were found cover their whole discs: holes through them, shadows on them and marks too.
void cover_discs(cv::Mat& share, const std::vector<Detection>& balls, const MillView& view);

// What moves too fast for the net to be sure of it has still the charge's colours: pixels inside the shell whose colour
// is common in the charge and rare where nothing of it is become charge. Nothing changes where balls and mill are
// coloured alike.
void add_charge_colours(std::vector<cv::Mat>& shares, const std::vector<cv::Mat>& pictures, const Circle& mill);

// A bed too fine for its balls to be told apart, before a plain ground (or air, in averaged pictures): the two tones of
// what lies within the circle, and for every pixel its share of the bed's. The bed is the one that lies lower. Empty
// where the pictures have not two tones.
std::vector<cv::Mat> two_tone_shares(const std::vector<cv::Mat>& pictures, const Circle& mill);

struct ChargeShape {
  double area = 0;  // inside the shell [px^2]
  double lean_deg =
      kNotGiven;  // of its centre of area as seen from the axis, from straight down to the picture's right
};
ChargeShape charge_shape(const cv::Mat& share, const Circle& mill);

// Areal occupancy of a ring (radii in pixels) by the pixels that show charge, by half at least; angles
// counter-clockwise as seen, mirrored (x -> -x) where asked. NaN where the
// picture ends.
RingProfile mask_occupancy(const cv::Mat& share, const Circle& mill, const Ring& ring, bool mirror);

}  // namespace tumble::analysis
