#include "analysis/even_turn.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "tests/analysis/falling_balls.h"

namespace tumble::analysis {
namespace {

// Angles of a drum with a ripple of 5 % six times a turn, read with an error. `lost`: one picture of so many is
// repeated, and as many are missing. `change`: of the camera's rate, half way.
std::vector<double> drum_angles(double step_deg, double sigma_deg, std::uint64_t lost, double change,
                                std::uint64_t seed) {
  Random random(seed);
  std::vector<double> angles;
  double turned = 0;
  for (int i = 0; i < 140; ++i) {
    const double pictures = random.below(lost) == 0 ? 0 : random.below(lost) == 0 ? 2 : 1;
    turned += radians(step_deg) * pictures * (i > 70 ? change : 1.0);
    angles.push_back(turned + 0.05 / 6 * std::sin(6 * turned) + radians(sigma_deg) * gaussian(random));
  }
  return angles;
}

TEST(EvenTurn, ADrumTurnsEvenlyHoweverItIsFilmed) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    EXPECT_TRUE(evenness_of(drum_angles(2, 0.02, 20, 1, seed)).even);
    EXPECT_TRUE(evenness_of(drum_angles(1, 0.2, 20, 1, seed)).even);      // hardly seen
    EXPECT_TRUE(evenness_of(drum_angles(2, 0.05, 200, 0.8, seed)).even);  // a camera that changes its rate
  }
}

TEST(EvenTurn, AChargeThatSlidesDoesNot) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    Random random(seed);
    std::vector<double> angles;
    double turned = 0, speed = 0.5;
    for (int i = 0; i < 140; ++i) {
      speed += 0.1 * (0.6 - speed) + 0.08 * gaussian(random);  // surges over some ten pictures
      turned += radians(1.5) * speed;
      angles.push_back(turned + radians(0.05) * gaussian(random));
    }
    const Evenness evenness = evenness_of(angles);
    EXPECT_FALSE(evenness.even) << seed;
    EXPECT_GT(evenness.scatter, radians(0.1));
  }
}

}  // namespace
}  // namespace tumble::analysis
