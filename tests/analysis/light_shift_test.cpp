#include <gtest/gtest.h>

#include <cmath>

#include "analysis/mill_scale.h"
#include "core/random.h"
#include "core/units.h"

namespace tumble::analysis {
namespace {

// Pairs of balls in all directions, most of them touching; light moves the seen centre of each by -(0.03, -0.02) radii.
std::vector<std::vector<Detection>> lit_pairs(const std::vector<double>& radii, int count) {
  Random random(5);
  std::vector<std::vector<Detection>> frames(static_cast<std::size_t>(count));
  for (auto& frame : frames) {
    const double apart = random.uniform() < 0.7 ? 1 : random.uniform(1, 1.12), angle = random.uniform(0, 2 * kPi);
    const double reach = (radii.front() + radii.back()) * apart;
    for (const bool second : {false, true}) {
      Detection d;
      d.size_class = second ? static_cast<int>(radii.size()) - 1 : 0;
      d.radius = radii[static_cast<std::size_t>(d.size_class)];
      d.u = 100 + (second ? reach * std::cos(angle) : 0) - 0.03 * d.radius + random.uniform(-0.3, 0.3);
      d.v = 100 + (second ? reach * std::sin(angle) : 0) + 0.02 * d.radius + random.uniform(-0.3, 0.3);
      frame.push_back(d);
    }
  }
  return frames;
}

TEST(LightShift, IsReadOffUnequalBallsThatTouch) {
  const std::vector<double> radii = {13, 28};
  const LightShift shift = find_light_shift(lit_pairs(radii, 3000), radii);
  ASSERT_TRUE(shift.found);
  EXPECT_NEAR(shift.u, 0.03, 0.003);  // 0.08 px for the larger ball
  EXPECT_NEAR(shift.v, -0.02, 0.003);
}

TEST(LightShift, IsNotClaimedForOneSize) { EXPECT_FALSE(find_light_shift(lit_pairs({20}, 3000), {20}).found); }

}  // namespace
}  // namespace tumble::analysis
