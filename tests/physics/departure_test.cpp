#include <gtest/gtest.h>

#include "core/angle.h"
#include "tests/support/balls.h"

namespace tumble::sim {
namespace {

constexpr double kShell = 0.2725, kPath = kShell - 0.012;  // radius of the centre's path

// A frictionless ball that starts at the bottom with v0 runs up the resting shell; the angle from the top at which it
// leaves (180 degrees where it never does).
double departure_from_top_deg(double v0) {
  // Starts on the spring that carries its weight and holds it on the circle.
  const double sag = 0.06 * (kGravity + v0 * v0 / kPath) / 4e5;
  RunningMill mill =
      start_mill(smooth_shell(kShell, kGravity, springs(0.4), 1e-5), charge_of({{.y = -kPath - sag, .vx = v0}}));
  for (int k = 0; k < 200'000; ++k) {
    advance(mill);
    const double x = mill.charge.x[0], y = mill.charge.y[0];
    if (x < 0) return 180;  // over the top
    if (contacts_of(mill, Kind::kPlate).empty()) return 180 - degrees(std::atan2(x, -y));
  }
  return -1;
}

// m v^2 / rho = m g cos(a), a from the top, with v^2 = v0^2 - 2 g rho (1 + cos a): cos a = (v0^2 / (g rho) - 2) / 3.
TEST(Departure, IsWhereTheShellStopsPushing) {
  for (const double square : {2.5, 3.0, 4.0}) {
    const double expected = degrees(std::acos((square - 2) / 3));
    EXPECT_NEAR(departure_from_top_deg(std::sqrt(square * kGravity * kPath)), expected, 0.3)
        << "v0^2 / (g rho) " << square;
  }
}

// The loop: v0^2 = 5 g rho just carries the ball over the top, where v^2 = g rho: it centrifuges there. Within 0.5 %.
TEST(Departure, NoneAboveTheSpeedOfCentrifuging) {
  EXPECT_EQ(departure_from_top_deg(std::sqrt(5.05 * kGravity * kPath)), 180);
  EXPECT_LT(departure_from_top_deg(std::sqrt(4.95 * kGravity * kPath)), 20);
}

}  // namespace
}  // namespace tumble::sim
