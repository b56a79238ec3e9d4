#include "sim/shell.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/units.h"

namespace tumble::sim {

Shell make_shell(const MillShape& shape) {
  Shell shell;
  shell.radius = shape.radius;
  shell.tip_radius = shape.lifter.empty() ? shape.radius : shape.tip_radius;
  if (shape.lifter.empty()) return shell;
  shell.lifter_count = shape.lifter_count;
  double low = shape.radius;
  double high = 0;
  for (std::size_t i = 0; i < shape.lifter.size(); ++i) {
    const Eigen::Vector2d a = shape.lifter[i], b = shape.lifter[(i + 1) % shape.lifter.size()];
    const Eigen::Vector2d t = (b - a).normalized();
    shell.faces.push_back({a.x(), a.y(), t.x(), t.y(), t.y(), -t.x(), (b - a).norm()});
    low = std::min(low, a.x());
    high = std::max(high, a.x());
  }
  shell.lifter_centre = (low + high) / 2;
  for (const Eigen::Vector2d& p : shape.lifter)
    shell.lifter_reach = std::max(shell.lifter_reach, std::hypot(p.x() - shell.lifter_centre, p.y()));
  for (int k = 0; k < shell.lifter_count; ++k) {
    shell.lifter_cos.push_back(std::cos(k * shape.pitch()));
    shell.lifter_sin.push_back(std::sin(k * shape.pitch()));
  }
  return shell;
}

Nearest nearest_on_lifter(const Shell& shell, double x, double y) {
  // The face from which the point stands out farthest holds the nearest point of a convex polygon, or one of its ends.
  const LifterFace* face = nullptr;
  double out = -std::numeric_limits<double>::infinity();
  for (const LifterFace& f : shell.faces) {
    const double d = (x - f.x) * f.nx + (y - f.y) * f.ny;
    if (d > out) {
      out = d;
      face = &f;
    }
  }
  if (out <= 0) {
    // A centre inside is pushed out through the nearest face that is not in the steel.
    out = -std::numeric_limits<double>::infinity();
    for (const LifterFace& f : shell.faces) {
      const double d = (x - f.x) * f.nx + (y - f.y) * f.ny;
      if (&f != &shell.faces.front() && d > out) {
        out = d;
        face = &f;
      }
    }
    return {out, -face->nx, -face->ny};
  }
  const double along = (x - face->x) * face->tx + (y - face->y) * face->ty;
  if (along >= 0 && along <= face->length) return {out, -face->nx, -face->ny};
  const double end = along < 0 ? 0 : face->length;
  const double dx = face->x + end * face->tx - x, dy = face->y + end * face->ty - y;
  const double d = std::sqrt(dx * dx + dy * dy);
  return {d, dx / d, dy / d};
}

ShellPose pose_of(double mill_angle) { return {std::cos(mill_angle), std::sin(mill_angle)}; }

WallPoint nearest_on_wall(const Shell& shell, const ShellPose& pose, int feature, double x, double y) {
  if (feature == 0) {
    const double rho = std::sqrt(x * x + y * y);
    return {shell.radius - rho, x / rho, y / rho, Face::kPlate};
  }
  const Direction l = lifter_direction(shell, pose, feature - 1);
  const Nearest near = nearest_on_lifter(shell, x * l.cos + y * l.sin, y * l.cos - x * l.sin);
  return {near.distance, near.nx * l.cos - near.ny * l.sin, near.nx * l.sin + near.ny * l.cos, Face::kTop};
}

void features_near(const Shell& shell, double mill_angle, double x, double y, double reach, std::vector<int>& out) {
  const double rho = std::hypot(x, y);
  if (rho + reach <= shell.tip_radius) return;
  if (rho + reach > shell.radius) out.push_back(0);
  if (shell.lifter_count == 0) return;

  const auto first = static_cast<std::ptrdiff_t>(out.size());
  const ShellPose pose = pose_of(mill_angle);
  const auto add_if_near = [&](int k) {
    const Direction d = lifter_direction(shell, pose, k);
    if (nearest_on_lifter(shell, x * d.cos + y * d.sin, y * d.cos - x * d.sin).distance < reach) out.push_back(k + 1);
  };
  // Only lifters whose bounding circle can be in reach: |angle| <= asin(span / rho).
  const int n = shell.lifter_count;
  const double span = reach + shell.lifter_reach;
  const double pitch = 2 * kPi / n;
  const int each_side = span < rho ? static_cast<int>(std::asin(span / rho) / pitch) + 1 : n;
  if (2 * each_side + 1 >= n) {
    for (int k = 0; k < n; ++k) add_if_near(k);
    return;
  }
  const double turned = (std::atan2(y, x) - mill_angle) / pitch;
  const auto nearest = static_cast<std::int64_t>(std::floor(turned + 0.5));
  for (std::int64_t k = nearest - each_side; k <= nearest + each_side; ++k)
    add_if_near(static_cast<int>(((k % n) + n) % n));
  std::sort(out.begin() + first, out.end());
}

}  // namespace tumble::sim
