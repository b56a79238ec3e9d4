#include "diagnose/data_checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/diagnose/seen_mill.h"

namespace tumble::diagnose {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const SimulatedRun& run() {
  static const SimulatedRun one = simulate_paper_mill(1.2);
  return one;
}

std::string said_of(const Measurement& m) {
  try {
    check_data(m);
  } catch (const InputError& e) {
    return e.what();
  }
  return "fine";
}

void multiply(Measurement& m, double lengths, double times) {
  for (SeenFrame& f : m.frames) {
    f.time *= times;
    for (Sighting& s : f.balls) s.x *= lengths, s.y *= lengths;
  }
}

TEST(DataChecks, LetThroughWhatSuspectsDo) {
  EXPECT_EQ(said_of(measure(run(), {}, 1)), "fine");
  Errors e;
  e.scale = 0.03;
  e.rotation = -3 * kPi / 180;
  e.clock = 0.03;
  e.torque_offset = 0.054;
  e.lost = 0.05;
  EXPECT_EQ(said_of(measure(run(), e, 2)), "fine");
}

TEST(DataChecks, RefuseOtherUnits) {
  Measurement m = measure(run(), {}, 1);
  multiply(m, 1000, 1);
  EXPECT_THAT(said_of(m), AllOf(HasSubstr("tracks.csv"), HasSubstr("as if given in mm")));
  m = measure(run(), {}, 1);
  multiply(m, 1, 1000);
  EXPECT_THAT(said_of(m), AllOf(HasSubstr("have 40.1"), HasSubstr("as if given in ms")));
  for (SeenFrame& f : m.frames) f.mill_angle = kNotGiven;  // the balls at the shell tell it too
  EXPECT_THAT(said_of(m), HasSubstr("as if given in ms"));
  m = measure(run(), {}, 1);
  m.torque.value /= 1000;
  EXPECT_THAT(said_of(m), HasSubstr("the whole mill's, in N m or W"));
}

TEST(DataChecks, RefuseAnotherUpAndAnotherTurn) {
  Errors mirrored, upside_down;
  mirrored.mirrored = true;
  upside_down.upside_down = true;
  EXPECT_THAT(said_of(measure(run(), mirrored, 1)), HasSubstr("clockwise"));
  Measurement m = measure(run(), upside_down, 1);
  EXPECT_THAT(said_of(m), HasSubstr("clockwise"));  // y alone turned over is a mirror too
  m = measure(run(), {}, 1);
  for (SeenFrame& f : m.frames)
    for (Sighting& s : f.balls) s = {s.ball, -s.x, -s.y, s.radius, s.spin};
  EXPECT_THAT(said_of(m), HasSubstr("straight down"));
}

TEST(DataChecks, RefuseDataOfAnotherExperiment) {
  Measurement m = measure(run(), {}, 1);
  m.config.mill.speed = 0.8;
  EXPECT_THAT(said_of(m), AllOf(HasSubstr("at 40."), HasSubstr("45.8")));
  m = measure(run(), {}, 1);
  m.config.charge.count = 150;
  EXPECT_THAT(said_of(m), AllOf(HasSubstr("112 balls"), HasSubstr("150")));
  m = measure(run(), {}, 1);
  m.torque.value *= 1.6;
  m.torque_series.clear();
  EXPECT_THAT(said_of(m), HasSubstr("of the same experiment"));
  m = measure(run(), {}, 1);
  m.is_film = true;
  m.motion.lifters_seen = 12;
  EXPECT_THAT(said_of(m), AllOf(HasSubstr("12 times a turn"), HasSubstr("mill.lifters.count = 18")));
}

// Something may take torque that does not move the charge (a pool, a magnet): then the torque is not what the charge's
// weight takes, and yet it goes up and down with it.
TEST(DataChecks, TorqueOfAnotherRunDoesNotFollowTheCharge) {
  static const SimulatedRun longer = simulate_paper_mill(6);
  Measurement m = measure(longer, {}, 1);
  m.torque.value *= 1.3;
  EXPECT_EQ(said_of(m), "fine");
  static const SimulatedRun another = simulate_paper_mill(6, {}, 2);
  m.torque_series = measure(another, {}, 2).torque_series;
  EXPECT_THAT(said_of(m), AllOf(HasSubstr("does not follow that charge"), HasSubstr("of the same experiment")));
}

}  // namespace
}  // namespace tumble::diagnose
