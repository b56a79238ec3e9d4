#include "render/camera.h"

#include <algorithm>
#include <cmath>

namespace tumble::render {

Eigen::Vector2d Camera::direction(double angle_rad) const {
  const double c = std::cos(angle_rad);
  return {mirror ? -c : c, -std::sin(angle_rad)};
}

Layout make_layout(int width, int height, const MillShape& shape, bool panel, bool mirror) {
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
  layout.camera.centre_u = place(centre.x(), left);
  layout.camera.centre_v = place(centre.y(), top);
  layout.camera.pixels_per_metre = kShellRadiusUnits * layout.unit / shape.radius;
  layout.camera.mirror = mirror;
  return layout;
}

}  // namespace tumble::render
