#include "sim/outside_force.h"

#include <gtest/gtest.h>

#include "sim/simulator.h"
#include "tests/support/balls.h"
#include "tests/support/small_mill.h"

namespace tumble::sim {
namespace {

std::vector<Frame> frames_of(const OutsideForce& outside) {
  std::vector<Frame> frames;
  RunSink sink;
  sink.frame = [&](const Frame& f) { frames.push_back(f); };
  Config config = small_mill();
  config.run.revolutions = 1;
  simulate(config, sink, {}, outside);
  return frames;
}

TEST(OutsideForce, ThatPushesNothingChangesNoBit) {
  const std::vector<Frame> without = frames_of({}), with = frames_of([](const BallState&) { return OutsidePush{}; });
  ASSERT_EQ(without.size(), with.size());
  for (std::size_t i = 0; i < with.size(); ++i) {
    EXPECT_EQ(without[i].x, with[i].x);
    EXPECT_EQ(without[i].spin, with[i].spin);
    EXPECT_EQ(without[i].observed.torque, with[i].observed.torque);
    EXPECT_EQ(without[i].observed.torque_external, with[i].observed.torque_external);
  }
}

// However the balls are cut up between threads.
TEST(OutsideForce, HasTheSameBitsForAnyNumberOfThreads) {
  MillModel model = make_mill_model(small_mill());
  std::vector<Ball> balls;
  for (int i = 0; i < 40; ++i)
    balls.push_back({.x = 0.025 * (i % 8 - 3.5), .y = 0.025 * (i / 8 - 2), .vx = 0.1 * (i % 3), .vy = 0.05 * (i % 5)});
  const auto end = [&](int threads, int per_patch) {
    RunningMill mill = start_mill(model, charge_of(balls), threads, per_patch);
    mill.outside = [](const BallState& b) { return OutsidePush{0.3 * b.vy, -0.3 * b.vx, 1e-4 * b.x, b.x > 0}; };
    advance_by(mill, 0.2);
    std::vector<double> x(balls.size());
    for (std::size_t i = 0; i < x.size(); ++i) x[static_cast<std::size_t>(mill.charge.id[i])] = mill.charge.x[i];
    x.push_back(mill.ledger.torque);
    x.push_back(mill.ledger.torque_external);
    return x;
  };
  const std::vector<double> one = end(1, 64);
  EXPECT_NE(one.back(), 0);
  EXPECT_EQ(one, end(1, 8));
  EXPECT_EQ(one, end(3, 8));
}

// A force across the velocity bends a path to a circle of the radius m v / k, run through at k / m.
TEST(OutsideForce, ActsAtThePositionsOwnTime) {
  constexpr double kPerSpeed = 0.6;
  MillModel model = resting(smooth_mill(kFlat, {}), 1e-4);
  model.gravity = 0;
  Charge charge = charge_of({{.vx = 2}});
  RunningMill mill = start_mill(model, charge);
  mill.outside = [](const BallState& b) { return OutsidePush{-kPerSpeed * b.vy, kPerSpeed * b.vx, 2e-6}; };
  const double turn = kPerSpeed / 0.06, t = 0.3;
  advance_by(mill, t);
  EXPECT_NEAR(mill.charge.x[0], 2 / turn * std::sin(turn * t), 2e-4);
  EXPECT_NEAR(mill.charge.y[0], 2 / turn * (1 - std::cos(turn * t)), 2e-4);
  EXPECT_NEAR(spin_of(mill, 0), 2e-6 / inertia(0.06, 0.012) * t, 1e-3);
}

// In a steady state the moments of drive, of what acts from outside and of the weight cancel; whose the reaction is
// decides on the account.
TEST(OutsideForce, IsBookedWhereItsReactionGoes) {
  for (const bool on_mill : {true, false}) {
    RunSink sink;
    double torque = 0, external = 0, closure = 0, frames = 0;
    sink.frame = [&](const Frame& f) {
      torque += f.observed.torque;
      external += f.observed.torque_external;
      closure += f.observed.torque_closure;
      ++frames;
    };
    Config config = small_mill();
    config.run.revolutions = 6;
    simulate(config, sink, {}, [on_mill](const BallState& b) {
      return OutsidePush{-0.05 * b.vx, -0.05 * b.vy, 0, on_mill};
    });
    EXPECT_NEAR((torque + external) / closure, 1, 0.01) << on_mill;
    if (on_mill)
      EXPECT_EQ(external, 0);
    else
      EXPECT_GT(std::abs(external), 0.03 * closure);
  }
}

}  // namespace
}  // namespace tumble::sim
