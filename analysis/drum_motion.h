#pragma once
#include <complex>
#include <opencv2/core.hpp>
#include <vector>

#include "analysis/circles.h"

namespace tumble::analysis {

// Angles here are counter-clockwise as the camera sees the mill, before any mirroring [rad].

// A picture's brightness round the drum: one row per annulus, kAngles samples each, counter-clockwise from 3 o'clock.
struct DrumStrip {
  static constexpr int kAngles = 720;
  static constexpr int kAnnuli = 12;
  cv::Mat rows;  // CV_32F, kAnnuli x kAngles
};

// Unrolls annuli about a centre; the sampling table is made once.
class DrumUnroller {
 public:
  DrumUnroller(const Circle& centre, double inner, double outer, cv::Size picture);
  DrumStrip operator()(const cv::Mat& bgr) const;

 private:
  cv::Mat map_u_, map_v_;
};

// What turns with the drum: lifters, bolts, scratches; learned from the first part of a film.
struct DrumPattern {
  bool found = false;
  double step = 0;       // mean turn per frame [rad]
  int lifter_count = 0;  // 0 where no period stands out
  double contrast = 0;   // of the turning pattern against what changes otherwise; below 1 it is not believed
  cv::Mat still;         // what stands still, as DrumStrip::rows
  std::vector<std::vector<std::complex<double>>> harmonics;  // of the turning pattern, by annulus and order
};

// `known_lifters`: 0 if not known. `expected_step`: NaN if not known; needed only where the drum turns by more than
// half a lifter spacing from frame to frame, or where the pattern is strictly periodic.
DrumPattern learn_drum(const std::vector<DrumStrip>& strips, int known_lifters, double expected_step);

// Turn of the drum in one picture against the pattern, nearest to `expected` [rad].
double drum_angle(const DrumPattern& pattern, const DrumStrip& strip, double expected);

// Angle of one lifter's middle where the drum's turn is zero [rad], in [0, spacing). Balls pass in front of everything
// inside the shell but the lifters: turned back with the drum, the pictures change least there. `rows`: the annuli
// that lie between lifter tips and shell. Only a guess, to within a quarter spacing: charge lies against the leading
// faces, so the change is lopsided. NaN without a pattern or lifter count.
double lifter_phase(const DrumPattern& pattern, const std::vector<DrumStrip>& strips, const cv::Range& rows);

}  // namespace tumble::analysis
