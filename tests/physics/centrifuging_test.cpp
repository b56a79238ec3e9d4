#include <gtest/gtest.h>

#include "sim/simulator.h"
#include "tests/support/lifted_ball.h"
#include "tests/support/mills.h"

namespace tumble::sim {
namespace {

// Does a ball that a smooth lifter carries up from 3 o'clock pass the top without leaving the shell?
bool centrifuges(double phi, double radius) {
  Config config = paper_mill();
  config.mill.speed = phi;
  config.mill.lifters.count = 4;
  config.contact.friction = 0;
  config.contact.normal_stiffness = 1e4;
  MillModel model = make_mill_model(config);
  model.time_step = 1e-5;
  RunningMill mill = start_mill(model, charge_of({ball_in_the_corner(model, radius, 3.2e4 * std::pow(radius, 3))}));
  while (mill.charge.x[0] > 0) {
    advance(mill);
    if (mill.charge.y[0] > mill.charge.x[0] && !wall_touch(mill, false)) return false;
  }
  return true;
}

// W^2 (R - r) = g: phi = (1 - r / R)^(-1/2), 1.005 for a ball of 5 mm in the paper's mill. A lifter is needed: a single
// ball on a bare shell rolls at the bottom, however rough the shell.
TEST(Centrifuging, OfASmallBallBeginsAtCritical) {
  for (const double radius : {0.0025, 0.012}) {
    double low = 0.9, high = 1.2;
    while (high - low > 1e-4) {
      const double phi = (low + high) / 2;
      (centrifuges(phi, radius) ? high : low) = phi;
    }
    EXPECT_NEAR(high, 1 / std::sqrt(1 - radius / 0.2725), 1e-3) << radius;
    if (radius < 0.005) {
      EXPECT_NEAR(high, 1, 0.01);
    }
  }
}

// A ball held by friction alone, in the third and fourth revolution: power lost in the contact, over m g W rho [-].
double loss_of_a_held_ball(double square, double friction, double rolling) {
  Config config = paper_mill();
  config.mill.lifters.profile = LifterProfile::kNone;
  config.contact.friction = friction;
  config.effects["rolling_resistance"] = {{"coefficient", {rolling}}};
  MillModel model = make_mill_model(config);
  model.time_step = 2e-5;
  const double path = model.shell.radius - 0.012;
  model.speed = std::sqrt(square * kGravity / path);
  Ball ball{.vx = model.speed * path, .spin = model.speed};
  ball.y = -path - 0.06 * kGravity * (1 + square) / 4e5;  // on the spring that weight and centrifugal force press
  RunningMill mill = start_mill(model, charge_of({ball}));
  const auto lost = [&] { return lost_by(mill, Cause::kBallWallSliding) + lost_by(mill, Cause::kRolling); };
  advance_by(mill, 2 * 2 * kPi / model.speed);
  const double before = lost();
  advance_by(mill, 2 * 2 * kPi / model.speed);
  return (lost() - before) / (0.06 * kGravity * path * 4 * kPi);
}

// At the angle a from the top the wall presses with m (W^2 rho - g cos a) and must hold m g sin a: for every a only if
// W^2 rho / g >= sqrt(1 + 1 / mu^2). A sphere turns about its one contact unless a couple holds it too: mu is the
// lesser of friction and rolling resistance.
TEST(Centrifuging, IsASolidBodyOnceFrictionHoldsAtEveryAngle) {
  for (const auto& [friction, rolling] : {std::pair{0.4, 1.0}, {1.0, 0.5}}) {
    const double mu = std::min(friction, rolling), threshold = std::sqrt(1 + 1 / (mu * mu));
    EXPECT_LT(std::abs(loss_of_a_held_ball(1.02 * threshold, friction, rolling)), 1e-7) << "mu " << mu;
    EXPECT_GT(loss_of_a_held_ball(0.98 * threshold, friction, rolling), 1e-6) << "mu " << mu;
  }
}

// Likewise a layer of balls between lifters: at twice critical nothing moves and the drive has nothing to do; at 1.2
// the balls shuttle in their pockets.
TEST(Centrifuging, ALayerTakesNoPower) {
  const auto share = [](double phi) {
    Config config = paper_mill();
    config.mill.speed = phi;
    config.mill.lifters.count = 12;
    config.charge.count = 30;
    config.charge.balls = {{0.012, 0.06, 1}};
    config.contact.friction = 0.6;
    config.effects["rolling_resistance"] = {{"coefficient", {0.6}}};
    config.run.spin_up = 6;
    config.run.revolutions = 2;
    double torque = 0, frames = 0;
    RunSink sink;
    sink.frame = [&](const Frame& f) { torque += f.observed.torque, ++frames; };
    simulate(config, sink);
    return torque / frames / (30 * 0.06 * kGravity * 0.26);
  };
  EXPECT_LT(std::abs(share(2)), 1e-3);
  EXPECT_GT(share(1.2), 3e-3);
}

}  // namespace
}  // namespace tumble::sim
