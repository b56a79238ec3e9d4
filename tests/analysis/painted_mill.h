#pragma once
#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "core/random.h"
#include "core/units.h"

// Pictures of a mill painted point by point, sharing nothing with the renderer: shaded balls with highlights and
// marks on a dull ground, square lifters, a rim with bolts, noise. Anti-aliased by 2 x 2 samples a pixel.
namespace tumble::analysis {

struct PaintedBall {
  double u = 0, v = 0, radius = 10;
  double mark = 0;                  // direction of a painted line [rad]
  cv::Vec3d colour{150, 150, 150};  // BGR
};

struct PaintedMill {
  int width = 384, height = 368;
  double u = 190.3, v = 182.8, radius = 150.6;  // the inner shell [px]
  int lifters = 12;
  double lifter_height = 11, lifter_width = 11;  // [px]
  double angle = 0;                              // of a lifter, counter-clockwise as seen [rad]
  double noise = 2;                              // standard deviation [grey levels]
};

// Off the middle of a larger picture.
inline PaintedMill large_painted_mill() {
  PaintedMill mill;
  mill.width = 640;
  mill.height = 480;
  mill.u = 330;
  mill.v = 236;
  mill.radius = 190;
  return mill;
}

inline cv::Vec3d painted_point(const PaintedMill& m, const std::vector<PaintedBall>& balls, double u, double v) {
  for (const PaintedBall& b : balls) {
    const double x = (u - b.u) / b.radius, y = -(v - b.v) / b.radius, r2 = x * x + y * y;
    if (r2 >= 1) continue;
    const double z = std::sqrt(1 - r2), light = std::max(0.0, -0.4 * x + 0.5 * y + 0.77 * z);
    cv::Vec3d c = b.colour * (0.25 + 0.75 * light);
    const double across = -x * std::sin(b.mark) + y * std::cos(b.mark);
    if (std::abs(across) < 0.12 && r2 < 0.6) c = c * 0.5 + cv::Vec3d(110, 115, 120);
    const double shine = std::hypot(x + 0.35, y - 0.4);
    if (shine < 0.16) c = cv::Vec3d(250, 250, 250);
    return c;
  }
  const double x = u - m.u, y = -(v - m.v), rho = std::hypot(x, y), a = std::atan2(y, x) - m.angle;
  const double pitch = 2 * kPi / std::max(1, m.lifters);
  if (rho > m.radius + 22) return {60, 66, 70};
  if (rho > m.radius) {
    const double bolt = std::hypot(rho - m.radius - 11, std::remainder(a - 0.3 * pitch, pitch) * rho);
    return bolt < 4 ? cv::Vec3d(190, 190, 190) : cv::Vec3d(110, 105, 100);
  }
  const double aside = std::remainder(a, pitch);
  const bool lifter = m.lifters > 0 && rho * std::cos(aside) > m.radius - m.lifter_height &&
                      std::abs(rho * std::sin(aside)) < 0.5 * m.lifter_width;
  return lifter ? cv::Vec3d(95, 90, 80) : cv::Vec3d(45, 40, 42);
}

inline cv::Mat paint(const PaintedMill& m, const std::vector<PaintedBall>& balls, std::uint64_t seed) {
  cv::Mat picture(m.height, m.width, CV_8UC3);
  Random random(seed);
  for (int v = 0; v < m.height; ++v)
    for (int u = 0; u < m.width; ++u) {
      std::vector<PaintedBall> near;
      for (const PaintedBall& b : balls)
        if (std::hypot(b.u - u, b.v - v) < b.radius + 1) near.push_back(b);
      cv::Vec3d sum(0, 0, 0);
      for (double j : {-0.25, 0.25})
        for (double i : {-0.25, 0.25}) sum += painted_point(m, near, u + i, v + j) / 4.0;
      double grain = 0;  // nearly normal, variance 1
      for (int k = 0; k < 4; ++k) grain += std::sqrt(3.0) * (random.uniform() - 0.5);
      auto& pixel = picture.at<cv::Vec3b>(v, u);
      for (int c = 0; c < 3; ++c) pixel[c] = cv::saturate_cast<uchar>(sum[c] + m.noise * grain);
    }
  return picture;
}

// Balls in rows that touch, filling the part of the mill below the line through its axis at `slope_deg`.
inline std::vector<PaintedBall> packed_bed(const PaintedMill& m, double radius, double slope_deg, std::uint64_t seed) {
  std::vector<PaintedBall> balls;
  Random random(seed);
  const double tip = m.radius - m.lifter_height, s = std::sin(slope_deg * kPi / 180),
               c = std::cos(slope_deg * kPi / 180);
  for (int row = -20; row <= 20; ++row)
    for (int k = -20; k <= 20; ++k) {
      const double x = (2 * k + (row & 1)) * radius, y = row * std::sqrt(3.0) * radius;
      if (std::hypot(x, y) + radius > tip || -x * s + y * c > -0.15 * m.radius) continue;
      balls.push_back({m.u + x, m.v - y, radius, random.uniform(0, kPi), {130 + random.uniform(-20, 60), 150, 150}});
    }
  return balls;
}

}  // namespace tumble::analysis
