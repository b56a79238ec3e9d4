#include "core/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/random.h"

namespace tumble {
namespace {

// AR(1): x' = a x + noise has a known variance of the mean, s2 / n / (1 - a)^2 for unit noise.
std::vector<double> correlated(double a, std::size_t n, Random& random) {
  std::vector<double> x(n);
  double state = 0;
  for (std::size_t i = 0; i < n + 200; ++i) {
    double noise = -6;
    for (int k = 0; k < 12; ++k) noise += random.uniform();
    state = a * state + noise;
    if (i >= 200) x[i - 200] = state;
  }
  return x;
}

TEST(Statistics, StandardErrorAllowsForCorrelation) {
  Random random(7);
  for (const double a : {0.0, 0.9}) {
    const std::size_t n = 4000;
    const double exact = 1 / std::sqrt(double(n)) / (1 - a);
    double sum = 0;
    for (int k = 0; k < 40; ++k) sum += mean_of_series(correlated(a, n, random)).se / 40;
    EXPECT_NEAR(sum / exact, 1, 0.08) << a;
  }
}

TEST(Statistics, TruthLiesWithinTwoErrorsInNineteenCasesOfTwenty) {
  Random random(11);
  int within = 0;
  for (int k = 0; k < 400; ++k) {
    const Estimate e = mean_of_series(correlated(0.8, 1000, random));
    within += std::abs(e.value) < 2 * e.se;
  }
  EXPECT_GT(within, 400 * 0.91);
  EXPECT_LT(within, 400 * 0.985);
}

TEST(Statistics, DirectionsAverageAcrossZero) {
  const std::vector<double> d = {350, 10, 352, 8, kNotGiven, 358, 2};
  EXPECT_NEAR(mean_direction(d).value, 0, 1e-9);
}

TEST(Statistics, DriftIsSeenAndNoiseIsNot) {
  Random random(3);
  std::vector<double> x = correlated(0.8, 2000, random);
  EXPECT_LT(std::abs(drift_z(x)), 3);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] += 2.0 * double(i) / double(x.size());
  EXPECT_GT(drift_z(x), 3);
}

TEST(Statistics, TooShortASeriesHasNoError) {
  EXPECT_TRUE(std::isnan(mean_of_series(std::vector<double>{1, 2, 3}).se));
  EXPECT_TRUE(std::isnan(mean_of_series({}).value));
  EXPECT_EQ(mean_of_series(std::vector<double>(50, 2.5)).se, 0);
}

}  // namespace
}  // namespace tumble
