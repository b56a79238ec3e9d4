#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "analysis/carried_balls.h"
#include "analysis/charge_motion.h"
#include "core/error.h"
#include "tests/analysis/falling_balls.h"

namespace tumble::analysis {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

constexpr double kPixel = 0.001;  // [m]
constexpr double kBallRadius = 0.012;

// A film of the falling balls with the axis at 640, 360. Balls lie all round, up to the shell.
PixelTracks film_of(const FallingBalls& scene, bool mirrored = false) {
  Random random(1);
  PixelTracks tracks;
  tracks.name = "tracks.csv";
  for (const TimedPlace& p : sightings(scene, random)) {
    PixelSighting s;
    s.track = p.track;
    s.frame = static_cast<int>(p.frame);
    s.u = 640 + (mirrored ? -1 : 1) * p.x / kPixel;
    s.v = 360 - p.y / kPixel;
    s.radius = kBallRadius / kPixel;
    tracks.sightings.push_back(s);
  }
  return tracks;
}

Config mill_of(const FallingBalls& scene) {
  Config mill;
  mill.mill.diameter = 2 * (0.95 * scene.mill_radius + kBallRadius);
  return mill;
}

FallingBalls scene() {
  FallingBalls scene;
  scene.fps = 120;
  scene.carried = 60;
  return scene;
}

TEST(Tracks, TellAxisScaleClockAndSpeed) {
  const Config mill = mill_of(scene());
  TracksOptions options;
  options.mill = &mill;
  const ChargeMotion motion = measure_tracks(film_of(scene()), options);
  EXPECT_EQ(motion.source, MotionSource::kTracks);
  EXPECT_EQ(motion.rotation, Rotation::kCounterClockwise);
  EXPECT_NEAR(motion.camera.centre_u_px, 640, 3);
  EXPECT_NEAR(motion.camera.centre_v_px, 360, 3);
  EXPECT_NEAR(motion.camera.metres_per_pixel, kPixel, 0.015 * kPixel);
  EXPECT_NEAR(motion.frames_per_second, 120, 1.5);
  EXPECT_NEAR(motion.speed_rpm.value, rpm_from_rad_s(1.025 * scene().speed), 2);  // they differ by 15 %
  EXPECT_EQ(motion.frames, 120);
}

TEST(Tracks, OfAClockwiseMillAreMirrored) {
  FallingBalls tilted = scene();
  tilted.roll_deg = 2;
  const Config mill = mill_of(tilted);
  TracksOptions options;
  options.mill = &mill;
  options.centre_u_px = 640;
  options.centre_v_px = 360;
  options.metres_per_pixel = kPixel;
  const ChargeMotion straight = measure_tracks(film_of(tilted), options);
  const ChargeMotion mirrored = measure_tracks(film_of(tilted, true), options);
  EXPECT_EQ(mirrored.rotation, Rotation::kClockwise);
  EXPECT_NEAR(mirrored.speed_rpm.value, straight.speed_rpm.value, 1e-3);
  // The roll is of the picture as it was taken; what is reported is upright and mirrored.
  EXPECT_NEAR(straight.camera.roll_deg.value, 2, 0.2);
  EXPECT_NEAR(mirrored.camera.roll_deg.value, -2, 0.2);
  ASSERT_EQ(straight.tracks.size(), mirrored.tracks.size());
  EXPECT_NEAR(straight.tracks[500].x, mirrored.tracks[500].x, 1e-9);
  EXPECT_NEAR(straight.tracks[500].y, mirrored.tracks[500].y, 1e-9);
}

TEST(Tracks, WithoutAnyLengthHaveNoClockButARoll) {
  const ChargeMotion motion = measure_tracks(film_of(scene()), {});
  EXPECT_TRUE(std::isnan(motion.frames_per_second));
  EXPECT_TRUE(std::isnan(motion.camera.metres_per_pixel));
  EXPECT_NEAR(motion.camera.roll_deg.value, 0, 0.2);
  EXPECT_THAT(motion.caveats, Contains(HasSubstr("--metres-per-pixel")));
}

TEST(Tracks, WhatIsToldIsBelieved) {
  const Config mill = mill_of(scene());
  TracksOptions options;
  options.mill = &mill;
  options.recorded_fps = 60;
  const ChargeMotion motion = measure_tracks(film_of(scene()), options);
  EXPECT_EQ(motion.frames_per_second, 60);
  EXPECT_THAT(motion.caveats, Contains(HasSubstr("--recorded-fps 60 is believed, but balls in flight fall as at 1")));
}

TEST(Tracks, ThatTurnAboutNothingNeedTheAxis) {
  PixelTracks tracks;
  tracks.name = "tracks.csv";
  for (int f = 0; f < 20; ++f) tracks.sightings.push_back({1, f, 100.0 + f, 100, 8});
  EXPECT_THROW(measure_tracks(tracks, {}), InputError);
}

// Beads of a real mill, whole pixels, in a file whose clock is wrong: falling beads say 317 frames/s instead of 240.
TEST(Tracks, OfTheFilmedMiniMillTellItsClock) {
  const std::filesystem::path file = std::filesystem::path(TUMBLE_SOURCE_DIR) / "../shared/data/minimill_tracks.csv";
  std::ifstream in(file);
  if (!in) GTEST_SKIP() << file << " is not there";
  PixelTracks tracks;
  tracks.name = file.string();
  for (std::string line; std::getline(in, line);) {
    std::istringstream row(line);
    PixelSighting s;
    char comma = 0;
    if (row >> s.track >> comma >> s.frame >> comma >> s.u >> comma >> s.v >> comma >> s.radius)
      tracks.sightings.push_back(s);
  }
  Config mill;
  mill.mill.diameter = 0.172;  // its bore; nothing said of its speed
  TracksOptions options;
  options.mill = &mill;
  const ChargeMotion motion = measure_tracks(tracks, options);
  EXPECT_NEAR(motion.frames_per_second, 317, 0.1 * 317);
  EXPECT_NEAR(motion.camera.centre_u_px, 589.7, 5);
  EXPECT_NEAR(motion.camera.centre_v_px, 398.2, 5);
  EXPECT_NEAR(motion.camera.radius_px, 325, 5);
  EXPECT_NEAR(motion.speed_fraction.value, 0.36, 0.036);
}

}  // namespace
}  // namespace tumble::analysis
