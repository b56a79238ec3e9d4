#include <gtest/gtest.h>

#include "tests/support/balls.h"

namespace tumble::sim {
namespace {

constexpr double kRadius = 0.012, kMass = 0.06;

RunningMill in_fluid(double viscosity, double density, double gravity, const Ball& ball) {
  MillModel model =
      resting(smooth_mill(kFlat, {{"fluid_drag", {{"viscosity", {viscosity}}, {"density", {density}}}}}), 1e-4);
  model.gravity = gravity;
  return start_under_forces(model, charge_of({ball}));
}

// Stokes alone: velocity and spin decay as exp(-6 pi eta r t / m) and exp(-8 pi eta r^3 t / I).
TEST(FluidDrag, SlowsExponentiallyByViscosity) {
  const double eta = 2, t = 0.05;
  RunningMill mill = in_fluid(eta, 0, 0, {.vx = 3, .vy = -4, .spin = 50});
  advance_by(mill, t);
  const double kept = std::exp(-6 * kPi * eta * kRadius / kMass * t);
  EXPECT_NEAR(vx_of(mill, 0), 3 * kept, 1e-5);
  EXPECT_NEAR(vy_of(mill, 0), -4 * kept, 1e-5);
  const double per_spin = 8 * kPi * eta * std::pow(kRadius, 3) / inertia(kMass, kRadius);
  EXPECT_NEAR(spin_of(mill, 0), 50 * std::exp(-per_spin * t), 1e-4);
  const double before = 0.5 * kMass * 25 + 0.5 * inertia(kMass, kRadius) * 2500;
  EXPECT_NEAR(lost_by(mill, Cause::kFluidDrag), before - energies_of(mill).kinetic, 1e-3 * before);
}

// Newton's quadratic drag alone: 1 / v grows evenly, by C_d rho pi r^2 / 2m.
TEST(FluidDrag, SlowsHyperbolicallyByInertia) {
  RunningMill mill = in_fluid(0, 1200, 0, {.vx = 5});
  advance_by(mill, 0.2);
  const double per_metre = 0.44 * 1200 * kPi * kRadius * kRadius / 2 / kMass;
  EXPECT_NEAR(vx_of(mill, 0), 1 / (1 / 5.0 + per_metre * 0.2), 1e-5);
}

// Terminal velocity: weight = 6 pi eta r v + C_d rho pi r^2 v^2 / 2, each part alone and both.
TEST(FluidDrag, EndsInTheTerminalVelocity) {
  for (const auto& [eta, rho] : {std::pair{2.0, 0.0}, {0.0, 1000.0}, {1.0, 1000.0}}) {
    RunningMill mill = in_fluid(eta, rho, kGravity, {});
    advance_by(mill, 4);
    const double a = 0.44 * rho * kPi * kRadius * kRadius / 2, b = 6 * kPi * eta * kRadius, c = kMass * kGravity;
    const double expected = 2 * c / (b + std::sqrt(b * b + 4 * a * c));
    EXPECT_NEAR(-vy_of(mill, 0), expected, 1e-6 * expected) << eta << " Pa s, " << rho << " kg/m3";
  }
}

}  // namespace
}  // namespace tumble::sim
