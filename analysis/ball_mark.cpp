#include "analysis/ball_mark.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace tumble::analysis {
namespace {

constexpr int kDirections = 32;
constexpr std::array<double, kMarkRings> kRings{0.30, 0.45, 0.60, 0.75};  // of the radius: further out neighbours shade

struct Wheel {  // cosines and sines of the directions
  std::array<double, kDirections> c{}, s{};
  Wheel() {
    for (std::size_t k = 0; k < kDirections; ++k) {
      c[k] = std::cos(2 * kPi * static_cast<double>(k) / kDirections);
      s[k] = std::sin(2 * kPi * static_cast<double>(k) / kDirections);
    }
  }
};

// Luminance of the pixels about a ball, continued beyond the picture's edge.
class Patch {
 public:
  Patch(const cv::Mat& bgr, double u, double v, double reach)
      : u0_(static_cast<int>(std::floor(u - reach))), v0_(static_cast<int>(std::floor(v - reach))) {
    const int columns = static_cast<int>(std::floor(u + reach)) + 2 - u0_,
              rows = static_cast<int>(std::floor(v + reach)) + 2 - v0_;
    level_.create(rows, columns);
    for (int i = 0; i < rows; ++i) {
      const auto* from = bgr.ptr<cv::Vec3b>(std::clamp(v0_ + i, 0, bgr.rows - 1));
      double* to = level_[i];
      for (int j = 0; j < columns; ++j) {
        const cv::Vec3b& p = from[std::clamp(u0_ + j, 0, bgr.cols - 1)];
        to[j] = 0.114 * p[0] + 0.587 * p[1] + 0.299 * p[2];
      }
    }
  }

  double at(double u, double v) const {  // linear between pixels
    const double x = u - u0_, y = v - v0_;
    const int j = static_cast<int>(x), i = static_cast<int>(y);
    const double a = x - j, b = y - i;
    const double *above = level_[i] + j, *below = level_[i + 1] + j;
    return (1 - b) * ((1 - a) * above[0] + a * above[1]) + b * ((1 - a) * below[0] + a * below[1]);
  }

 private:
  int u0_, v0_;
  cv::Mat_<double> level_;
};

}  // namespace

MarkLook look_at_mark(const cv::Mat& bgr, double u, double v, double radius) {
  static const Wheel wheel;
  const Patch patch(bgr, u, v, kRings.back() * radius);
  MarkLook look;
  double sum = 0;
  for (std::size_t ring = 0; ring < kRings.size(); ++ring) {
    std::array<double, kDirections> light{};
    for (std::size_t k = 0; k < kDirections; ++k) {
      light[k] = patch.at(u + kRings[ring] * radius * wheel.c[k], v - kRings[ring] * radius * wheel.s[k]);
      sum += light[k];
    }
    for (std::size_t m = 1; m <= kMarkHarmonics; ++m) {
      double re = 0, im = 0;
      for (std::size_t k = 0; k < kDirections; ++k) {
        re += light[k] * wheel.c[m * k % kDirections];
        im -= light[k] * wheel.s[m * k % kDirections];
      }
      const std::size_t at = 2 * (ring * kMarkHarmonics + m - 1);
      look.parts[at] = static_cast<std::int16_t>(std::lround(16 * re / kDirections));
      look.parts[at + 1] = static_cast<std::int16_t>(std::lround(16 * im / kDirections));
    }
  }
  look.grey = static_cast<float>(sum / (kDirections * kMarkRings));
  return look;
}

}  // namespace tumble::analysis
