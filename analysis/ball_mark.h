#pragma once
#include <array>
#include <complex>
#include <cstdint>
#include <opencv2/core.hpp>

namespace tumble::analysis {

// How a ball's brightness goes round its centre: the Fourier harmonics 1..6 along four rings inside its disc. A turn
// of the ball by theta multiplies harmonic m by exp(-i m theta), so that this is all that its turning needs: 96 bytes
// in place of the picture. Ring by ring, harmonic by harmonic.
inline constexpr int kMarkRings = 4, kMarkHarmonics = 6, kMarkTerms = kMarkRings * kMarkHarmonics;

struct MarkLook {
  std::array<std::int16_t, 2 * kMarkTerms> parts{};  // real and imaginary [1/16 grey level]
  float grey = 0;                                    // mean along the rings [grey levels]

  std::complex<double> term(int k) const {
    const auto i = static_cast<std::size_t>(2 * k);
    return {parts[i] / 16.0, parts[i + 1] / 16.0};
  }
};

// Of the ball at u, v in the picture [px]; angles counter-clockwise as seen.
MarkLook look_at_mark(const cv::Mat& bgr, double u, double v, double radius);

}  // namespace tumble::analysis
