#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "analysis/ball_detector.h"
#include "analysis/ball_mark.h"
#include "analysis/drum_calibration.h"
#include "core/spool.h"

namespace tumble::analysis {

struct FilmBall {
  Detection found;
  std::array<float, 3> colour{};  // of its inner part [grey levels]
  MarkLook mark;
};

// What one look at every frame gives, by frame of the file.
struct FilmPass {
  FrameSpool<FilmBall> balls;
  std::vector<DrumAngle> drum;
  std::vector<double> difference, difference_over_two;  // to the frame before, to that before it (frame_clock.h)
  std::vector<cv::Mat> kept;                            // pictures that were asked for, in order

  std::size_t frames() const { return balls.size(); }
};

// The whole film once: balls, drum angle and change of every frame. Pictures are decoded one after the other and looked
// at side by side; what is found in one does not depend on the others. `bound`: where centres of balls can be [px];
// `keep`: frames whose pictures are to be kept, ascending.
FilmPass look_through(const std::string& film, const DrumView& drum, const BallLook& look, const Circle& bound,
                      double least_score, std::span<const int> keep, const Progress& progress);

}  // namespace tumble::analysis
