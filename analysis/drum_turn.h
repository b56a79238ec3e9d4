#pragma once
#include <opencv2/core.hpp>
#include <vector>

#include "analysis/drum_texture.h"

namespace tumble::analysis {

// Turn of a drum from unrolled pictures by correlation round the axis: what comes before the camera is known well.

// The orders round the drum of one picture's moving part, by band of rows; all bands of equal say.
class RoundSpectrum {
 public:
  RoundSpectrum() = default;
  explicit RoundSpectrum(const cv::Mat& moving);

  // Correlation with `other` turned forwards by whole columns: 1 for the same pattern, by column.
  std::vector<float> match(const RoundSpectrum& other) const;

  // Sum of spectra, each turned back by its angle: what turns with the drum.
  void add_turned_back(const RoundSpectrum& other, double angle);

  RoundSpectrum bands(const cv::Range& range) const;  // of the same data
  void weigh_bands(const std::vector<double>& weights);
  std::vector<double> band_powers() const;

  const cv::Mat& orders() const { return orders_; }
  double power() const;

 private:
  cv::Mat orders_;  // CV_32FC2, bands x columns
};

struct DrumTurn {
  bool found = false;
  double step = 0;             // commonest turn from picture to picture [rad]
  std::vector<double> angles;  // by picture, the first 0 [rad]
  RoundSpectrum pattern;       // at angle 0
  double coherence = 0;        // share of what moves that turns with the drum
};

// No uniform turning is supposed: pictures may be repeated or missing. `in_view`: share of each column that is in the
// picture. `expected_step`: size of the turn from picture
// to picture where the speed is known roughly [rad], else NaN; it decides only between turns that match alike, as
// those of a drum with nothing but equal lifters do.
DrumTurn follow_turn(std::vector<RoundSpectrum> pictures, const std::vector<float>& in_view, double expected_step);

// Angle of one picture against a pattern [rad]: the best match about `expected`, of near equals the nearest to it;
// elsewhere only where nothing is found there. `step`: usual turn from picture to picture.
double angle_of(const RoundSpectrum& pattern, const RoundSpectrum& picture, double expected, double step);

// The best match within `reach` of `expected` [rad].
double angle_near(const RoundSpectrum& pattern, const RoundSpectrum& picture, double expected, double reach);

}  // namespace tumble::analysis
