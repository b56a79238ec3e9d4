#include <gtest/gtest.h>

#include "tests/support/balls.h"

namespace tumble::sim {
namespace {

// A sphere set down with speed v0 and no spin on a floor slides until t = 2 v0 / (7 mu g) and rolls at 5/7 v0 from then
// on. The floor is the bottom of a shell of 2 km radius: its slope after 0.3 m is 1e-4.
TEST(Sliding, TurnsToRolling) {
  const double v0 = 1, mu = 0.2, dt = 2e-5, shell = 2000;
  const double sag = 0.06 * kGravity / 4e5;  // rests on its spring from the start
  RunningMill mill = start_mill(smooth_shell(shell, kGravity, springs(0.4, mu), dt),
                                charge_of({{.x = 0, .y = -shell + 0.012 - sag, .vx = v0}}));
  const double t_roll = 2 * v0 / (7 * mu * kGravity);

  advance_by(mill, 0.5 * t_roll);
  EXPECT_NEAR(vx_of(mill, 0), v0 - mu * kGravity * 0.5 * t_roll, 1e-3) << "sliding: slowed by mu g";
  advance_by(mill, 1.0 * t_roll);
  EXPECT_NEAR(vx_of(mill, 0), 5.0 / 7 * v0, 1e-3);
  EXPECT_NEAR(mill.charge.spin[0] * 0.012, -5.0 / 7 * v0, 1e-3) << "rolling: the contact point rests";
}

// The energy lost while sliding is 2/7 of the start's, and sliding is what the accounts blame.
TEST(Sliding, LosesTwoSeventhsOfTheEnergy) {
  const double v0 = 1, shell = 2000;
  RunningMill mill = start_mill(smooth_shell(shell, kGravity, springs(0.4, 0.2), 2e-5),
                                charge_of({{.x = 0, .y = -shell + 0.012 - 0.06 * kGravity / 4e5, .vx = v0}}));
  advance_by(mill, 0.3);
  const double start = 0.5 * 0.06 * v0 * v0;
  EXPECT_NEAR(mill.ledger.dissipated[std::size_t(Cause::kBallWallSliding)], 2.0 / 7 * start, 2e-3 * start);
  EXPECT_NEAR(mill.ledger.dissipated[std::size_t(Cause::kBallWallNormal)], 0, 2e-3 * start);
}

}  // namespace
}  // namespace tumble::sim
