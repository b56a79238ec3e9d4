#include "diagnose/chance.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace tumble::diagnose {
namespace {

TEST(Chance, StudentsTAsTheNormalDeviateOfTheSameChance) {
  // Two-sided quantiles of Student's t (Abramowitz & Stegun, table 26.10): 95 % and 99.9 %.
  EXPECT_NEAR(normal_z(2.131, 15), 1.960, 0.01);
  EXPECT_NEAR(normal_z(4.073, 15), 3.291, 0.02);
  EXPECT_NEAR(normal_z(-3.646, 30), -3.291, 0.01);
  EXPECT_NEAR(two_sided_chance(1.960), 0.05, 1e-4);
}

TEST(Chance, WelchsFreedomLiesBetweenThatOfOneAndOfBoth) {
  EXPECT_NEAR(welch_freedom(1, 0, {}), kBatchFreedom, 1e-12);
  EXPECT_NEAR(welch_freedom(1, 1, {}), 2 * kBatchFreedom, 1e-12);
  EXPECT_NEAR(welch_freedom(1, 0.001, {batch_freedom(4), 15}), 3, 1e-3) << "four stills know little of their error";
}

TEST(Chance, BenjaminiAndHochbergsOwnExample) {
  // Their paper's section 4.1: at 5 % the first four of fifteen.
  const std::vector<double> p{0.0001, 0.0004, 0.0019, 0.0095, 0.0201, 0.0278, 0.0298, 0.0344,
                              0.0459, 0.3240, 0.4262, 0.5719, 0.6528, 0.7590, 1.0000};
  const std::vector<char> named = beyond_chance(p, 0.05);
  for (std::size_t i = 0; i < p.size(); ++i) EXPECT_EQ(named[i] != 0, i < 4) << i;
}

TEST(Chance, WhereNothingDiffersAnythingIsNamedAsRarelyAsAsked) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> chance(0, 1);
  int alarms = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    std::vector<double> p(100, std::nan(""));
    for (std::size_t i = 0; i < 80; ++i) p[i] = chance(random);
    const auto named = beyond_chance(p, 0.05);
    alarms += std::count(named.begin(), named.end(), 1) > 0;
  }
  EXPECT_NEAR(alarms, 100, 30);  // 5 %, three standard errors
}

}  // namespace
}  // namespace tumble::diagnose
