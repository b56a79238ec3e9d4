#include "render/camera.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace tumble::render {

Eigen::Vector2d Camera::direction(double angle_rad) const {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  const double across = right.x() * c + right.y() * s, up = right.x() * s - right.y() * c;
  return {mirror ? -across : across, -up};
}

double Camera::angle_in_picture(double angle_rad) const {
  const double angle = angle_rad - std::atan2(right.y(), right.x());
  return mirror ? kPi - angle : angle;
}

Camera camera_of(const Layout& layout, const View& view, const Frame& frame, double mill_speed) {
  Camera camera = layout.camera;
  if (view.from == View::From::kShell) {
    camera.right = {std::cos(frame.mill_angle), std::sin(frame.mill_angle)};
    camera.turning = mill_speed;
  } else if (view.from == View::From::kBall) {
    camera.focus = {frame.x[view.ball], frame.y[view.ball]};
    camera.centre_u = (layout.view.left + layout.view.right) / 2;
    camera.centre_v = (layout.view.top + layout.view.bottom) / 2;
  }
  return camera;
}

Layout make_layout(int width, int height, const MillShape& shape, bool panel, bool mirror, double zoom) {
  const double w = width, h = height;
  Layout layout;
  layout.picture = {-0.5, -0.5, w - 0.5, h - 0.5};  // edges, in the coordinates of pixel centres
  const bool upright = w < 1.25 * h;
  double left = 0, top = 0;  // of the design's own frame [px]
  Eigen::Vector2d centre;    // of the mill, in units
  if (!panel) {
    layout.unit = std::min(w, h) / 720.0;
    centre = {w / 2 / layout.unit, h / 2 / layout.unit};
  } else if (upright) {
    layout.unit = std::min(w / 720.0, h / 1280.0);
    left = (w - 720.0 * layout.unit) / 2;
    top = (h - 1280.0 * layout.unit) / 2;
    centre = {360.0, 366.0};
    layout.panel = {140.0, 740.0, 580.0, 1240.0};
  } else {
    layout.unit = std::min(w / 1280.0, h / 720.0);
    left = (w - 1280.0 * layout.unit) / 2;
    top = (h - 720.0 * layout.unit) / 2;
    centre = {400.0, 360.0};
    layout.panel = {800.0, 38.0, 1240.0, 682.0};
  }
  const auto place = [&](double x, double origin) { return origin + x * layout.unit - 0.5; };
  layout.panel = {place(layout.panel.left, left), place(layout.panel.top, top), place(layout.panel.right, left),
                  place(layout.panel.bottom, top)};
  layout.view = layout.picture;
  if (panel && upright) layout.view.bottom = place(716.0, top);
  if (panel && !upright) layout.view.right = place(776.0, left);
  layout.zoom = zoom;
  layout.camera.centre_u = place(centre.x(), left);
  layout.camera.centre_v = place(centre.y(), top);
  layout.camera.pixels_per_metre = zoom * (kShellRadiusUnits * layout.unit / shape.radius);
  layout.camera.mirror = mirror;
  return layout;
}

}  // namespace tumble::render
