#include "analysis/mill_camera.h"

#include <Eigen/Geometry>
#include <cmath>

namespace tumble::analysis {
namespace {

Eigen::Vector2d undistorted(const MillCamera& camera, const Eigen::Vector2d& seen) {
  // seen = true (1 + k1 q^2 + k2 q^4) along one line through the principal point: Newton for q.
  const double length = seen.norm();
  if (length < 1e-12) return seen;
  double q = length;
  for (int i = 0; i < 12; ++i) {
    const double q2 = q * q, miss = q * (1 + q2 * (camera.k1 + camera.k2 * q2)) - length;
    const double slope = 1 + q2 * (3 * camera.k1 + 5 * camera.k2 * q2);
    if (slope < 0.1) return {kNotGiven, kNotGiven};  // beyond where the lens folds the picture over
    q -= miss / slope;
    if (std::abs(miss) < 1e-13 * (1 + length)) break;
  }
  return seen * (q / length);
}

}  // namespace

cv::Point2d picture_of(const MillCamera& camera, const Eigen::Vector3d& place) {
  const Eigen::Vector3d p = camera.rotation * place + camera.translation;
  if (!(p.z() > 0)) return {kNotGiven, kNotGiven};
  const double x = p.x() / p.z(), y = p.y() / p.z(), q2 = x * x + y * y;
  const double swell = camera.focal * (1 + q2 * (camera.k1 + camera.k2 * q2));
  return {camera.centre_u + swell * x, camera.centre_v + swell * y};
}

Eigen::Vector2d mill_place_at(const MillCamera& camera, const cv::Point2d& pixel, double z) {
  const Eigen::Vector2d q =
      undistorted(camera, Eigen::Vector2d(pixel.x - camera.centre_u, pixel.y - camera.centre_v) / camera.focal);
  const Eigen::Vector3d ray = camera.rotation.transpose() * Eigen::Vector3d(q.x(), q.y(), 1);
  const Eigen::Vector3d eye = -(camera.rotation.transpose() * camera.translation);
  const double along = (z - eye.z()) / ray.z();
  if (!(along > 0)) return {kNotGiven, kNotGiven};
  return (eye + along * ray).head<2>();
}

double apparent_radius(const MillCamera& camera, const Eigen::Vector3d& place, double radius) {
  // The outline is where lines of sight graze the ball: a circle about the line to its centre, nearer than the centre.
  const Eigen::Vector3d eye = -(camera.rotation.transpose() * camera.translation), gaze = place - eye;
  const double distance2 = gaze.squaredNorm(), r2 = radius * radius;
  if (!(distance2 > r2)) return kNotGiven;
  const Eigen::Vector3d middle = place - gaze * (r2 / distance2);
  const double reach = radius * std::sqrt(1 - r2 / distance2);
  const Eigen::Vector3d across = gaze.unitOrthogonal(), other = gaze.cross(across).normalized();
  const auto width = [&](const Eigen::Vector3d& d) {
    const cv::Point2d a = picture_of(camera, middle + reach * d), b = picture_of(camera, middle - reach * d);
    return std::hypot(a.x - b.x, a.y - b.y);
  };
  return 0.25 * (width(across) + width(other));
}

double obliqueness(const MillCamera& camera) {
  const Eigen::Vector3d axis = camera.rotation.col(2);
  return std::acos(std::min(1.0, std::abs(axis.dot(camera.translation.normalized()))));
}

MillCamera rolled(const MillCamera& camera, double roll) {
  MillCamera turned = camera;
  turned.rotation = camera.rotation * Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ());
  return turned;
}

MillCamera with_lengths_times(const MillCamera& camera, double factor) {
  MillCamera scaled = camera;
  scaled.translation *= factor;
  return scaled;
}

MillCamera from_afar(const MillCamera& camera) {
  constexpr double kTimes = 1e4;
  MillCamera afar = camera;
  afar.focal *= kTimes;
  afar.translation.z() *= kTimes;
  afar.k1 *= kTimes * kTimes;
  afar.k2 *= std::pow(kTimes, 4);
  return afar;
}

MillCamera for_enlarged_pictures(const MillCamera& camera, double factor) {
  MillCamera scaled = camera;
  scaled.focal *= factor;
  scaled.centre_u = (camera.centre_u + 0.5) * factor - 0.5;
  scaled.centre_v = (camera.centre_v + 0.5) * factor - 0.5;
  scaled.width = static_cast<int>(std::lround(camera.width * factor));
  scaled.height = static_cast<int>(std::lround(camera.height * factor));
  return scaled;
}

}  // namespace tumble::analysis
