#include <gtest/gtest.h>

#include "tests/support/balls.h"

namespace tumble::sim {
namespace {

Effects cohesion(double force) { return {{"cohesion", {{"force", {force}}}}}; }

// A ball under the top of the shell, held at rest there by `force` against its weight.
Ball under_the_ceiling(const MillModel& m, const Ball& like, double force) {
  Ball b = like;
  b.x = 0;
  b.y = m.shell.radius - b.radius + (force - b.mass * m.gravity) / m.wall.springs.normal_stiffness;
  return b;
}

// Gravity grows slowly until ball `last` lets go; returns it.
double gravity_that_parts(RunningMill mill, std::size_t last, double from, double to) {
  const double y = mill.charge.y[last];
  for (int k = 0; k < 200'000; ++k) {
    mill.model.gravity = from + (to - from) * k / 200'000;
    advance(mill);
    if (y - mill.charge.y[last] > 2e-5) return mill.model.gravity;
  }
  return INFINITY;
}

// At the wall the pull-off force is F_c r / R_mean, twice F_c for a mean ball; it grows with the radius. 1 %: the ramp
// goes on while the ball lets go.
TEST(Cohesion, HoldsABallAtTheCeilingUpToThePullOffForce) {
  for (const Ball& like : {Ball{.radius = 0.012, .mass = 0.06}, Ball{.radius = 0.024, .mass = 0.06}}) {
    MillModel model = resting(smooth_mill(kFlat, cohesion(0.6)), 2e-5);
    const double pull_off = 0.6 * like.radius / 0.006;
    model.gravity = 0.5 * pull_off / like.mass;
    RunningMill mill = start_mill(model, charge_of({under_the_ceiling(model, like, pull_off)}));
    const double least = model.gravity;
    EXPECT_NEAR(gravity_that_parts(mill, 0, least, 3 * least) * like.mass, pull_off, 0.01 * pull_off) << like.radius;
  }
}

// Ball under ball: F_c R / R_mean, R = r_i r_j / (r_i + r_j). The upper one sticks to the ceiling far better.
TEST(Cohesion, HoldsABallUnderABall) {
  for (const double radius : {0.012, 0.006}) {
    MillModel model = resting(smooth_mill(kFlat, cohesion(0.6)), 2e-5);
    const double reduced = 0.012 * radius / (0.012 + radius), pull_off = 0.6 * reduced / 0.006, mass = 0.02;
    model.gravity = 0.5 * pull_off / mass;
    Ball upper = under_the_ceiling(model, {.mass = 0.001}, 1.2 - mass * model.gravity);
    Ball lower{.radius = radius, .mass = mass};
    lower.y = upper.y - 0.012 - radius + (pull_off - mass * model.gravity) / 4e5;
    RunningMill mill = start_mill(model, charge_of({upper, lower}));
    EXPECT_NEAR(gravity_that_parts(mill, 1, model.gravity, 3 * model.gravity) * mass, pull_off, 0.01 * pull_off);
  }
}

// Pressed on by the attraction, a ball without weight slides to a stop by mu F_c / m; the bond itself loses nothing.
TEST(Cohesion, PressesOnFrictionAndTakesNoEnergy) {
  MillModel model = resting(smooth_mill(kFlat, cohesion(0.6), 0.1));
  model.gravity = 0;
  Ball ball = on_floor(model, 0, 1, 1.2);
  RunningMill sliding = start_mill(model, charge_of({ball}));
  advance_by(sliding, 0.1);
  EXPECT_NEAR(1 - vx_of(sliding, 0), 0.1 * 0.1 * 1.2 / 0.06, 2e-3);

  MillModel elastic = resting(smooth_mill(kFlat, cohesion(0.6), 0, 1));
  elastic.gravity = 0;
  RunningMill impact = start_mill(elastic, charge_of({{.x = -0.0125, .vx = 0.1}, {.x = 0.0125}}));
  const double start = 0.5 * 0.06 * 0.01;
  double worst = 0;  // the bond's energy is in the books while it holds
  for (int k = 0; k < 12'500; ++k) {
    advance(impact);
    const Energies e = energies_of(impact);
    worst = std::max(worst, std::abs(e.kinetic + e.elastic - start));
  }
  EXPECT_LT(worst, 3e-4 * start);
  EXPECT_NEAR(vx_of(impact, 1), 0.1, 1e-4);
  EXPECT_NEAR(lost_by(impact, Cause::kBallBallNormal), 0, 2e-4 * 0.5 * 0.03 * 0.01);
}

}  // namespace
}  // namespace tumble::sim
