#include "analysis/bed_times.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "core/units.h"

namespace tumble::analysis {
namespace {

// Ball 0 lies still, flies from 0.5 to 0.9 s and again from 1.5 to 1.8 s; ball 1 lies still all the time.
constexpr double kRate = 200, kEnd = 2.5;
struct Flown {
  double from, to;
};
constexpr Flown kFlights[] = {{0.5, 0.9}, {1.5, 1.8}};

ChargeMotion hand_made() {
  ChargeMotion motion;
  for (int frame = 0; frame <= kEnd * kRate; ++frame) {
    TrackPoint p;
    p.frame = frame;
    p.time = 10 + frame / kRate;  // a run need not begin at 0
    p.x = 0.1;
    p.y = -0.2;
    p.radius = 0.012;
    for (const Flown& f : kFlights) {
      const double t = std::clamp(frame / kRate - f.from, 0.0, f.to - f.from);
      p.x -= 1.1 * t;
      p.y += (2.4 - 0.5 * kGravity * t) * t;
    }
    TrackPoint other;
    other.frame = frame;
    other.id = 1;
    other.time = p.time;
    other.radius = 0.012;
    const TrackPoint both[] = {p, other};
    motion.tracks.append(both);
  }
  return motion;
}

// A flight's end is known to a frame; its beginning a little less.
constexpr double kWithin = 2 / kRate;

TEST(BedTimes, CountFromTheEndOfTheLastFlight) {
  const BedTimes bed(hand_made());
  EXPECT_NEAR(bed.residence(0, 10.3), 0.3, 1e-12);  // since the run's first frame: more is not known
  EXPECT_EQ(bed.residence(0, 10.7), 0);
  EXPECT_NEAR(bed.residence(0, 11.4), 0.5, kWithin);
  EXPECT_EQ(bed.residence(0, 11.65), 0);
  EXPECT_NEAR(bed.residence(0, 12.3), 0.5, kWithin);
  EXPECT_NEAR(bed.residence(1, 12.3), 2.3, 1e-12);
}

TEST(BedTimes, KnowTheStaysBetweenFlights) {
  const auto stays = BedTimes(hand_made()).stays();
  ASSERT_EQ(stays.size(), 1u);
  EXPECT_NEAR(stays[0], 0.6, 2 * kWithin);
}

}  // namespace
}  // namespace tumble::analysis
