#include "analysis/ring_occupancy.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/angle.h"

namespace tumble::analysis {
namespace {

struct Chord {  // what one disc covers of one ray
  int ray = 0;
  double near = 0, far = 0;
};

constexpr int kRays = 360 * kRaysPerBin;
constexpr double kRayStep = 2.0 * kPi / kRays;

struct RayDirections {
  std::array<double, kRays> c{}, s{};
  RayDirections() {
    for (std::size_t k = 0; k < kRays; ++k) {
      c[k] = std::cos((static_cast<double>(k) + 0.5) * kRayStep);
      s[k] = std::sin((static_cast<double>(k) + 0.5) * kRayStep);
    }
  }
};

}  // namespace

RingProfile ring_occupancy(std::span<const Disc> discs, const Ring& ring) {
  static const RayDirections rays;
  std::vector<Chord> chords;
  for (const Disc& d : discs) {
    const double rho = std::hypot(d.x, d.y);
    if (rho + d.radius <= ring.inner || rho - d.radius >= ring.outer) continue;
    const double middle = std::atan2(d.y, d.x);
    const double half = rho > d.radius ? std::asin(d.radius / rho) : kPi;
    const int first = static_cast<int>(std::ceil((middle - half) / kRayStep - 0.5));
    const int last = static_cast<int>(std::floor((middle + half) / kRayStep - 0.5));
    for (int k = first; k <= std::min(last, first + kRays - 1); ++k) {
      const int ray = ((k % kRays) + kRays) % kRays;
      const double c = rays.c[static_cast<std::size_t>(ray)], si = rays.s[static_cast<std::size_t>(ray)];
      const double across = d.y * c - d.x * si, reach = d.radius * d.radius - across * across;
      if (reach <= 0) continue;
      const double along = d.x * c + d.y * si, s = std::sqrt(reach);
      const double near = std::max(along - s, ring.inner), far = std::min(along + s, ring.outer);
      if (far > near) chords.push_back({ray, near, far});
    }
  }
  std::sort(chords.begin(), chords.end(),
            [](const Chord& a, const Chord& b) { return a.ray != b.ray ? a.ray < b.ray : a.near < b.near; });

  RingProfile profile{};
  const double whole = (ring.outer * ring.outer - ring.inner * ring.inner) * kRaysPerBin;
  int ray = -1;
  double covered_to = 0;
  for (const Chord& c : chords) {  // union along each ray: count only what lies beyond what was covered so far
    if (c.ray != ray) {
      ray = c.ray;
      covered_to = ring.inner;
    }
    const double from = std::max(c.near, covered_to);
    if (c.far <= from) continue;
    profile[static_cast<std::size_t>(ray / kRaysPerBin)] += (c.far * c.far - from * from) / whole;
    covered_to = c.far;
  }
  return profile;
}

}  // namespace tumble::analysis
