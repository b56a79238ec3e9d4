#include "render/film_lens.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace tumble::render {
Pinhole make_pinhole(const FilmLens& lens) {
  const Eigen::Vector3d forward(std::sin(lens.yaw) * std::cos(lens.pitch), std::sin(lens.pitch),
                                -std::cos(lens.yaw) * std::cos(lens.pitch));
  const Eigen::Vector3d level = forward.cross(Eigen::Vector3d::UnitY()).normalized();
  const Eigen::Vector3d plumb = forward.cross(level);
  const double c = std::cos(lens.roll), s = std::sin(lens.roll);
  Pinhole camera;
  camera.camera_from_mill.row(0) = c * level + s * plumb;
  camera.camera_from_mill.row(1) = c * plumb - s * level;
  camera.camera_from_mill.row(2) = forward;
  camera.eye = lens.position;
  camera.focal = lens.focal;
  camera.centre_u = lens.centre_u;
  camera.centre_v = lens.centre_v;
  camera.k1 = lens.k1;
  camera.k2 = lens.k2;
  return camera;
}

Eigen::Vector2d Pinhole::image_from_mill(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d p = camera_from_mill * (point - eye);
  const Eigen::Vector2d q = p.head<2>() / p.z();
  const double r2 = q.squaredNorm(), stretch = 1 + r2 * (k1 + k2 * r2);
  return {centre_u + focal * stretch * q.x(), centre_v + focal * stretch * q.y()};
}

Eigen::Vector3d Pinhole::ray(double u, double v) const {
  const Eigen::Vector2d d((u - centre_u) / focal, (v - centre_v) / focal);
  const double bent = d.norm();
  double r = bent;
  for (int i = 0; i < 6; ++i) {
    const double r2 = r * r;
    r -= (r * (1 + r2 * (k1 + k2 * r2)) - bent) / (1 + r2 * (3 * k1 + 5 * k2 * r2));
  }
  const Eigen::Vector2d q = d * (r / std::max(bent, 1e-12));
  return (camera_from_mill.transpose() * Eigen::Vector3d(q.x(), q.y(), 1)).normalized();
}

namespace {

// The outline of a circle in the picture, about the picture of `seen`.
Silhouette outline_of(const Pinhole& camera, const Eigen::Vector2d& seen, const Eigen::Vector3d& middle,
                      const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  constexpr int kPoints = 24;
  Silhouette s;
  double area = 0;
  Eigen::Vector2d last(0, 0);
  for (int i = 0; i <= kPoints; ++i) {
    const double angle = 2 * kPi * i / kPoints;
    const Eigen::Vector2d p = camera.image_from_mill(middle + std::cos(angle) * a + std::sin(angle) * b) - seen;
    s.half_width = std::max(s.half_width, std::abs(p.x()));
    s.half_height = std::max(s.half_height, std::abs(p.y()));
    if (i > 0) area += 0.5 * (last.x() * p.y() - last.y() * p.x());
    last = p;
  }
  // A polygon with n corners on a circle has a little less area than it.
  const double whole = kPi / (0.5 * kPoints * std::sin(2 * kPi / kPoints));
  s.radius = std::sqrt(std::abs(area) * whole / kPi);
  return s;
}

}  // namespace

Silhouette silhouette(const Pinhole& camera, const Eigen::Vector3d& centre, double radius) {
  const Eigen::Vector3d away = centre - camera.eye;
  const double distance = away.norm();
  // Rays that graze the ball touch it along a circle, a little nearer than its centre.
  const double near = radius * radius / distance, wide = radius * std::sqrt(1 - near / distance);
  const Eigen::Vector3d axis = away / distance, a = axis.unitOrthogonal();
  return outline_of(camera, camera.image_from_mill(centre), centre - near * axis, wide * a, wide * axis.cross(a));
}

double mill_circle_px(const Pinhole& camera) {
  const Eigen::Vector3d middle(0, 0, 0);
  return outline_of(camera, camera.image_from_mill(middle), middle, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY())
      .radius;
}

void place_mill(FilmLens& lens, int width, int height, double radius_px, double u, double v, double crop) {
  lens.width = width;
  lens.height = height;
  lens.centre_u = (width - 1) / 2.0 + crop * (u - (width - 1) / 2.0);
  lens.centre_v = (height - 1) / 2.0 + crop * (v - (height - 1) / 2.0);
  lens.focal = radius_px * lens.position.norm();
  // The bending at the farthest corner is kept where it can be undone.
  const double du = std::max(lens.centre_u, width - lens.centre_u),
               dv = std::max(lens.centre_v, height - lens.centre_v);
  const double corner = (du * du + dv * dv) / (lens.focal * lens.focal);
  const double bending = std::abs(lens.k1) * corner + std::abs(lens.k2) * corner * corner;
  constexpr double kMostBending = 0.12;
  if (bending > kMostBending) {
    lens.k1 *= kMostBending / bending;
    lens.k2 *= kMostBending / bending;
  }
  // The camera is aimed until the mill stands where it should; Newton's way with a pinhole's derivative.
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector2d off = make_pinhole(lens).image_from_mill(Eigen::Vector3d::Zero()) - Eigen::Vector2d(u, v);
    const double c = std::cos(lens.roll), s = std::sin(lens.roll);
    lens.yaw += (c * off.x() - s * off.y()) / lens.focal;
    lens.pitch -= (s * off.x() + c * off.y()) / lens.focal;
  }
}

}  // namespace tumble::render
