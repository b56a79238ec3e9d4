#include "analysis/ballistics.h"

#include <gtest/gtest.h>

#include "tests/analysis/falling_balls.h"

namespace tumble::analysis {
namespace {

FreeFall fall_of(const FallingBalls& scene, const FallOptions& options = {}, std::uint64_t seed = 1) {
  Random random(seed);
  return find_free_fall(sightings(scene, random), options);
}

FallOptions global_shutter() {
  FallOptions options;
  options.readout_share = 0;
  return options;
}

class Rates : public ::testing::TestWithParam<double> {};

TEST_P(Rates, ComeOutOfTheFlightsAlone) {
  FallingBalls scene;
  scene.fps = GetParam();
  const Estimate fps = frames_per_second(fall_of(scene, global_shutter()), kGravity);
  EXPECT_NEAR(fps.value, scene.fps, 3 * fps.se);
  EXPECT_LT(fps.se, 0.003 * scene.fps);
}

INSTANTIATE_TEST_SUITE_P(Ballistics, Rates, ::testing::Values(24.0, 30.0, 59.94, 240.0));

TEST(Ballistics, RollIsPositiveWhereThePictureIsTurnedCounterClockwise) {
  // Turned counter-clockwise, what was straight down points to the lower right.
  std::vector<TimedPlace> places;
  for (int track = 0; track < 4; ++track)
    for (int f = 0; f < 20; ++f) {
      TimedPlace p;
      p.track = track;
      p.frame = f;
      p.x = 0.01 * track * f + 0.5 * 0.1e-3 * f * f;
      p.y = 0.05 * track - 0.5 * 1e-3 * f * f;
      places.push_back(p);
    }
  const FreeFall fall = find_free_fall(places);
  EXPECT_NEAR(fall.roll_deg.value, degrees(std::atan(0.1)), 0.05);  // 5.7
  EXPECT_EQ(fall.flights.size(), 4u);

  FallingBalls scene;
  for (const double roll : {-7.0, 3.0}) {
    scene.roll_deg = roll;
    const FreeFall seen = fall_of(scene, global_shutter());
    EXPECT_NEAR(seen.roll_deg.value, roll, 3 * seen.roll_deg.se);
    EXPECT_LT(seen.roll_deg.se, 0.1);
  }
}

TEST(Ballistics, StandardErrorsAreHonest) {
  FallingBalls scene;
  scene.fps = 100;
  scene.flying = 12;
  scene.carried = 4;
  scene.roll_deg = 1;
  int rate = 0, roll = 0;
  constexpr int kSeeds = 400;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const FreeFall fall = fall_of(scene, global_shutter(), seed);
    const Estimate fps = frames_per_second(fall, kGravity);
    rate += std::abs(fps.value - scene.fps) < 2 * fps.se;
    roll += std::abs(fall.roll_deg.value - scene.roll_deg) < 2 * fall.roll_deg.se;
  }
  // They also hold what contacts in a real mill may hide, so that they are a little wide here.
  EXPECT_GE(rate, 0.90 * kSeeds);
  EXPECT_LE(rate, 0.99 * kSeeds);
  EXPECT_GE(roll, 0.90 * kSeeds);
  EXPECT_LE(roll, 0.99 * kSeeds);
}

TEST(Ballistics, BearFalseSightingsGapsAndDrag) {
  FallingBalls scene;
  scene.wrong = 0.02;
  scene.lost = 0.1;
  const Estimate fps = frames_per_second(fall_of(scene, global_shutter()), kGravity);
  EXPECT_NEAR(fps.value, scene.fps, 3 * fps.se);
  scene.drag = 0.04;  // taken for a slower fall: half of it goes into the rate
  EXPECT_NEAR(frames_per_second(fall_of(scene, global_shutter()), kGravity).value, 1.02 * scene.fps, 0.005 * scene.fps);
}

TEST(Ballistics, RollingShutterIsTakenOutWhetherItsTimeIsKnownOrNot) {
  FallingBalls scene;
  scene.readout_share = 0.8;
  scene.flying = 60;
  FallOptions known;
  known.readout_share = 0.8;
  const Estimate right = frames_per_second(fall_of(scene, known), kGravity);
  EXPECT_NEAR(right.value, scene.fps, 3 * right.se);

  const FreeFall found = fall_of(scene);
  EXPECT_NEAR(found.readout_share.value, 0.8, 3 * found.readout_share.se);
  EXPECT_LT(found.readout_share.se, 0.2);
  EXPECT_NEAR(frames_per_second(found, kGravity).value, scene.fps, 0.006 * scene.fps);

  const double uncorrected = frames_per_second(fall_of(scene, global_shutter()), kGravity).value;
  EXPECT_GT(std::abs(uncorrected - scene.fps), 0.008 * scene.fps);
}

TEST(Ballistics, CarriedBallsAreNoFlights) {
  FallingBalls scene;
  scene.flying = 0;
  scene.carried = 60;
  for (const double speed : {3.0, 4.2, 5.9}) {  // the last is critical: centripetal acceleration is gravity
    scene.speed = speed;
    for (std::uint64_t seed = 0; seed < 5; ++seed)
      EXPECT_TRUE(std::isnan(fall_of(scene, global_shutter(), seed).magnitude.value)) << speed << ' ' << seed;
  }
}

TEST(Ballistics, SayNothingOfOneFlight) {
  FallingBalls scene;
  scene.flying = 1;
  EXPECT_TRUE(std::isnan(fall_of(scene).roll_deg.value));
  EXPECT_TRUE(std::isnan(frames_per_second(fall_of(scene), kGravity).value));
  EXPECT_TRUE(find_free_fall({}).flights.empty());
}

}  // namespace
}  // namespace tumble::analysis
