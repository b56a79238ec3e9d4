#include "diagnose/typical_paths.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace tumble::diagnose {
namespace {

// Balls on circles about (0.05, -0.05), ball k at 0.01 (k + 1) m, a turn a second, seen 100 times a second.
ChargeMotion circling(bool with_gaps) {
  ChargeMotion m;
  m.centre_of_circulation_x = {0.05, 0.001};
  m.centre_of_circulation_y = {-0.05, 0.001};
  for (int frame = 0; frame < 320; ++frame)
    for (int ball = 0; ball < 9; ++ball) {
      if (with_gaps && frame % 50 == 0) continue;
      const double angle = 2 * kPi * frame / 100.0 + ball, r = 0.01 * (ball + 1);
      TrackPoint p;
      p.frame = frame;
      p.id = ball;
      p.time = frame / 100.0;
      p.x = 0.05 + r * std::cos(angle);
      p.y = -0.05 + r * std::sin(angle);
      m.tracks.append({&p, 1});
    }
  return m;
}

TEST(TypicalPaths, AreWholeTurnsInOrderOfTheirReach) {
  const std::vector<BallPath> paths = typical_paths(circling(false));
  ASSERT_EQ(paths.size(), 5u);
  for (const BallPath& p : paths) EXPECT_NEAR(p.time.back(), 1, 0.011);
  EXPECT_EQ(paths[2].ball, 4) << "half of all turns stay inside of the middle ball's";
  for (std::size_t i = 1; i < paths.size(); ++i) EXPECT_GT(paths[i].ball, paths[i - 1].ball);
}

TEST(TypicalPaths, BallsByNumberAreFollowedWithoutGapsAndUnknownOnesRefused) {
  const std::vector<BallPath> whole = paths_of(circling(false), std::vector{7, 2}, 1);
  ASSERT_EQ(whole.size(), 2u);
  EXPECT_EQ(whole[0].ball, 7);
  EXPECT_NEAR(whole[0].time.back(), 1, 0.011);
  EXPECT_NEAR(std::hypot(whole[1].x[9] - 0.05, whole[1].y[9] + 0.05), 0.03, 1e-12);
  EXPECT_NEAR(paths_of(circling(true), std::vector{7}, 1)[0].time.back(), 0.48, 1e-9) << "from gap to gap";
  EXPECT_THROW(paths_of(circling(false), std::vector{9}, 1), InputError);
}

TEST(TypicalPaths, NoTurnIsPiecedTogetherAcrossAGap) { EXPECT_TRUE(typical_paths(circling(true)).empty()); }

}  // namespace
}  // namespace tumble::diagnose
