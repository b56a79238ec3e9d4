#include <gtest/gtest.h>

#include "tests/support/balls.h"

namespace tumble::sim {
namespace {

// An oblique impact with friction, unequal balls and spin: momentum and angular momentum are kept to rounding.
TEST(Momentum, IsKeptBetweenTwoBalls) {
  RunningMill mill =
      start_mill(smooth_shell(1, 0, springs(0.6, 0.3), 1e-5),
                 charge_of({{.x = -0.03, .y = 0.005, .vx = 2, .vy = 0.5, .spin = 30},
                            {.radius = 0.025, .mass = 0.525, .x = 0.01, .y = -0.01, .vx = -0.5, .spin = -10}}));
  struct Sum {
    double px = 0, py = 0, l = 0;
  };
  const auto total = [&] {  // the leapfrog's own angular momentum: positions and velocities half a step apart
    Sum s;
    const Charge& c = mill.charge;
    for (std::size_t i = 0; i < 2; ++i) {
      s.px += c.mass[i] * c.vx[i];
      s.py += c.mass[i] * c.vy[i];
      s.l += c.mass[i] * (c.x[i] * c.vy[i] - c.y[i] * c.vx[i]) + inertia(c.mass[i], c.radius[i]) * c.spin[i];
    }
    return s;
  };
  const Sum before = total();
  const double spin = mill.charge.spin[0];
  advance_by(mill, 0.02);
  const Sum after = total();
  EXPECT_GT(std::abs(mill.charge.spin[0] - spin), 1) << "the balls never met";
  EXPECT_NEAR(after.px, before.px, 1e-14);
  EXPECT_NEAR(after.py, before.py, 1e-14);
  EXPECT_NEAR(after.l, before.l, 1e-14);
}

// Grip so strong that nothing slides: what the tangential spring still holds at parting is lost, and booked as lost.
TEST(Momentum, ObliqueImpactLosesWhatTheAccountsSay) {
  RunningMill mill = start_mill(smooth_shell(1, 0, springs(0.6, 20), 1e-5),
                                charge_of({{.x = -0.03, .vx = 1, .vy = 0.7}, {.x = 0, .y = 0.004}}));
  const double before = energies_of(mill).kinetic;
  advance_by(mill, 0.03);
  const double lost = before - energies_of(mill).kinetic;
  const double normal = mill.ledger.dissipated[std::size_t(Cause::kBallBallNormal)];
  const double sliding = mill.ledger.dissipated[std::size_t(Cause::kBallBallSliding)];
  EXPECT_GT(sliding, 0.02 * lost);
  EXPECT_NEAR(normal + sliding, lost, 2e-3 * lost);
}

}  // namespace
}  // namespace tumble::sim
