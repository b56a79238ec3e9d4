#pragma once
#include <opencv2/core.hpp>
#include <span>
#include <vector>

#include "core/statistics.h"

// Which of the camera's pictures stand in a film's frames: some are there twice, some are missing. Told from how much
// the picture changes from frame to frame and from the drum, whose speed is even over a few frames.
namespace tumble::analysis {

// Mean absolute difference of two pictures of equal size within a circle, in grey levels of 255. 8 bits, grey or BGR
// (its green). Every fourth pixel along both sides: a fiftieth of a millisecond at 1280 x 720.
double picture_difference(const cv::Mat& before, const cv::Mat& now, double centre_u, double centre_v, double radius);

struct FrameEvidence {                 // one value a frame of the file
  std::span<const double> difference;  // to the frame before, any unit; NaN where unknown, as for the first; or empty
  // To the frame before the last, likewise; or empty. It shows what one missing frame would look like in this film.
  std::span<const double> difference_over_two;
  std::span<const double> angle;   // of the drum, unwrapped, growing [rad]; NaN where unknown; or empty
  double angle_sigma = kNotGiven;  // its standard deviation [rad]; NaN, or too small: found from the angles
};

struct DroppedFrames {
  int after = 0;    // frame of the file after which some are missing
  int missing = 0;  // how many
};

struct FrameClock {
  std::vector<int> duplicated;         // frames of the file that repeat the one before
  std::vector<DroppedFrames> dropped;  // only where there are angles: a picture alone does not show them
  std::vector<int> source;             // by frame of the file: recorded index, from 0; time = index / recorded rate
  bool drops_can_be_seen = false;      // the angles are good enough for a single missing frame
};

FrameClock find_frame_clock(const FrameEvidence& evidence);

}  // namespace tumble::analysis
