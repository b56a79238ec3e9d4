#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <functional>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "analysis/mill_camera.h"
#include "core/random.h"
#include "core/units.h"

// A film of a turning drum by a known camera: flange with bolts and rust in the plane of the glass, lifters, a stained
// back plate, balls that circulate. Shares nothing with the calibration but the camera's own formulas.
namespace tumble::analysis {

struct PaintedDrum {
  MillCamera camera;                   // lengths in metres
  double shell = 0.25, length = 0.06;  // R and the depth of the back plate [m]
  double bore = 0.256, rim = 0.29;     // of the flange [m]
  int lifters = 16, bolts = 12;
  double lifter_height = 0.018, lifter_width = 0.018, lifter_angle = 0.1;
  double ball = 0.012;  // radius [m]
  int balls = 90;
  double flange_contrast = 1;                      // of its stains
  double readout = 0;                              // of a picture, in frame periods
  double step = 0.04;                              // turn per frame period [rad]
  double noise = 2;                                // [grey levels]
  double light_from = 2.2, light_slope = 0.3;      // brightness of the flange towards this angle
  double bar_angle = kNotGiven, bar_width = 0.03;  // a static bar before the glass, through the axis
  std::uint64_t seed = 1;
};

class DrumPainter {
 public:
  explicit DrumPainter(const PaintedDrum& drum) : d_(drum), random_(drum.seed) {
    front_ = cv::Mat(kRadii, kAngles, CV_32FC2);  // brightness, opacity
    back_ = cv::Mat(kRadii, kAngles, CV_32F);
    const cv::Mat rust = stains(220, 0.004, 0.02), dirt = stains(200, 0.004, 0.02);
    for (int i = 0; i < kRadii; ++i)
      for (int k = 0; k < kAngles; ++k) {
        const double r = radius_of(i), a = 2 * kPi * k / kAngles;
        double bright = 40, opaque = 0;
        if (r >= d_.bore && r <= d_.rim) {
          const double middle = 0.5 * (d_.bore + d_.rim);
          bright = 120 + d_.flange_contrast * 40 * rust.at<float>(i, k);
          const double pitch = 2 * kPi / std::max(1, d_.bolts), aside = std::remainder(a - 0.05, pitch) * r;
          if (d_.bolts > 0 && std::hypot(r - middle, aside) < 0.25 * (d_.rim - d_.bore)) bright += 35;
          opaque = 1;
        } else if (r >= d_.shell && r < d_.bore) {
          bright = 30;
          opaque = 1;
        } else if (r < d_.shell && d_.lifters > 0) {
          const double pitch = 2 * kPi / d_.lifters, aside = std::remainder(a - d_.lifter_angle, pitch);
          if (r * std::cos(aside) > d_.shell - d_.lifter_height &&
              std::abs(r * std::sin(aside)) < 0.5 * d_.lifter_width) {
            bright = 75;
            opaque = 1;
          }
        }
        front_.at<cv::Vec2f>(i, k) = {static_cast<float>(bright), static_cast<float>(opaque)};
        back_.at<float>(i, k) = static_cast<float>(r < d_.shell ? 70 + 25 * dirt.at<float>(i, k) : 35);
      }
    const cv::Size size(kFine * d_.camera.width, kFine * d_.camera.height);
    for (cv::Mat* m : {&front_row_, &front_angle_, &back_row_, &back_angle_, &light_}) m->create(size, CV_32F);
    for (int v = 0; v < size.height; ++v)
      for (int u = 0; u < size.width; ++u) {
        const cv::Point2d p((u + 0.5) / kFine - 0.5, (v + 0.5) / kFine - 0.5);
        const Eigen::Vector2d f = mill_place_at(d_.camera, p, 0), b = mill_place_at(d_.camera, p, -d_.length);
        front_row_.at<float>(v, u) = static_cast<float>(row_of(f.norm()));
        back_row_.at<float>(v, u) = static_cast<float>(row_of(b.norm()));
        front_angle_.at<float>(v, u) = static_cast<float>(std::atan2(f.y(), f.x()));
        back_angle_.at<float>(v, u) = static_cast<float>(std::atan2(b.y(), b.x()));
        light_.at<float>(v, u) = static_cast<float>(
            1 + d_.light_slope * (f.x() * std::cos(d_.light_from) + f.y() * std::sin(d_.light_from)) / d_.rim);
      }
    cv::Mat coarse(9, 16, CV_32F);
    for (int i = 0; i < 9 * 16; ++i) coarse.at<float>(i / 16, i % 16) = static_cast<float>(random_.uniform(50, 160));
    cv::resize(coarse, ground_, size, 0, 0, cv::INTER_CUBIC);
    for (int i = 0; i < d_.balls; ++i)
      balls_.push_back({random_.uniform(0.45, 1.0), random_.uniform(), random_.uniform(0.85, 1.0)});
  }

