#pragma once
#include <Eigen/Core>

#include "core/frame.h"
#include "core/mill_shape.h"
#include "render/view.h"

namespace tumble::render {

// Where the mill lies in the picture. The rule, for whoever measures the picture: the inner shell's circle has its
// centre at image_from_mill(0, 0) and the radius R x pixels_per_metre; an orthographic view along the mill's axis, no
// distortion, and no roll but for a camera that is fixed to the shell.
struct Camera {
  double centre_u = 0, centre_v = 0;  // where `focus` lies [px], v down, integer = pixel centre (core/image.h)
  double pixels_per_metre = 0;
  bool mirror = false;          // seen from the other end: x -> -x
  Eigen::Vector2d focus{0, 0};  // in the mill's frame [m]
  Eigen::Vector2d right{1, 0};  // what points to the right (left, mirrored) in the picture, in the mill's frame; unit
  double turning = 0;           // of the picture's frame against the laboratory [rad/s]

  // u = centre_u +- x s,  v = centre_v - y s,  with s = pixels_per_metre and (x, y) seen from the focus.
  Eigen::Vector2d image_from_mill(double x, double y) const {
    const double dx = x - focus.x(), dy = y - focus.y();
    const double across = right.x() * dx + right.y() * dy, up = right.x() * dy - right.y() * dx;
    return {centre_u + (mirror ? -across : across) * pixels_per_metre, centre_v - up * pixels_per_metre};
  }
  Eigen::Vector2d axis() const { return image_from_mill(0, 0); }  // the mill's [px]
  // A direction (angle counter-clockwise from 3 o'clock, mill's frame [rad]) as a unit vector in the picture.
  Eigen::Vector2d direction(double angle_rad) const;
  // The same as an angle in the picture, counter-clockwise from 3 o'clock [rad].
  double angle_in_picture(double angle_rad) const;
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
  double zoom = 1;
  Camera camera;  // fixed to the laboratory
  Box view;       // where the mill may be drawn
  Box panel;      // of clock, torque and colour bar; beside the mill, or below it in an upright picture
  Box picture;    // all of it
};

// The camera of one frame: the layout's, moved to what the view is fixed to. Speed of the mill in [rad/s].
Camera camera_of(const Layout& layout, const View& view, const Frame& frame, double mill_speed);

inline constexpr double kShellRadiusUnits = 302.4;  // inner shell's radius: 0.42 x 720
inline constexpr double kRimShare = 1.065;          // outer radius of the steel rim / R

// `panel`: whether room for text is wanted; without it the mill stands in the middle and fills the picture.
Layout make_layout(int width, int height, const MillShape& shape, bool panel, bool mirror, double zoom = 1);

}  // namespace tumble::render
