#include <gtest/gtest.h>

#include "tests/support/balls.h"

namespace tumble::sim {
namespace {

Effects ends(double coefficient, double pressure = 0) {
  return {{"end_wall_friction", {{"coefficient", {coefficient}}, {"pressure", {pressure}}}}};
}

// Thrown straight up between ends at rest: slowed by g (1 + c) on the way up, and by g (1 - c) driven down.
TEST(EndWallFriction, BrakesAFlight) {
  const double c = 0.3, v0 = 2;
  RunningMill mill = start_mill(resting(smooth_mill(kFlat, ends(c), 0.2), 1e-5), charge_of({{.vy = v0, .spin = 5}}));
  const double rise = v0 / (kGravity * (1 + c));
  advance_by(mill, rise);
  EXPECT_NEAR(mill.charge.y[0], v0 * v0 / (2 * kGravity * (1 + c)), 1e-4);
  const double loss = c * 0.06 * kGravity * mill.charge.y[0];
  EXPECT_NEAR(lost_by(mill, Cause::kEndWalls), loss, 1e-3 * loss);
  advance_by(mill, 0.2);
  EXPECT_NEAR(vy_of(mill, 0), -kGravity * (1 - c) * 0.2, 2e-3);
  EXPECT_EQ(spin_of(mill, 0), 5) << "the poles lie on the spin's axis";
}

// At 1 and above the ends hold a ball in mid-air; below they do not.
TEST(EndWallFriction, HoldsAtRestUpToTheWeight) {
  for (const double c : {1.02, 0.98}) {
    RunningMill mill = start_mill(resting(smooth_mill(kFlat, ends(c), 0.2), 1e-5), charge_of({{.x = 0.1}}));
    advance_by(mill, 1);
    if (c > 1)
      EXPECT_NEAR(mill.charge.y[0], 0, 1e-4) << "let go, it swings past the limit once and comes to rest";
    else
      EXPECT_NEAR(vy_of(mill, 0), -kGravity * (1 - c), 6e-3) << "it falls freely until the spring is wound";
  }
}

// Held so, it goes round with the ends as the drive does, ripple and all: after t the ball's angle is the mill's,
// W t + (a / n) (sin(n W t + p) - sin p). What they lift it the drive pays.
TEST(EndWallFriction, CarriesABallRoundWithTheMill) {
  Effects effects = ends(5);
  effects["speed_ripple"] = {{"amplitude", {0.3}}, {"order", {2}}, {"phase_deg", {40}}};
  MillModel model = resting(smooth_mill(kFlat, effects), 4e-5);
  const double w = model.speed = 6, p = 40 * kPi / 180;
  Charge charge = charge_of({{.x = 0.2, .vy = 0.2 * w * (1 + 0.3 * std::cos(p))}});
  charge.spin[0] = 1;
  RunningMill mill = start_mill(model, charge);
  for (const double t : {0.1, 0.37, 1.0}) {
    while (double(mill.step) * model.time_step < t - 1e-9) advance(mill);
    const double angle = w * t + 0.15 * (std::sin(2 * w * t + p) - std::sin(p));
    EXPECT_NEAR(mill.charge.x[0], 0.2 * std::cos(angle), 2e-5) << t << " s";
    EXPECT_NEAR(mill.charge.y[0], 0.2 * std::sin(angle), 2e-5) << t << " s";
  }
  const Energies e = energies_of(mill);
  const double start = 0.5 * 0.06 * std::pow(0.2 * w * (1 + 0.3 * std::cos(p)), 2) + 0.5 * inertia(0.06, 0.012);
  EXPECT_NEAR(mill.ledger.drive_work, e.kinetic + e.potential + e.elastic - start, 1e-4);
}

// `pressure`: a ball that slides along a frictionless floor presses on it by its weight.
TEST(EndWallFriction, GrowsWithWhatPressesOnTheBall) {
  const MillModel model = resting(smooth_mill(kFlat, ends(0.05, 0.1)), 1e-5);
  RunningMill mill = start_mill(model, charge_of({on_floor(model, 0, 1)}));
  advance_by(mill, 0.2);
  EXPECT_NEAR(1 - vx_of(mill, 0), 0.15 * kGravity * 0.2, 1e-3);
}

}  // namespace
}  // namespace tumble::sim
