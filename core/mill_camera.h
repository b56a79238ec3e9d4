#pragma once
#include <Eigen/Core>

namespace tumble {

// A pinhole camera with square pixels and radial distortion that looks at a mill.
//
// Mill frame: x right, y up, z along the axis towards the camera; origin on the axis, z = 0 the inside of the front
// glass (a ball that touches it has z = -r). "Up" is the picture's: the camera is not rolled against the mill until
// `rolled` says so. Camera frame: x right, y down, z away from the camera (OpenCV's). Lengths in a unit of the
// holder's: metres, or shell radii.
struct MillCamera {
  double focal = 1000;                   // f [px], > 0
  double centre_u = 0, centre_v = 0;     // principal point [px]
  double k1 = 0, k2 = 0;                 // radial distortion: seen = true (1 + k1 q^2 + k2 q^4), q in focal lengths
  Eigen::Matrix3d rotation = frontal();  // camera from mill
  Eigen::Vector3d translation = Eigen::Vector3d(0, 0, 1);  // of the mill's origin, in the camera frame
  int width = 0, height = 0;                               // of the picture [px]

  // Of a camera that looks along the axis.
  static Eigen::Matrix3d frontal() { return Eigen::Vector3d(1, -1, -1).asDiagonal(); }
};

}  // namespace tumble
