#pragma once
#include <array>
#include <memory>
#include <vector>

#include "analysis/drum_texture.h"
#include "analysis/drum_turn.h"

namespace tumble::analysis {

// The drum's turn in one picture, counter-clockwise as the camera sees it, before any mirroring, when the middle row
// is read out [rad].
struct DrumAngle {
  double angle = 0;
  double error = kNotGiven;  // standard error; NaN where the drum's texture was not found in the picture
  int pieces = 0;            // of the texture that were found

  // What each part of the drum says by itself, an eighth of the round each.
  static constexpr std::size_t kParts = 8;
  std::array<float, kParts> part_turn{}, part_say{};  // beyond `angle` [rad]; weight, 0 where it was not found
};

// A grey picture, 8 bit, of 1/`times` the size along each side.
cv::Mat reduced_grey(const cv::Mat& bgr, int times);

// Reads the drum's angle off pictures: what stands still, what turns, and how pictures are unrolled.
class DrumReader {
 public:
  // `greys`: reduced pictures to learn from, at their drum angles [rad].
  DrumReader(const DrumPose& pose, const PolarGrid& grid, int reduced, const std::vector<cv::Mat>& greys,
             const std::vector<double>& angles, double blur, int margin);

  // A picture of the film, as FilmReader hands it out; the angle next to `expected` where the texture repeats itself.
  // `step`: usual turn from picture to picture.
  DrumAngle operator()(const cv::Mat& bgr, double expected, double step) const;

  // Within `reach` of an angle that is known roughly [rad].
  DrumAngle angle_near(const cv::Mat& strip, double expected, double reach) const;
  // By how much all that is seen in one direction errs alike, at least [rad].
  double alike() const;

  const Unroller& unroll() const { return unroll_; }
  const StillPart& still() const { return *still_; }
  const DrumTexture& texture() const { return *texture_; }
  const std::vector<cv::Mat>& strips() const { return strips_; }  // of the pictures learned from
  const std::vector<cv::Mat>& moving() const { return moving_; }  // and of them what does not stand still
  void forget_pictures() {
    strips_.clear();
    moving_.clear();
  }

 private:
  DrumAngle refined(const cv::Mat& moving, double rough) const;

  Unroller unroll_;
  int reduced_;
  std::vector<cv::Mat> strips_, moving_;
  std::unique_ptr<StillPart> still_;
  std::unique_ptr<DrumTexture> texture_;
  RoundSpectrum pattern_;
};

}  // namespace tumble::analysis
