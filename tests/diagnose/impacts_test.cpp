#include "diagnose/impacts.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::diagnose {
namespace {

ImpactSpectrum spectrum(double rate, double rarest) {
  ImpactSpectrum s;
  s.edges_J = {1e-4, 1e-3, 1e-2, 1e-1};
  s.ball_ball = {rate, rate, rarest};
  s.ball_wall = {rate, 0, 0};
  return s;
}

TEST(Impacts, ErrorsAreThoseOfCountsAndShrinkWithTime) {
  const auto once = compare_impacts(spectrum(100, 0.1), 10, spectrum(120, 0.1), 10);
  const auto longer = compare_impacts(spectrum(100, 0.1), 40, spectrum(120, 0.1), 40);
  ASSERT_EQ(once.size(), 2u);
  EXPECT_NEAR(once[0].x[0], std::sqrt(1e-7), 1e-12);
  EXPECT_NEAR(once[0].a_se[0], std::sqrt(2 * 100 / 10.0), 1e-12);
  EXPECT_NEAR(longer[0].z[0], 2 * once[0].z[0], 1e-9);
}

TEST(Impacts, TooFewToKnowTheirErrorAreShownButNotJudged) {
  const auto found = compare_impacts(spectrum(100, 0.1), 10, spectrum(100, 0.9), 10);
  ASSERT_EQ(found[0].x.size(), 3u);
  EXPECT_TRUE(std::isnan(found[0].z[2]));
  EXPECT_EQ(found[0].compared, 2);
  EXPECT_EQ(found[1].x.size(), 1u) << "bins without impacts in both are left out";
}

TEST(Impacts, OtherBinsAreNotCompared) {
  ImpactSpectrum other = spectrum(100, 1);
  other.edges_J[1] *= 2;
  EXPECT_TRUE(compare_impacts(spectrum(100, 1), 10, other, 10).empty());
  EXPECT_TRUE(compare_impacts({}, 10, {}, 10).empty());
}

}  // namespace
}  // namespace tumble::diagnose
