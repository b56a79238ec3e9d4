#include "core/morrell.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble {
namespace {

TEST(Morrell, IsTheFormulaAsOthersWorkedItOut) {
  const ToeAndShoulder at = morrell_toe_and_shoulder(0.30, 0.70);
  EXPECT_NEAR(at.toe_deg, 231.9, 0.05);
  EXPECT_NEAR(at.shoulder_deg, 42.5, 0.05);
}

TEST(Morrell, AFasterMillCarriesTheChargeHigherUntilAllOfItCentrifuges) {
  double shoulder = -90;
  for (double speed = 0.3; speed < 1.0; speed += 0.1) {
    const double next = std::remainder(morrell_toe_and_shoulder(0.35, speed).shoulder_deg, 360);
    EXPECT_GT(next, shoulder) << speed;
    shoulder = next;
  }
  const double centrifuging = 0.35 * (3.364 - 0.35);
  const ToeAndShoulder last = morrell_toe_and_shoulder(0.35, centrifuging - 1e-6);
  EXPECT_NEAR(last.toe_deg, 90, 0.01);  // toe and shoulder meet on top
  EXPECT_NEAR(last.shoulder_deg, 90, 0.01);
  EXPECT_TRUE(std::isnan(morrell_toe_and_shoulder(0.35, centrifuging).toe_deg));
}

}  // namespace
}  // namespace tumble
