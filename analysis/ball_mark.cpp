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

double luminance(const cv::Mat& bgr, int u, int v) {
  const auto& p = bgr.at<cv::Vec3b>(std::clamp(v, 0, bgr.rows - 1), std::clamp(u, 0, bgr.cols - 1));
  return 0.114 * p[0] + 0.587 * p[1] + 0.299 * p[2];
}

double luminance_between(const cv::Mat& bgr, double u, double v) {
  const int u0 = static_cast<int>(std::floor(u)), v0 = static_cast<int>(std::floor(v));
  const double a = u - u0, b = v - v0;
  return (1 - b) * ((1 - a) * luminance(bgr, u0, v0) + a * luminance(bgr, u0 + 1, v0)) +
         b * ((1 - a) * luminance(bgr, u0, v0 + 1) + a * luminance(bgr, u0 + 1, v0 + 1));
}

}  // namespace

MarkLook look_at_mark(const cv::Mat& bgr, double u, double v, double radius) {
  static const Wheel wheel;
  MarkLook look;
  double sum = 0;
  for (std::size_t ring = 0; ring < kRings.size(); ++ring) {
    std::array<double, kDirections> light{};
    for (std::size_t k = 0; k < kDirections; ++k) {
      light[k] = luminance_between(bgr, u + kRings[ring] * radius * wheel.c[k], v - kRings[ring] * radius * wheel.s[k]);
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
