#include "analysis/ring_occupancy.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <vector>

#include "core/units.h"

namespace tumble::analysis {
namespace {

double covered_area(const RingProfile& p, const Ring& ring) {
  return std::accumulate(p.begin(), p.end(), 0.0) * kPi * (ring.outer * ring.outer - ring.inner * ring.inner) / 360.0;
}

TEST(RingOccupancy, OfADiscInsideTheRingIsItsArea) {
  const Ring ring{0.20, 0.25};
  const std::vector<Disc> discs = {{0.225 * std::cos(1.0), 0.225 * std::sin(1.0), 0.012}};
  const RingProfile p = ring_occupancy(discs, ring);
  EXPECT_NEAR(covered_area(p, ring), kPi * 0.012 * 0.012, 5e-3 * kPi * 0.012 * 0.012);  // midpoint rule, 30 rays
  EXPECT_GT(p[57], 0.4);                                                                // 1 rad = 57.3 degrees
  EXPECT_EQ(p[237], 0.0);
}

TEST(RingOccupancy, CountsWhatDiscsShareOnlyOnce) {
  const Ring ring{0.20, 0.30};
  const double r = 0.02, gap = 0.025;  // two discs side by side along x, closed form of their lens
  const std::vector<Disc> discs = {{0.24, 0, r}, {0.24 + gap, 0, r}};
  const double lens = 2 * r * r * std::acos(gap / (2 * r)) - 0.5 * gap * std::sqrt(4 * r * r - gap * gap);
  const double expected = 2 * kPi * r * r - lens;
  EXPECT_NEAR(covered_area(ring_occupancy(discs, ring), ring), expected, 5e-3 * expected);
}

TEST(RingOccupancy, CutsAtBothRadii) {
  const double r = 0.03, at = 0.25;  // a disc on the outer edge: lens of two circles
  const Ring ring{0.1, at};
  const double R = at;
  const double d = at;
  const double lens = r * r * std::acos((d * d + r * r - R * R) / (2 * d * r)) +
                      R * R * std::acos((d * d + R * R - r * r) / (2 * d * R)) -
                      0.5 * std::sqrt((-d + r + R) * (d + r - R) * (d - r + R) * (d + r + R));
  EXPECT_NEAR(covered_area(ring_occupancy(std::vector<Disc>{{0, -at, r}}, ring), ring), lens, 5e-3 * lens);
  EXPECT_EQ(covered_area(ring_occupancy(std::vector<Disc>{{0, -at - r, 0.99 * r}}, ring), ring), 0.0);
}

TEST(RingOccupancy, TurnsWithTheDiscs) {
  const Ring ring{0.20, 0.25};
  std::vector<Disc> discs, turned;
  for (int k = 0; k < 20; ++k) {
    const double a = 0.11 * k, rho = 0.19 + 0.003 * k;
    discs.push_back({rho * std::cos(a), rho * std::sin(a), 0.012});
    turned.push_back({rho * std::cos(a + kPi / 2), rho * std::sin(a + kPi / 2), 0.012});
  }
  const RingProfile p = ring_occupancy(discs, ring), q = ring_occupancy(turned, ring);
  for (std::size_t i = 0; i < 360; ++i) EXPECT_NEAR(p[i], q[(i + 90) % 360], 1e-9);
}

}  // namespace
}  // namespace tumble::analysis
