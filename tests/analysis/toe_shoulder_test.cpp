#include "analysis/toe_shoulder.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "core/random.h"

namespace tumble::analysis {
namespace {

// A charge from `toe` over 360 to `shoulder`, its edges ramps of `width` degrees centred there.
RingProfile trapezoid(double toe, double shoulder, double width, double height = 0.8) {
  RingProfile p;
  const double half = 0.5 * wrap_360(shoulder - toe), middle = toe + half;
  for (std::size_t i = 0; i < 360; ++i) {
    const double inside = half - std::abs(wrap_180(static_cast<double>(i) + 0.5 - middle));
    p[i] = height * std::clamp(inside / width + 0.5, 0.0, 1.0);
  }
  return p;
}

TEST(ToeShoulder, LiesWhereOccupancyFallsBelowItsShareOfThePlateau) {
  const ChargeEdges e = find_edges(smooth(trapezoid(230.3, 40.7, 12.0), 3));
  EXPECT_NEAR(e.plateau, 0.8, 1e-12);
  EXPECT_NEAR(e.middle, 315.5, 0.6);  // of whole bins
  // On a straight ramp a symmetric box changes nothing and interpolation is exact.
  EXPECT_NEAR(e.toe[kHalf], 230.3, 1e-9);
  EXPECT_NEAR(e.shoulder[kHalf], 40.7, 1e-9);
  EXPECT_NEAR(e.toe[kBulk], 230.3 + 3.0, 1e-9);
  EXPECT_NEAR(e.shoulder[kBulk], 40.7 - 3.0, 1e-9);
  EXPECT_NEAR(e.toe[kOuter], 230.3 - 3.0, 1e-9);
  EXPECT_NEAR(e.shoulder[kOuter], 40.7 + 3.0, 1e-9);
}

TEST(ToeShoulder, PlateauIsThe90thPercentile) {
  RingProfile p{};
  for (std::size_t i = 0; i < 360; ++i) p[i] = static_cast<double>(i);
  EXPECT_NEAR(find_edges(p).plateau, 0.9 * 359, 1e-9);
}

TEST(ToeShoulder, IsNotReadOffAHiddenStretch) {
  RingProfile p = trapezoid(230.0, 40.0, 12.0);
  for (std::size_t i = 220; i < 236; ++i) p[i] = kNotGiven;
  const ChargeEdges e = find_edges(smooth(p, 3));
  EXPECT_TRUE(std::isnan(e.toe[kHalf]));
  EXPECT_NEAR(e.shoulder[kHalf], 40.0, 1.0);
}

TEST(ToeShoulder, HasNoEdgesWithoutChargeOrWithChargeAllRound) {
  EXPECT_TRUE(std::isnan(find_edges(RingProfile{}).toe[kHalf]));
  RingProfile full;
  full.fill(0.7);
  EXPECT_TRUE(std::isnan(find_edges(full).shoulder[kHalf]));
}

// The edge swings slowly (exponentially correlated) by a known amount: the error of the mean must know the correlation.
TEST(ToeShoulder, ErrorAllowsForCorrelationInTime) {
  constexpr int kFrames = 2000, kRuns = 12;
  constexpr double kMemory = 20.0, kSwing = 3.0;  // frames, degrees
  const double keep = std::exp(-1.0 / kMemory);
  // Variance of the mean of n AR(1) samples: swing^2 / n (1 + keep) / (1 - keep).
  const double expected = kSwing * std::sqrt((1 + keep) / (1 - keep) / kFrames);
  Random random(7);
  double sum = 0, ring = 0;
  for (int run = 0; run < kRuns; ++run) {
    EdgeStatistics statistics(1.0);
    double x = 0;
    for (int f = 0; f < kFrames; ++f) {
      double normal = -6;
      for (int i = 0; i < 12; ++i) normal += random.uniform();
      x = keep * x + std::sqrt(1 - keep * keep) * normal;
      statistics.add(trapezoid(230 + kSwing * x, 40, 10));
    }
    const EdgeEstimates e = statistics.estimate();
    EXPECT_NEAR(wrap_180(e.toe[kHalf].value - 230.0), 0.0, 4 * expected);
    EXPECT_LT(e.shoulder[kHalf].se, 0.05);
    sum += e.toe[kHalf].se;
    ring += e.occupancy_se[230];
    EXPECT_EQ(e.occupancy_se[100], 0) << "never covered";
  }
  EXPECT_NEAR(sum / kRuns, expected, 0.3 * expected);  // a single film knows its own error to about a third
  // The ramp loses 0.08 of occupancy a degree, and clips one swing in ten.
  EXPECT_NEAR(ring / kRuns, 0.08 * expected, 0.3 * 0.08 * expected);
}

TEST(ToeShoulder, PerFrameValuesAreMeansOverOneLifterPassage) {
  EdgeStatistics statistics(5.0);
  for (int f = 0; f < 20; ++f) statistics.add(trapezoid(f < 10 ? 230 : 240, 40, 24));
  const auto frames = statistics.finish_frames();
  ASSERT_EQ(frames.size(), 20u);
  EXPECT_NEAR(frames[4].toe[kHalf], 230, 0.1);
  EXPECT_NEAR(frames[15].toe[kHalf], 240, 0.1);
  EXPECT_NEAR(frames[9].toe[kHalf], 234, 0.2);   // three frames at 230, two at 240
  EXPECT_NEAR(frames[10].toe[kHalf], 236, 0.2);  // two and three
}

}  // namespace
}  // namespace tumble::analysis
