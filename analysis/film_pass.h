#pragma once
#include <string>
#include <vector>

#include "analysis/ball_detector.h"
#include "analysis/ball_mark.h"
#include "analysis/drum_calibration.h"

namespace tumble::analysis {

struct FilmFrame {
  std::vector<Detection> balls;
  std::vector<std::array<float, 3>> colours;  // of the balls' inner parts [grey levels]
  std::vector<MarkLook> marks;                // of the balls
  DrumAngle drum;
  double difference = kNotGiven;  // to the frame before (frame_clock.h)
};

// The whole film once: balls, drum angle and change of every frame. Pictures are decoded one after the other and looked
// at side by side; what is found in one does not depend on the others. `bound`: where centres of balls can be [px].
std::vector<FilmFrame> look_through(const std::string& film, const DrumView& drum, const BallLook& look,
                                    const Circle& bound, double least_score, const Progress& progress);

}  // namespace tumble::analysis
