#pragma once
#include <Eigen/Core>

#include "render/film_look.h"

namespace tumble::render {

// A pinhole with radial distortion, in numbers ready for use. Camera frame: x right, y down, z forward. Points of the
// mill's frame in shell radii.
struct Pinhole {
  Eigen::Matrix3d camera_from_mill;
  Eigen::Vector3d eye;  // in the mill's frame
  double focal = 1, centre_u = 0, centre_v = 0, k1 = 0, k2 = 0;

  Eigen::Vector2d image_from_mill(const Eigen::Vector3d& point) const;
  Eigen::Vector3d ray(double u, double v) const;  // unit, in the mill's frame
};

Pinhole make_pinhole(const FilmLens& lens);

// The silhouette of a ball: its disc's area as a radius [px], and half the size of a box round it [px].
struct Silhouette {
  double radius = 0, half_width = 0, half_height = 0;
};
// The radius of a disc with the area that the shell's circle on the glass has in the picture [px].
double mill_circle_px(const Pinhole& camera);
Silhouette silhouette(const Pinhole& camera, const Eigen::Vector3d& centre, double radius);

}  // namespace tumble::render
