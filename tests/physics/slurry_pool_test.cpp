#include <gtest/gtest.h>

#include "tests/support/balls.h"

namespace tumble::sim {
namespace {

constexpr double kRadius = 0.012, kVolume = 4.0 / 3 * kPi * kRadius * kRadius * kRadius;

// A pool up to the axis of a wide mill.
MillModel pool(double density, double viscosity, double drag_coefficient, double time_step) {
  return resting(smooth_mill(kFlat, {{"slurry_pool",
                                      {{"density", {density}},
                                       {"level", {0}},
                                       {"viscosity", {viscosity}},
                                       {"drag_coefficient", {drag_coefficient}}}}}),
                 time_step);
}

// Acceleration of a ball at rest at this height [m/s2].
double acceleration_at(double y) {
  RunningMill mill = start_mill(pool(1500, 0, 0, 1e-6), charge_of({{.y = y}}));
  advance(mill);
  return 2 * mill.charge.ay[0] / mill.model.time_step;
}

// Archimedes: nothing above, half the sphere's volume with the centre in the surface, all of it below; and at a quarter
// of the diameter 5/32 of the volume (cap of height r / 2).
TEST(SlurryPool, LiftsByWhatIsDisplaced) {
  const double whole = 1500 * kVolume * kGravity / 0.06;
  EXPECT_NEAR(acceleration_at(1.01 * kRadius), -kGravity, 1e-6);
  EXPECT_NEAR(acceleration_at(0.5 * kRadius), -kGravity + 5.0 / 32 * whole, 1e-6);
  EXPECT_NEAR(acceleration_at(0), -kGravity + 0.5 * whole, 1e-6);
  EXPECT_NEAR(acceleration_at(-1.01 * kRadius), -kGravity + whole, 1e-6);
  EXPECT_NEAR(acceleration_at(-40 * kRadius), -kGravity + whole, 1e-6);
}

// `level` counts in shell radii from the axis.
TEST(SlurryPool, HasItsSurfaceAtTheLevel) {
  const MillModel model = resting(smooth_mill(0.25, {{"slurry_pool", {{"density", {1500}}, {"level", {-0.4}}}}}), 1e-6);
  RunningMill mill = start_mill(model, charge_of({{.y = -0.1}}));
  advance(mill);
  EXPECT_NEAR(2 * mill.charge.ay[0] / 1e-6, -kGravity + 0.5 * 1500 * kVolume * kGravity / 0.06, 1e-6);
}

// A ball half as dense as the slurry bobs half immersed; without drag no energy is lost, small bobs are harmonic with
// w^2 = rho g (pi r^2) / m, and it shoots out of the depth as far as it was pushed down.
TEST(SlurryPool, BobsWithoutLoss) {
  const double density = 2 * 0.06 / kVolume, amplitude = 1e-4;
  const double w = std::sqrt(density * kGravity * kPi * kRadius * kRadius / 0.06);
  RunningMill small = start_under_forces(pool(density, 0, 0, 1e-5), charge_of({{.y = amplitude}}));
  advance_by(small, 7.25 * 2 * kPi / w);
  EXPECT_NEAR(small.charge.y[0], 0, 2e-3 * amplitude) << "seven periods and a quarter";
  EXPECT_NEAR(vy_of(small, 0), -amplitude * w, 2e-3 * amplitude * w);

  RunningMill deep = start_mill(pool(density, 0, 0, 1e-5), charge_of({{.y = -0.1}}));
  const Energies start = energies_of(deep);
  double highest = -1, worst = 0;
  for (int k = 0; k < 60'000; ++k) {
    advance(deep);
    const Energies e = energies_of(deep);
    highest = std::max(highest, deep.charge.y[0]);
    worst = std::max(worst, std::abs(e.kinetic + e.potential - start.potential));
  }
  EXPECT_NEAR(highest, 0.1, 1e-5) << "buoyancy of twice the weight: up as far as down";
  EXPECT_LT(worst, 1e-6 * 0.06 * kGravity * 0.1);
}

// Inside the pool: weight less buoyancy = 6 pi eta r v + C_d rho pi r^2 v^2 / 2. A spin decays there, half as fast at
// the surface, and not at all above.
TEST(SlurryPool, DragsInside) {
  const double rho = 1500, eta = 1;
  RunningMill mill = start_mill(pool(rho, eta, 0.44, 1e-4), charge_of({{.y = -0.05}}));
  advance_by(mill, 4);
  const double a = 0.44 * rho * kPi * kRadius * kRadius / 2, b = 6 * kPi * eta * kRadius,
               c = (0.06 - rho * kVolume) * kGravity;
  EXPECT_NEAR(-vy_of(mill, 0), 2 * c / (b + std::sqrt(b * b + 4 * a * c)), 1e-6);

  MillModel still = pool(rho, eta, 0.44, 1e-5);
  still.gravity = still.body.pool.gravity = 0;
  RunningMill spins = start_under_forces(
      still, charge_of({{.x = -1, .y = -1, .spin = 10}, {.spin = 10}, {.x = 1, .y = 1, .spin = 10}}));
  advance_by(spins, 0.1);
  const double decay = 8 * kPi * eta * std::pow(kRadius, 3) / inertia(0.06, kRadius) * 0.1;
  EXPECT_NEAR(spin_of(spins, 0), 10 * std::exp(-decay), 1e-4);
  EXPECT_NEAR(spin_of(spins, 1), 10 * std::exp(-decay / 2), 1e-4);
  EXPECT_EQ(spin_of(spins, 2), 10);
}

}  // namespace
}  // namespace tumble::sim
