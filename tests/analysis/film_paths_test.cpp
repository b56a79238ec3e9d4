#include "analysis/film_paths.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>

#include "core/angle.h"

namespace tumble::analysis {
namespace {

constexpr double kTurn = 0.02;
constexpr int kRings = 3, kEach = 12;

// Balls carried round for ever, each in its own place; every one is out of sight now and then.
SeenFrame carried(std::size_t f) {
  SeenFrame frame;
  frame.time = static_cast<double>(f);
  for (int ring = 0; ring < kRings; ++ring)
    for (int i = 0; i < kEach; ++i) {
      const int ball = ring * kEach + i;
      if ((f + 7u * static_cast<std::size_t>(ball)) % 50 == 0) continue;
      // Balls slide back a little against the drum: else they would be parts of it.
      const double a = 2 * kPi * i / kEach + 0.9 * kTurn * frame.time;
      Sighting s;
      s.x = (0.5 + 0.15 * ring) * std::cos(a);
      s.y = (0.5 + 0.15 * ring) * std::sin(a);
      s.radius = 0.05;
      s.deviation = 0.001;
      s.score = 1;
      s.u = ball;  // who it is: the linker does not look at it
      s.v = 0;
      s.time = frame.time;
      frame.balls.push_back(s);
    }
  return frame;
}

TEST(FilmPaths, BallsKeepTheirNumbersFromChapterToChapter) {
  constexpr std::size_t kFrames = 1000;
  MotionModel model;
  model.turn = kTurn;
  std::map<int, std::set<int>> numbers;  // by ball
  std::size_t next = 0;
  link_in_chapters(
      kFrames, carried, {300, 60}, model, [](std::vector<SeenFrame>&) {},
      [&](std::size_t f, const SeenFrame& seen, const SeenFrame&) {
        EXPECT_EQ(f, next++);
        EXPECT_EQ(seen.time, static_cast<double>(f));
        for (const Sighting& s : seen.balls) numbers[static_cast<int>(s.u)].insert(s.track);
      });
  EXPECT_EQ(next, kFrames);
  ASSERT_EQ(numbers.size(), static_cast<std::size_t>(kRings * kEach));
  std::set<int> all;
  for (const auto& [ball, tracks] : numbers) {
    EXPECT_EQ(tracks.size(), 1u) << "ball " << ball;
    all.insert(tracks.begin(), tracks.end());
  }
  EXPECT_EQ(all.size(), numbers.size());
  EXPECT_FALSE(all.contains(-1));
}

}  // namespace
}  // namespace tumble::analysis
