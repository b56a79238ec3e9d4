#pragma once
#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "core/config.h"

namespace tumble::analysis {

// A pinhole camera with square pixels and radial distortion that looks at a mill.
//
// Mill frame: x right, y up, z along the axis towards the camera; origin on the axis, z = 0 the inside of the front
// glass (a ball that touches it has z = -r). "Up" is the picture's: the camera is not rolled against the mill until
// `rolled` says so. Camera frame: x right, y down, z away from the camera (OpenCV's). Lengths in metres where the
// mill's diameter is known, else in shell radii.
struct MillCamera {
  double focal = 1000;                   // f [px], > 0
  double centre_u = 0, centre_v = 0;     // principal point [px]
  double k1 = 0, k2 = 0;                 // radial distortion: seen = true (1 + k1 q^2 + k2 q^4), q in focal lengths
  Eigen::Matrix3d rotation = frontal();  // camera from mill
  Eigen::Vector3d translation = Eigen::Vector3d(0, 0, 1);  // of the mill's origin, in the camera frame
  int width = 0, height = 0;                               // of the picture [px]

  static Eigen::Matrix3d frontal();  // of a camera that looks along the axis
};

// Pixel at which a place of the mill frame is seen; NaN for what lies behind the camera.
cv::Point2d picture_of(const MillCamera& camera, const Eigen::Vector3d& place);

// Where the line of sight of a pixel meets the plane `z` of the mill frame; NaN where it does not.
Eigen::Vector2d mill_place_at(const MillCamera& camera, const cv::Point2d& pixel, double z);

// Half the mean width at which a ball is seen [px].
double apparent_radius(const MillCamera& camera, const Eigen::Vector3d& place, double radius);

// Angle between the line of sight to the mill's origin and its axis [rad].
double obliqueness(const MillCamera& camera);

// The same camera for a mill frame turned counter-clockwise by `roll` [rad], as seen: what lay at angle `roll` in the
// old frame lies at 0 in the new one.
MillCamera rolled(const MillCamera& camera, double roll);

// The same camera with lengths times `factor`, or for pictures enlarged `factor` times along each side.
MillCamera with_lengths_times(const MillCamera& camera, double factor);
MillCamera for_enlarged_pictures(const MillCamera& camera, double factor);

}  // namespace tumble::analysis
