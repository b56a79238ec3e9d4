#include "analysis/shared_errors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "core/random.h"
#include "core/units.h"

namespace tumble::analysis {
namespace {

constexpr double kBall = 0.01, kRadius = 0.3;

// A bed that turns as one piece, the same in every frame but for which places are empty: from 220 to 350 degrees.
struct Bed {
  MillGeometry geometry{kRadius, kRadius, 2 * kBall, 1, kNotGiven};
  std::vector<std::vector<TrackPoint>> told;
  FrameSpool<TrackPoint> unseen;
  ChargeMotion motion;
};

Bed a_bed(double unseen_share) {
  Bed bed;
  ChargeStatistics statistics(bed.geometry);
  Random random(3);
  for (int f = 0; f < 40; ++f) {
    std::vector<TrackPoint> told, unseen;
    for (double r = 0.15; r < kRadius; r += 2 * kBall)
      for (double a = 220; a < 350; a += degrees(2 * kBall / r)) {
        if (random.uniform() < 0.1) continue;
        TrackPoint p;
        p.frame = f;
        p.id = static_cast<int>(told.size());
        p.time = 0.01 * f;
        p.x = r * std::cos(radians(a));
        p.y = r * std::sin(radians(a));
        p.radius = kBall;
        p.vx = p.vy = 0;
        // What is not seen lies at the toe.
        (a < 225 && random.uniform() < unseen_share ? unseen : told).push_back(p);
      }
    statistics.add(f, 0.01 * f, 0, told);
    bed.told.push_back(told);
    bed.unseen.append(unseen);
  }
  statistics.finish(bed.motion);
  return bed;
}

double se_of_toe(double unseen_share, const SharedErrors& errors) {
  Bed bed = a_bed(unseen_share);
  add_shared_errors(bed.motion, bed.geometry, {}, bed.unseen, errors);
  return bed.motion.toe_deg.se;
}

TEST(SharedErrors, RollIsTheErrorOfEveryAngle) {
  const Bed bed = a_bed(0);
  const double roll = 1.3;
  Bed rolled = bed;
  add_shared_errors(rolled.motion, bed.geometry, {}, {}, {0, 0, radians(roll)});
  for (auto angle : {&ChargeMotion::toe_deg, &ChargeMotion::shoulder_deg, &ChargeMotion::shoulder_outer_deg})
    EXPECT_NEAR((rolled.motion.*angle).se, std::hypot((bed.motion.*angle).se, roll), 0.2);
}

TEST(SharedErrors, AnAxisThatIsOffTurnsTheEdgesByItsShareOfTheRadius) {
  const double off = 0.006;
  EXPECT_NEAR(se_of_toe(0, {off, 0, 0}), degrees(off / (kRadius - kBall)), 0.5);
}

TEST(SharedErrors, TheCentreOfCirculationGoesWhereTheBallsGo) {
  Bed bed = a_bed(0);
  bed.motion.centre_of_circulation_x = {0.05, 0};
  bed.motion.centre_of_circulation_y = {-0.12, 0};
  add_shared_errors(bed.motion, bed.geometry, {}, {}, {0.004, 0, 0.02});
  EXPECT_NEAR(bed.motion.centre_of_circulation_x.se, std::hypot(0.004, 0.02 * 0.12), 1e-5);
  EXPECT_NEAR(bed.motion.centre_of_circulation_y.se, std::hypot(0.004, 0.02 * 0.05), 1e-5);
}

TEST(SharedErrors, ScaleIsTheErrorOfLengths) {
  Bed bed = a_bed(0);
  const double before = bed.motion.head.se;
  add_shared_errors(bed.motion, bed.geometry, {}, {}, {0, 0.02, 0});
  EXPECT_NEAR(bed.motion.head.se, std::hypot(before, 0.02 * bed.motion.head.value), 1e-5);
}

TEST(SharedErrors, WhatWasNotSeenAtTheToeIsInDoubt) {
  EXPECT_LT(se_of_toe(0, {}), 0.5);
  EXPECT_GT(se_of_toe(0.9, {}), 2);
}

}  // namespace
}  // namespace tumble::analysis
