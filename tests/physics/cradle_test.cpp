#include <gtest/gtest.h>

#include "tests/support/balls.h"

namespace tumble::sim {
namespace {

// Speeds of equal balls in a row after the first has hit the rest, 0.2 mm apart so that impacts follow each other.
std::vector<double> after_the_impact(std::size_t balls, double e) {
  const LinearSpringDashpot law = springs(e);
  const double dt = contact_time(law, 0.03) / 100;
  std::vector<Ball> row;
  for (std::size_t k = 0; k < balls; ++k) row.push_back({.x = 0.0242 * double(k), .vx = k == 0 ? 0.1 : 0.0});
  RunningMill mill = start_mill(smooth_shell(2, 0, law, dt), charge_of(row));
  advance_by(mill, 0.1);
  std::vector<double> speeds;
  for (std::size_t k = 0; k < balls; ++k) speeds.push_back(vx_of(mill, k) / 0.1);
  return speeds;
}

// Newton's cradle: one in, one out; with losses the shares are (1 - e) / 2 and (1 + e) / 2 at each impact. 3.5e-4 is
// what the step leaves of e (restitution_test.cpp), half of it here, and each impact adds its own.
TEST(Cradle, TwoBallsExchangeTheirSpeeds) {
  for (const double e : {1.0, 0.8, 0.4}) {
    const auto v = after_the_impact(2, e);
    EXPECT_NEAR(v[0], (1 - e) / 2, 2e-4);
    EXPECT_NEAR(v[1], (1 + e) / 2, 2e-4);
  }
}

TEST(Cradle, ThreeBallsHandTheSpeedOn) {
  const auto elastic = after_the_impact(3, 1);
  EXPECT_NEAR(elastic[0], 0, 4e-4);
  EXPECT_NEAR(elastic[1], 0, 4e-4);
  EXPECT_NEAR(elastic[2], 1, 4e-4);
  const auto lossy = after_the_impact(3, 0.8);  // first hits second, second hits third; then the first lags behind
  EXPECT_NEAR(lossy[2], 0.9 * 0.9, 4e-4);
  EXPECT_NEAR(lossy[0] + lossy[1] + lossy[2], 1, 1e-12) << "momentum";
}

}  // namespace
}  // namespace tumble::sim
