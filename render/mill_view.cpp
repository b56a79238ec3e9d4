#include "render/mill_view.h"

#include <algorithm>
#include <array>
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
std::function<Rgba(double)> steel(const Theme& theme, double brightness) {
  return [&theme, brightness](double angle) {
    const double sheen = 0.62 + 0.28 * std::cos(angle - kLightAngle) + 0.10 * std::cos(2 * (angle - kLightAngle));
    return scaled(theme.steel, brightness * sheen);
  };
}

double area_of(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

bool is_convex(const std::vector<Vec2>& p) {
  for (std::size_t i = 0; i < p.size(); ++i)
    if (area_of(p[i], p[(i + 1) % p.size()], p[(i + 2) % p.size()]) < 0) return false;
  return true;
}

// Triangles of a simple polygon, counter-clockwise: ears are cut off until none is left.
std::vector<std::array<std::size_t, 3>> triangles_of(const std::vector<Vec2>& p) {
  std::vector<std::size_t> left(p.size());
  std::iota(left.begin(), left.end(), std::size_t{0});
  std::vector<std::array<std::size_t, 3>> triangles;
  for (std::size_t i = 0, looked = 0; left.size() > 2 && looked < left.size();) {
    const std::size_t n = left.size(), a = left[(i + n - 1) % n], b = left[i % n], c = left[(i + 1) % n];
    bool ear = area_of(p[a], p[b], p[c]) > 0;
    for (const std::size_t k : left)
      ear = ear && (k == a || k == b || k == c || area_of(p[a], p[b], p[k]) < 0 || area_of(p[b], p[c], p[k]) < 0 ||
                    area_of(p[c], p[a], p[k]) < 0);
    if (ear) {
      triangles.push_back({a, b, c});
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(i % n));
      looked = 0;
    } else {
      ++looked;
    }
    i = (i + (ear ? 0 : 1)) % left.size();
  }
  return triangles;
}

// A lifter's outline as it is seen, from the trailing to the leading foot. Feet lie inside the shell's steel; they are
// drawn as far as the liner reaches.
std::vector<Vec2> visible_outline(const LifterSection& section, double liner, double pixel) {
  return thinned(clipped(section, liner), 0.1 * pixel);
}

// A lifter's faces catch the light as they turn: that, not colour, makes them look solid.
void draw_lifter(Canvas& canvas, const LifterSection& section, double liner, double angle) {
  const Camera& camera = canvas.layout.camera;
  const std::vector<Vec2> chain = visible_outline(section, liner, 1 / camera.pixels_per_metre);
  const double c = std::cos(angle), s = std::sin(angle);
  const auto seen = [&](const Vec2& p) -> Vec2 {
    return camera.image_from_mill(c * p.x() - s * p.y(), s * p.x() + c * p.y());
  };
  const Rgba foot = scaled(canvas.theme.steel, 0.55), tip = scaled(canvas.theme.steel, 0.80);

  // Counter-clockwise, feet first.
  std::vector<Vec2> body{chain.front()};
  body.insert(body.end(), chain.rbegin(), chain.rend() - 1);
  std::vector<Vec2> corners;
  std::vector<Rgba> colours;
  for (std::size_t i = 0; i < body.size(); ++i) {
    corners.push_back(seen(body[i]));
    colours.push_back(i < 2 ? foot : tip);
  }
  if (section.smooth) {  // a wave: strips down to the liner, which may go a long way round
    for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
      const Vec2 a = seen(chain[i]), b = seen(chain[i + 1]);
      const Vec2 under_a = seen(chain[i] * liner / chain[i].norm());
      const Vec2 under_b = seen(chain[i + 1] * liner / chain[i + 1].norm());
      canvas.meshes.triangle(a, b, under_b, tip, tip, foot);
      canvas.meshes.triangle(a, under_b, under_a, tip, foot, foot);
    }
  } else if (is_convex(body)) {
    canvas.meshes.convex(corners, colours);
  } else {
    for (const auto& [i, j, k] : triangles_of(body))
      canvas.meshes.triangle(corners[i], corners[j], corners[k], colours[i], colours[j], colours[k]);
  }

  const Vec2 light(std::cos(kLightAngle), -std::sin(kLightAngle));
  const double width = canvas.stroke(1.6);
  // The faces, then what lies across their ends.
  const auto draw_edge = [&](std::size_t i) {
    const Vec2 a = seen(chain[i]), b = seen(chain[i + 1]);
    const Vec2 d = chain[i + 1] - chain[i];
    const Vec2 outward = (seen(chain[i] + Vec2(-d.y(), d.x())) - a).normalized();
    const Rgba edge = scaled({255, 255, 255}, 0.55 + 0.4 * outward.dot(light));
    canvas.meshes.line(a - outward * width / 2, b - outward * width / 2, width, with_alpha(edge, 0.85));
  };
  draw_edge(chain.size() - 2);
  draw_edge(0);
  for (std::size_t i = chain.size() - 3; i >= 1 && i < chain.size(); --i) draw_edge(i);
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
    canvas.meshes.convex(head, scaled(canvas.theme.steel, 0.9));
  }
}

}  // namespace

void draw_shell(Canvas& canvas, const MillShape& shape) {
  const Camera& camera = canvas.layout.camera;
  const Vec2 centre = camera.axis();
  const double radius = shape.radius * camera.pixels_per_metre;
  const double outer = radius * kRimShare, liner = radius * kLinerShare;
  auto& m = canvas.meshes;
  const auto plate = [&](double brightness) { return steel(canvas.theme, canvas.theme.plate_brightness * brightness); };
  m.ring(centre, 0, radius + 1, 0, 2 * kPi, canvas.theme.mill_inside);
  m.ring(centre, radius, outer, 0, 2 * kPi, plate(0.44), plate(0.62));  // shell plate
  m.ring(centre, outer - canvas.px(2.0), outer, 0, 2 * kPi, steel(canvas.theme, 1.0),
         steel(canvas.theme, 1.0));                                                                 // its lit edge
  m.ring(centre, radius, liner, 0, 2 * kPi, steel(canvas.theme, 0.85), steel(canvas.theme, 0.72));  // liner
  m.ring(centre, liner, liner + canvas.stroke(1.1), 0, 2 * kPi, with_alpha(kShadow, 0.8));          // its joint
}

void draw_lifters(Canvas& canvas, const MillShape& shape, double mill_angle) {
  for (std::size_t k = 0; k < shape.section_of.size(); ++k) {
    const int section = shape.section_of[k];
    if (section < 0) continue;
    draw_lifter(canvas, shape.sections[static_cast<std::size_t>(section)], shape.radius * kLinerShare,
                mill_angle + static_cast<double>(k) * shape.pitch());
  }
  draw_bolts(canvas, shape, mill_angle);
}

}  // namespace tumble::render
