#include "render/mill_view.h"

#include <cmath>
#include <numeric>
#include <vector>

#include "core/units.h"

namespace tumble::render {
namespace {

constexpr double kLightAngle = 125.0 * kPi / 180.0;  // where the light comes from, in the picture

// Turned steel under one light: bright towards it, with the fainter sheen that a lathe leaves opposite.
Rgba steel(double brightness, double angle) {
  const double sheen = 0.62 + 0.28 * std::cos(angle - kLightAngle) + 0.10 * std::cos(2 * (angle - kLightAngle));
  return scaled(ink::kSteel, brightness * sheen);
}

std::function<Rgba(double)> turned(double brightness) {
  return [brightness](double angle) { return steel(brightness, angle); };
}

void draw_rim(Canvas& canvas, double radius) {
  const Vec2 centre(canvas.layout.camera.centre_u, canvas.layout.camera.centre_v);
  const double outer = radius * kRimShare, liner = radius * (1 + 0.22 * (kRimShare - 1));
  auto& m = canvas.meshes;
  m.ring(centre, radius, outer, 0, 2 * kPi, turned(0.44), turned(0.62));                        // shell plate
  m.ring(centre, outer - canvas.px(2.0), outer, 0, 2 * kPi, turned(1.0), turned(1.0));          // its lit edge
  m.ring(centre, radius, liner, 0, 2 * kPi, turned(0.85), turned(0.72));                        // liner
  m.ring(centre, liner, liner + canvas.stroke(1.1), 0, 2 * kPi, with_alpha({8, 10, 13}, 0.8));  // its joint
}

// A lifter's faces catch the light as they turn: that, not colour, makes them look solid.
void draw_lifter(Canvas& canvas, const MillShape& shape, double angle) {
  const Camera& camera = canvas.layout.camera;
  const double c = std::cos(angle), s = std::sin(angle);
  std::vector<Vec2> corners;
  std::vector<Rgba> colours;
  for (const auto& p : shape.lifter) {
    const Vec2 q(c * p.x() - s * p.y(), s * p.x() + c * p.y());
    corners.push_back(camera.image_from_mill(q.x(), q.y()));
    const bool tip = p.norm() < 0.5 * (shape.radius + shape.tip_radius);
    colours.push_back(scaled(ink::kSteel, tip ? 0.80 : 0.55));
  }
  canvas.meshes.convex(corners, colours);
  const Vec2 light(std::cos(kLightAngle), -std::sin(kLightAngle));
  const Vec2 middle = std::accumulate(corners.begin(), corners.end(), Vec2(0, 0)) / static_cast<double>(corners.size());
  const double width = canvas.stroke(1.6);
  for (std::size_t i = 1; i < corners.size(); ++i) {  // edge 0 is the foot, inside the steel
    const Vec2& a = corners[i];
    const Vec2& b = corners[(i + 1) % corners.size()];
    Vec2 outward(-(b - a).y(), (b - a).x());
    outward.normalize();
    if (outward.dot(a - middle) < 0) outward = -outward;
    const Rgba edge = scaled({255, 255, 255}, 0.55 + 0.4 * outward.dot(light));
    canvas.meshes.line(a - outward * width / 2, b - outward * width / 2, width, with_alpha(edge, 0.85));
  }
}

// Bolts sit where lifters do; a mill without lifters gets a dozen, so that its turning can be seen.
void draw_bolts(Canvas& canvas, const MillShape& shape, double mill_angle) {
  const Camera& camera = canvas.layout.camera;
  const double on = shape.radius * (1 + 0.62 * (kRimShare - 1));
  const int lifters = shape.lifter_count;
  const int count = lifters == 0 ? 12 : lifters > 72 ? lifters / (lifters / 36) : lifters;
  double radius = canvas.px(5.2);
  radius = std::min(radius, 0.28 * 2 * kPi * on * camera.pixels_per_metre / count);
  for (int k = 0; k < count; ++k) {
    const double angle = mill_angle + 2 * kPi * k / count;
    const Vec2 centre = camera.image_from_mill(on * std::cos(angle), on * std::sin(angle));
    canvas.meshes.ring(centre, 0, radius * 1.35, 0, 2 * kPi, with_alpha({8, 10, 13}, 0.55));
    std::vector<Vec2> hexagon;
    for (int i = 0; i < 6; ++i) hexagon.push_back(centre + radius * camera.direction(angle + i * kPi / 3));
    canvas.meshes.convex(hexagon, scaled(ink::kSteel, 0.95));
    canvas.meshes.ring(centre, 0, radius * 0.42, 0, 2 * kPi, scaled(ink::kSteel, 0.45));
  }
}

}  // namespace

void draw_mill(Canvas& canvas, const MillShape& shape, double mill_angle) {
  const Camera& camera = canvas.layout.camera;
  const Vec2 centre(camera.centre_u, camera.centre_v);
  const double radius = shape.radius * camera.pixels_per_metre;
  canvas.meshes.ring(centre, 0, radius + 1, 0, 2 * kPi, ink::kMillInside);
  for (int k = 0; k < shape.lifter_count && !shape.lifter.empty(); ++k) {
    draw_lifter(canvas, shape, mill_angle + k * shape.pitch());
  }
  draw_rim(canvas, radius);
  draw_bolts(canvas, shape, mill_angle);
  canvas.meshes.flush();
}

}  // namespace tumble::render
