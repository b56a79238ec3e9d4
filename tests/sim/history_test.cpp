#include "sim/history.h"

#include <gtest/gtest.h>

#include "core/random.h"
#include "sim/packing.h"
#include "sim/simulator.h"
#include "tests/support/balls.h"
#include "tests/support/mills.h"

namespace tumble::sim {
namespace {

// Noise about 8 N m with a trend and locked balls that arrive at one sample.
History history(std::uint64_t seed, double trend, double locked_at_last, std::size_t samples = 640) {
  History h;
  Random random(seed);
  for (std::size_t k = 0; k < samples; ++k) {
    const double drift = trend * double(k) / double(samples);
    h.torque.push_back(8 + drift + random.uniform(-1, 1));
    h.closure.push_back(8 + drift + random.uniform(-0.5, 0.5));
    h.locked.push_back(k > 3 * samples / 4 ? locked_at_last : 0);
  }
  return h;
}

TEST(Steadiness, NoiseIsSteadyTrendIsNot) {
  int steady = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) steady += judge(history(seed, 0, 0), 0, 640, 112, 3).steady;
  EXPECT_GE(steady, 95);
  for (std::uint64_t seed = 1; seed <= 100; ++seed) EXPECT_FALSE(judge(history(seed, 1, 0), 0, 640, 112, 3).steady);
}

TEST(Steadiness, AFilledPocketIsNotSteady) {
  EXPECT_FALSE(judge(history(1, 0, 3), 0, 640, 112, 3).steady);
  EXPECT_TRUE(judge(history(1, 0, 3), 500, 640, 112, 3).steady) << "filled before this stretch";
}

// Twice the critical speed: the first layer turns with the shell after the start, and is counted after a revolution.
TEST(LockedBalls, AreThoseThatTurnWithTheShell) {
  Config config = paper_mill();
  config.mill.speed = 2;
  config.charge.count = 20;
  config.run.spin_up = 3;
  config.run.revolutions = 1;
  double locked = -1;
  RunSink sink;
  sink.frame = [&](const Frame& f) { locked = f.observed.locked_balls; };
  simulate(config, sink);
  EXPECT_EQ(locked, 20);

  config.mill.lifters = {};  // slow and smooth: all roll back
  config.mill.speed = 0.3;
  simulate(config, sink);
  EXPECT_EQ(locked, 0);
}

}  // namespace
}  // namespace tumble::sim
