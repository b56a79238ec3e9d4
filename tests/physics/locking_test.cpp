#include <gtest/gtest.h>

#include "sim/simulator.h"
#include "tests/support/mills.h"

namespace tumble::sim {
namespace {

// In the paper's mill three small balls after three wedge between the lifters over some 25 revolutions and lower the
// torque by a fifth (LIGGGHTS: 48 of 74 small balls in the end). "auto" must not take the first 20 for steady, and the
// user must be told.
TEST(Locking, AutomaticSpinUpWaitsForIt) {
  Config config = paper_mill();
  config.contact.friction = 0.3;
  config.charge.count = 106;
  config.charge.balls = {{0.012, 0.060, 74}, {0.018, 0.195, 23}, {0.025, 0.525, 9}};
  config.run.spin_up_auto = true;
  config.run.revolutions = 2;
  double locked = 0;
  RunSink sink;
  sink.frame = [&](const Frame& f) { locked = f.observed.locked_balls; };
  const RunResult result = simulate(config, sink);
  EXPECT_GT(result.spin_up_revolutions, 20);
  EXPECT_GE(locked, 40);
  EXPECT_LE(locked, 58);
  EXPECT_NE(result.caveat.find("locked between the lifters"), std::string::npos) << result.caveat;
}

// The same mill with lifters a third as many holds none for good, and is found steady soon.
TEST(Locking, WidePocketsHoldNone) {
  Config config = paper_mill();
  config.mill.lifters.count = 6;
  config.run.spin_up_auto = true;
  config.run.revolutions = 2;
  double locked = 99;
  RunSink sink;
  sink.frame = [&](const Frame& f) { locked = f.observed.locked_balls; };
  const RunResult result = simulate(config, sink);
  EXPECT_LE(locked, 2);
  EXPECT_LT(result.spin_up_revolutions, 30);
}

}  // namespace
}  // namespace tumble::sim
