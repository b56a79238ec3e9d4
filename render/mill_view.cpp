#include "render/mill_view.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <vector>

#include "core/units.h"

namespace tumble::render {
namespace {

constexpr double kLightAngle = 125.0 * kPi / 180.0;         // where the light comes from, in the picture
constexpr double kLinerShare = 1 + 0.22 * (kRimShare - 1);  // outer radius of the liner / R
constexpr double kBoltShare = 1 + 0.62 * (kRimShare - 1);   // radius of the bolts' circle / R
constexpr Rgba kShadow{8, 10, 13};

// Turned steel under one light: bright towards it, with the fainter sheen that a lathe leaves opposite.
std::function<Rgba(double)> steel(double brightness) {
  return [brightness](double angle) {
    const double sheen = 0.62 + 0.28 * std::cos(angle - kLightAngle) + 0.10 * std::cos(2 * (angle - kLightAngle));
    return scaled(ink::kSteel, brightness * sheen);
  };
}

// A foot lies inside the shell's steel; it is drawn as far as the liner reaches, along its own face.
Eigen::Vector2d foot_on_liner(const Eigen::Vector2d& foot, const Eigen::Vector2d& tip, double liner) {
  if (foot.norm() <= liner) return foot;
  const Eigen::Vector2d d = foot - tip;
  const double a = d.squaredNorm(), b = tip.dot(d), c = tip.squaredNorm() - liner * liner;
  return tip + d * ((-b + std::sqrt(b * b - a * c)) / a);
}

// Lifter 0 as it is seen: its corners counter-clockwise, the first two at the foot.
std::vector<Eigen::Vector2d> visible_lifter(const MillShape& shape) {
  std::vector<Eigen::Vector2d> corners = shape.lifter;
  const double liner = shape.radius * kLinerShare;
  corners[0] = foot_on_liner(corners[0], corners.back(), liner);
  corners[1] = foot_on_liner(corners[1], corners[2], liner);
  return corners;
}

// A lifter's faces catch the light as they turn: that, not colour, makes them look solid.
void draw_lifter(Canvas& canvas, std::span<const Eigen::Vector2d> lifter, double angle) {
  const Camera& camera = canvas.layout.camera;
  const double c = std::cos(angle), s = std::sin(angle);
  std::vector<Vec2> corners;
  std::vector<Rgba> colours;
  for (std::size_t i = 0; i < lifter.size(); ++i) {
    const auto& p = lifter[i];
    corners.push_back(camera.image_from_mill(c * p.x() - s * p.y(), s * p.x() + c * p.y()));
    colours.push_back(scaled(ink::kSteel, i < 2 ? 0.55 : 0.80));
  }
  canvas.meshes.convex(corners, colours);
  const Vec2 light(std::cos(kLightAngle), -std::sin(kLightAngle));
  const Vec2 middle = std::accumulate(corners.begin(), corners.end(), Vec2(0, 0)) / static_cast<double>(corners.size());
  const double width = canvas.stroke(1.6);
  const auto draw_edge = [&](std::size_t i) {
    const Vec2& a = corners[i];
    const Vec2& b = corners[(i + 1) % corners.size()];
    Vec2 outward(-(b - a).y(), (b - a).x());
    outward.normalize();
    if (outward.dot(a - middle) < 0) outward = -outward;
    const Rgba edge = scaled({255, 255, 255}, 0.55 + 0.4 * outward.dot(light));
    canvas.meshes.line(a - outward * width / 2, b - outward * width / 2, width, with_alpha(edge, 0.85));
  };
  // The faces, then the tip across their ends; edge 0 is the foot, inside the steel.
  draw_edge(1);
  draw_edge(corners.size() - 1);
  for (std::size_t i = 2; i + 1 < corners.size(); ++i) draw_edge(i);
}

// Bolts sit where lifters do; a mill without lifters gets a dozen, so that its turning can be seen.
void draw_bolts(Canvas& canvas, const MillShape& shape, double mill_angle) {
  const Camera& camera = canvas.layout.camera;
  const double on = shape.radius * kBoltShare;
  const int lifters = shape.lifter_count;
  const int count = lifters == 0 ? 12 : lifters > 72 ? lifters / (lifters / 36) : lifters;
  const double radius = std::min(canvas.px(5.2), 0.28 * 2 * kPi * on * camera.pixels_per_metre / std::max(count, 1));
  for (int k = 0; k < count; ++k) {
    const double angle = mill_angle + 2 * kPi * k / count;
    const Vec2 centre = camera.image_from_mill(on * std::cos(angle), on * std::sin(angle));
    std::vector<Vec2> washer, head;
    for (int i = 0; i < 12; ++i) washer.push_back(centre + 1.4 * radius * camera.direction(angle + i * kPi / 6));
    for (int i = 0; i < 6; ++i) head.push_back(centre + radius * camera.direction(angle + i * kPi / 3));
    canvas.meshes.convex(washer, with_alpha(kShadow, 0.6));
    canvas.meshes.convex(head, scaled(ink::kSteel, 0.9));
  }
}

}  // namespace

void draw_shell(Canvas& canvas, const MillShape& shape) {
  const Camera& camera = canvas.layout.camera;
  const Vec2 centre(camera.centre_u, camera.centre_v);
  const double radius = shape.radius * camera.pixels_per_metre;
  const double outer = radius * kRimShare, liner = radius * kLinerShare;
  auto& m = canvas.meshes;
  m.ring(centre, 0, radius + 1, 0, 2 * kPi, ink::kMillInside);
  m.ring(centre, radius, outer, 0, 2 * kPi, steel(0.44), steel(0.62));                      // shell plate
  m.ring(centre, outer - canvas.px(2.0), outer, 0, 2 * kPi, steel(1.0), steel(1.0));        // its lit edge
  m.ring(centre, radius, liner, 0, 2 * kPi, steel(0.85), steel(0.72));                      // liner
  m.ring(centre, liner, liner + canvas.stroke(1.1), 0, 2 * kPi, with_alpha(kShadow, 0.8));  // its joint
}

void draw_lifters(Canvas& canvas, const MillShape& shape, double mill_angle) {
  if (!shape.lifter.empty()) {
    const auto lifter = visible_lifter(shape);
    for (int k = 0; k < shape.lifter_count; ++k) draw_lifter(canvas, lifter, mill_angle + k * shape.pitch());
  }
  draw_bolts(canvas, shape, mill_angle);
}

}  // namespace tumble::render
