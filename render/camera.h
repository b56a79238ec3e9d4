#pragma once
#include <Eigen/Core>

#include "core/mill_shape.h"

namespace tumble::render {

// Where the mill lies in the picture. The rule, for whoever measures the picture: the inner shell's circle has its
// centre at (centre_u, centre_v) and the radius R x pixels_per_metre; an orthographic view along the mill's axis, no
// roll, no distortion.
struct Camera {
  double centre_u = 0, centre_v = 0;  // the mill's axis [px], v down, integer = pixel centre (core/image.h)
  double pixels_per_metre = 0;
  bool mirror = false;  // seen from the other end: x -> -x

  // u = centre_u +- x s,  v = centre_v - y s,  with s = pixels_per_metre.
  Eigen::Vector2d image_from_mill(double x, double y) const {
    return {centre_u + (mirror ? -x : x) * pixels_per_metre, centre_v - y * pixels_per_metre};
  }
  // A direction (angle counter-clockwise from 3 o'clock, mill's frame [rad]) as a unit vector in the picture.
  Eigen::Vector2d direction(double angle_rad) const;
};

struct Box {
  double left = 0, top = 0, right = 0, bottom = 0;  // [px]
  double width() const { return right - left; }
  double height() const { return bottom - top; }
};

// The picture's plan. All sizes are given in units of a 1280 x 720 picture and scale with it; the inner shell's radius
// is always 0.42 x 720 units, the steel rim lies outside of it.
struct Layout {
  double unit = 1;  // one design unit [px]
  Camera camera;
  Box panel;    // of clock, torque and colour bar; beside the mill, or below it in an upright picture
  Box picture;  // all of it
};

inline constexpr double kShellRadiusUnits = 302.4;  // inner shell's radius: 0.42 x 720
inline constexpr double kRimShare = 1.065;          // outer radius of the steel rim / R

// `panel`: whether room for text is wanted; without it the mill stands in the middle and fills the picture.
Layout make_layout(int width, int height, const MillShape& shape, bool panel, bool mirror);

}  // namespace tumble::render
