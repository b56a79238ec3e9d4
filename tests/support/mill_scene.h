#pragma once
#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/charge_motion.h"
#include "core/frame.h"
#include "core/image.h"
#include "core/random.h"
#include "core/units.h"
#include "tests/support/mills.h"

// A mill at one moment, for tests of pictures, and what tells two pictures apart.
namespace tumble {

struct Scene {
  RunSetup setup;
  Frame frame;
};

// Balls strewn over the inside; they may overlap, as the renderer does not mind.
inline Scene scene_of(const Config& config, int count, std::uint64_t seed = 1) {
  Scene scene;
  Random random(seed);
  const double reach = 0.8 * config.mill.diameter / 2;
  scene.setup.config = config;
  scene.setup.mill_speed = rad_s_from_rpm(speed_rpm(config.mill));
  for (int i = 0; i < count; ++i) {
    const double r = reach * std::sqrt(random.uniform()), a = random.uniform(0, 2 * kPi);
    scene.setup.balls.radius.push_back(config.charge.balls[static_cast<std::size_t>(i) % 3].radius);
    scene.setup.balls.mass.push_back(0.1);
    scene.frame.x.push_back(r * std::cos(a));
    scene.frame.y.push_back(r * std::sin(a));
    scene.frame.vx.push_back(random.uniform(-2, 2));
    scene.frame.vy.push_back(random.uniform(-2, 2));
    scene.frame.angle.push_back(random.uniform(0, 6));
    scene.frame.spin.push_back(random.uniform(-50, 50));
  }
  scene.frame.mill_angle = 0.3;
  scene.frame.time = 1.5;
  return scene;
}

// A mean motion whose parts lie far from one another: a charge that turns about (0.06, -0.1) m.
inline ChargeMotion mean_motion() {
  ChargeMotion m;
  m.mill_radius = 0.2725;
  m.field.n = 40;
  m.field.cell = 2 * m.mill_radius / m.field.n;
  for (int j = 0; j < m.field.n; ++j) {
    for (int i = 0; i < m.field.n; ++i) {
      const double x = (i - 19.5) * m.field.cell - 0.06, y = (j - 19.5) * m.field.cell + 0.1;
      const bool inside = std::hypot(x, y) < 0.11;
      m.field.occupancy.push_back(inside ? 0.7 : 0);
      m.field.vx.push_back(inside ? -8 * y : NAN);
      m.field.vy.push_back(inside ? 8 * x : NAN);
    }
  }
  for (int k = 0; k <= 20; ++k) m.surface.push_back({-0.1 + 0.01 * k, 0.05});
  m.head.value = 0.15;
  m.centre_of_circulation_x.value = 0.06;
  m.centre_of_circulation_y.value = -0.1;
  m.departure_deg.value = 70;
  m.impact_toe_deg.value = 200;
  return m;
}

inline int difference(const Image& a, const Image& b, int v, int u) {
  int largest = 0;
  for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(a.row(v)[4 * u + c] - b.row(v)[4 * u + c]));
  return largest;
}

inline int largest_difference(const Image& a, const Image& b, int left = 0) {
  int largest = 0;
  for (int v = 0; v < a.height; ++v) {
    for (int u = left; u < a.width; ++u) largest = std::max(largest, difference(a, b, v, u));
  }
  return largest;
}

struct Blob {
  double u = 0, v = 0, area = 0;
};

// Where two pictures differ: the mean of the places, not of the brightness.
inline Blob changed(const Image& a, const Image& b, int threshold = 4) {
  Blob blob;
  for (int v = 0; v < a.height; ++v) {
    for (int u = 0; u < a.width; ++u) {
      if (difference(a, b, v, u) > threshold) {
        blob.area += 1;
        blob.u += u;
        blob.v += v;
      }
    }
  }
  blob.u /= blob.area;
  blob.v /= blob.area;
  return blob;
}

}  // namespace tumble