  // The picture whose middle row is read out at drum angle `angle`; 8-bit BGR.
  cv::Mat paint(double angle) {
    const cv::Size size = front_row_.size();
    cv::Mat fx(size, CV_32F), bx(size, CV_32F);
    for (int v = 0; v < size.height; ++v) {
      const double turned = angle + d_.step * d_.readout * ((v + 0.5) / size.height - 0.5);
      const double per = kAngles / (2 * kPi);
      for (int u = 0; u < size.width; ++u) {
        const auto column = [&](float a) {
          const double c = (a - turned) * per;
          return static_cast<float>(c - kAngles * std::floor(c / kAngles));
        };
        fx.at<float>(v, u) = column(front_angle_.at<float>(v, u));
        bx.at<float>(v, u) = column(back_angle_.at<float>(v, u));
      }
    }
    cv::Mat front, back;
    cv::remap(front_, front, fx, front_row_, cv::INTER_LINEAR, cv::BORDER_WRAP);
    cv::remap(back_, back, bx, back_row_, cv::INTER_LINEAR, cv::BORDER_WRAP);
    cv::Mat picture(size, CV_32F);
    for (int v = 0; v < size.height; ++v)
      for (int u = 0; u < size.width; ++u) {
        const double r = radius_of(front_row_.at<float>(v, u));
        picture.at<float>(v, u) = r < d_.shell && front.at<cv::Vec2f>(v, u)[1] < 0.5 ? back.at<float>(v, u) : -1;
      }
    paint_balls(picture, angle);
    for (int v = 0; v < size.height; ++v)
      for (int u = 0; u < size.width; ++u) {
        const double r = radius_of(front_row_.at<float>(v, u));
        float& p = picture.at<float>(v, u);
        const cv::Vec2f f = front.at<cv::Vec2f>(v, u);
        if (r > d_.rim)
          p = ground_.at<float>(v, u);
        else if (f[1] >= 0.5)
          p = f[0] * light_.at<float>(v, u);
        if (!std::isnan(d_.bar_angle) && r < 1.3 * d_.rim) {
          const double a = front_angle_.at<float>(v, u) - d_.bar_angle;
          if (std::cos(a) > 0 && std::abs(r * std::sin(a)) < 0.5 * d_.bar_width) p = 95;
        }
      }
    cv::Mat small, bgr(d_.camera.height, d_.camera.width, CV_8UC3);
    cv::resize(picture, small, bgr.size(), 0, 0, cv::INTER_AREA);
    for (int v = 0; v < bgr.rows; ++v)
      for (int u = 0; u < bgr.cols; ++u) {
        const double grain = 2 * std::sqrt(3.0) * (random_.uniform() - 0.5);  // variance 1
        const auto g = cv::saturate_cast<uchar>(small.at<float>(v, u) + d_.noise * grain);
        bgr.at<cv::Vec3b>(v, u) = {g, g, g};
      }
    return bgr;
  }

 private:
  static constexpr int kRadii = 400, kAngles = 3072, kFine = 2;
  struct Ball {
    double reach, phase, speed;
  };

  double radius_of(double row) const { return row / kRadii * 1.2 * d_.rim; }
  double row_of(double radius) const { return std::min(radius / (1.2 * d_.rim) * kRadii, kRadii - 1.0); }

  cv::Mat stains(int count, double least, double most) {
    cv::Mat map = cv::Mat::zeros(kRadii, kAngles, CV_32F);
    for (int n = 0; n < count; ++n) {
      const double r0 = random_.uniform(0, d_.rim), a0 = random_.uniform(0, 2 * kPi), w = random_.uniform(least, most);
      const double depth = random_.uniform(-1, 1);
      for (int i = 0; i < kRadii; ++i) {
        const double r = radius_of(i);
        if (std::abs(r - r0) > 2.5 * w) continue;
        for (int k = 0; k < kAngles; ++k) {
          const double across = std::remainder(2 * kPi * k / kAngles - a0, 2 * kPi) * r0;
          const double q = ((r - r0) * (r - r0) + across * across) / (w * w);
          if (q < 6) map.at<float>(i, k) += static_cast<float>(depth * std::exp(-q));
        }
      }
    }
    return map;
  }

  // Up with the drum along the lower right, back across: every ball on a path of its own.
  void paint_balls(cv::Mat& picture, double angle) const {
    for (const Ball& b : balls_) {
      const double way = b.phase + b.speed * std::abs(angle) / 2.4, turn = way - std::floor(way);
      const double sense = d_.step < 0 ? -1 : 1;
      const double a = -0.5 * kPi + sense * (-0.6 + 1.9 * turn), rho = b.reach * (d_.shell - d_.ball);
      const Eigen::Vector3d place(rho * std::cos(a), rho * std::sin(a), -d_.ball);
      const cv::Point2d c = picture_of(d_.camera, place);
      const double r = kFine * apparent_radius(d_.camera, place, d_.ball);
      const double u0 = kFine * (c.x + 0.5) - 0.5, v0 = kFine * (c.y + 0.5) - 0.5;
      for (int v = std::max(0, static_cast<int>(v0 - r)); v <= std::min(picture.rows - 1, static_cast<int>(v0 + r));
           ++v)
        for (int u = std::max(0, static_cast<int>(u0 - r)); u <= std::min(picture.cols - 1, static_cast<int>(u0 + r));
             ++u) {
          const double x = (u - u0) / r, y = (v - v0) / r;
          if (x * x + y * y < 1)
            picture.at<float>(v, u) = static_cast<float>(190 - 70 * (x * x + y * y) - 30 * (x + y));
        }
    }
  }

  PaintedDrum d_;
  Random random_;
  cv::Mat front_, back_, front_row_, front_angle_, back_row_, back_angle_, light_, ground_;
  std::vector<Ball> balls_;
};

// A camera `oblique` radians to the right of the axis, with the drum's rim `reach` pixels wide at the axis.
inline MillCamera camera_for(cv::Size picture, double focal, double yaw, double pitch, double rim_px, double rim,
                             cv::Point2d axis, double k1) {
  MillCamera c;
  c.width = picture.width;
  c.height = picture.height;
  c.focal = focal;
  c.centre_u = 0.5 * (picture.width - 1);
  c.centre_v = 0.5 * (picture.height - 1);
  c.k1 = k1;
  c.rotation = (Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitY()))
                   .toRotationMatrix() *
               MillCamera::frontal();
  const double depth = focal * rim / rim_px;
  c.translation = {(axis.x - c.centre_u) / focal * depth, (axis.y - c.centre_v) / focal * depth, depth};
  return c;
}

}  // namespace tumble::analysis
