#include <gtest/gtest.h>

#include "tests/support/balls.h"

namespace tumble::sim {
namespace {

using Column = std::vector<double>;

Column evenly(double from, double to, std::size_t rows) {
  Column c;
  for (std::size_t k = 0; k < rows; ++k) c.push_back(from + (to - from) * double(k) / double(rows - 1));
  return c;
}
template <class Law>
Column by(const Column& x, const Law& law) {
  Column y;
  for (const double v : x) y.push_back(law(v));
  return y;
}

// Speed of the contact point of a ball that was set down at `v0` without spin, after `seconds` [m/s].
double slip_after(const Effects& effects, double friction, double v0, double seconds) {
  const MillModel model = resting(smooth_mill(kFlat, effects, friction), 1e-5);
  RunningMill mill = start_mill(model, charge_of({on_floor(model, 0, v0)}));
  advance_by(mill, seconds);
  return vx_of(mill, 0) + spin_of(mill, 0) * 0.012;
}

// tabulated_friction: mu = a + b v between two points, u' = -7/2 g mu(u), so that a + b u falls exponentially; beyond
// the last point mu is constant and u falls evenly.
TEST(Tables, FrictionIsLinearBetweenPointsAndConstantOutside) {
  const double a = 0.05, b = 0.2, v0 = 1, t = 0.1;
  const Effects table{{"tabulated_friction", {{"speed", {0, 1}}, {"wall_friction", {a, a + b}}}}};
  const double expected = ((a + b * v0) * std::exp(-3.5 * kGravity * b * t) - a) / b;
  EXPECT_NEAR(slip_after(table, 0.9, v0, t), expected, 1e-3);
  EXPECT_NEAR(slip_after(table, 0.9, 3, t), 3 - 3.5 * kGravity * (a + b) * t, 1e-3);
  // Between balls nothing was given: contact.friction holds.
  const MillModel model = resting(smooth_mill(kFlat, table, 0.9));
  EXPECT_EQ(model.ball.friction_at(0.5), 0.9);
}

// The table takes contact.friction's place: what changes that changes it.
TEST(Tables, FrictionIsChangedAsTheModelsIs) {
  Config config =
      smooth_mill(kFlat, {{"tabulated_friction", {{"speed", {0}}, {"friction", {0.4}}, {"wall_friction", {0.3}}}},
                          {"wall_friction", {{"increase", {0.5}}}}});
  config.contact.friction_drop_at_critical = 0.5;
  config.mill.speed = 0.8;
  const MillModel model = resting(config);
  EXPECT_DOUBLE_EQ(model.ball.friction_at(1.0), 0.4 * 0.6);
  EXPECT_DOUBLE_EQ(model.wall.friction_at(1.0), 0.3 * 0.6 * 1.5);
}

TEST(Tables, FrictionTabulatedFinelyIsFrictionWeakening) {
  const double mu = 0.1, drop = 0.4, v_s = 0.25;
  const Column v = evenly(0, 1, kMostRows);
  const Column share = by(v, [&](double s) { return mu * (1 - drop * (1 - std::exp(-s / v_s))); });
  for (const double t : {0.05, 0.15})
    EXPECT_NEAR(slip_after({{"tabulated_friction", {{"speed", v}, {"wall_friction", share}}}}, mu, 1, t),
                slip_after({{"friction_weakening", {{"drop", {drop}}, {"sliding_speed", {v_s}}}}}, mu, 1, t), 2e-4);
}

// Restitution of two balls that meet at `v`, and of one that meets the wall.
struct Rebounds {
  double ball, wall;
};
Rebounds rebounds_at(double v, const Effects& effects, double e = 0.9) {
  MillModel model = resting(smooth_mill(kFlat, effects, 0, e));
  model.gravity = 0;
  RunningMill balls = start_mill(model, charge_of({{.x = -0.013, .vx = v}, {.x = 0.013}}));
  RunningMill wall = start_mill(model, charge_of({{.x = kFlat - 0.013, .vx = v}}));
  advance_by(balls, 0.005 + 0.003 / v);
  advance_by(wall, 0.005 + 0.003 / v);
  return {(vx_of(balls, 1) - vx_of(balls, 0)) / v, -vx_of(wall, 0) / v};
}

TEST(Tables, RestitutionGoesByTheSpeedOfFirstTouch) {
  const Effects table{
      {"tabulated_restitution",
       {{"speed", {0.2, 1, 2}}, {"restitution", {0.8, 0.6, 0.5}}, {"wall_restitution", {0.4, 0.3, 0.2}}}}};
  const struct {
    double v, ball, wall;
  } points[] = {{0.05, 0.8, 0.4}, {0.6, 0.7, 0.35}, {1.5, 0.55, 0.25}, {4, 0.5, 0.2}};
  for (const auto& p : points) {
    const Rebounds seen = rebounds_at(p.v, table);
    EXPECT_NEAR(seen.ball, p.ball, 2e-3) << p.v << " m/s";
    EXPECT_NEAR(seen.wall, p.wall, 3e-3) << p.v << " m/s";
  }
}

TEST(Tables, RestitutionTabulatedFinelyIsImpactRestitution) {
  const double e = 0.9, drop = 0.4, v_e = 0.5;
  const Column v = evenly(0, 2, kMostRows);
  const Column values = by(v, [&](double s) { return e * (1 - drop * (1 - std::exp(-s / v_e))); });
  const Effects table{{"tabulated_restitution", {{"speed", v}, {"restitution", values}}}};
  const Effects formula{{"impact_restitution", {{"drop", {drop}}, {"impact_speed", {v_e}}}}};
  for (const double s : {0.1, 0.7, 1.9}) EXPECT_NEAR(rebounds_at(s, table).ball, rebounds_at(s, formula).ball, 1e-3);
}

RunningMill flying(const Effects& effects, double gravity, const Ball& ball) {
  MillModel model = resting(smooth_mill(kFlat, effects), 1e-4);
  model.gravity = gravity;
  return start_under_forces(model, charge_of({ball}));
}

// F / v that grows evenly with v is Newton's drag, and with an offset Stokes' and Newton's: two points of a table.
TEST(Tables, DragOfTwoPointsIsFluidDrag) {
  const double eta = 2, rho = 1200, r = 0.012;
  const double stokes = 6 * kPi * eta * r, newton = 0.5 * 0.44 * rho * kPi * r * r;
  const Effects table{{"tabulated_drag", {{"speed", {0, 8}}, {"coefficient", {stokes, stokes + 8 * newton}}}}};
  const Effects fluid{{"fluid_drag", {{"viscosity", {eta}}, {"density", {rho}}}}};
  RunningMill a = flying(table, kGravity, {.vx = 5, .vy = 3}), b = flying(fluid, kGravity, {.vx = 5, .vy = 3});
  advance_by(a, 0.3);
  advance_by(b, 0.3);
  EXPECT_NEAR(vx_of(a, 0), vx_of(b, 0), 1e-9);
  EXPECT_NEAR(vy_of(a, 0), vy_of(b, 0), 1e-9);
  EXPECT_NEAR(lost_by(a, Cause::kFluidDrag), lost_by(b, Cause::kFluidDrag), 1e-9);
}

// The charge's mean ball of 12 mm loses speed as exp(-c t / m), one of 24 mm with 2^n times the coefficient.
TEST(Tables, DragGrowsWithThePowerOfTheRadius) {
  for (const double power : {0.0, 1.0, 3.0}) {
    const Effects table{{"tabulated_drag", {{"speed", {0}}, {"coefficient", {0.3}}, {"radius_power", {power}}}}};
    for (const double r : {0.012, 0.024}) {
      RunningMill mill = flying(table, 0, {.radius = r, .vx = 2, .spin = 30});
      advance_by(mill, 0.1);
      EXPECT_NEAR(vx_of(mill, 0), 2 * std::exp(-0.3 * std::pow(r / 0.012, power) / 0.06 * 0.1), 1e-5);
      EXPECT_EQ(spin_of(mill, 0), 30);
    }
  }
}

}  // namespace
}  // namespace tumble::sim
