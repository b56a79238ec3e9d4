#include "analysis/ball_spin.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/analysis/painted_mill.h"

namespace tumble::analysis {
namespace {

constexpr int kFrames = 16, kBalls = 25;

double turn_of(int ball) { return 0.045 * (ball - 12); }  // -0.54 to 0.54 rad a frame
// Every third bears no mark.
bool is_plain(int ball) { return ball % 3 == 1; }

// Balls that drift through a small picture, each with its own spin, all with a highlight that stays where it is.
std::vector<SeenFrame> turning_balls(bool any_marked) {
  PaintedMill mill;
  mill.width = mill.height = 200;
  mill.u = mill.v = 100;
  mill.radius = 98;
  mill.lifters = 0;
  mill.noise = 4;
  Random random(5);
  std::vector<SeenFrame> frames;
  for (int f = 0; f < kFrames; ++f) {
    std::vector<PaintedBall> balls;
    for (int b = 0; b < kBalls; ++b) {
      const double mark = is_plain(b) || !any_marked ? kNotGiven : 0.7 * b + turn_of(b) * f;
      const double light = b % 2 == 0 ? 105 : 125;
      balls.push_back({30.2 + 35 * (b % 5) + 0.3 * f, 31.1 + 35 * (b / 5), 11, mark, {light, light, light}});
    }
    const cv::Mat picture = paint(mill, balls, static_cast<std::uint64_t>(f + 1));
    SeenFrame frame;
    frame.time = f;
    for (int b = 0; b < kBalls; ++b) {
      const PaintedBall& ball = balls[static_cast<std::size_t>(b)];
      Sighting s;
      s.x = ball.u - mill.u;
      s.y = mill.v - ball.v;
      s.radius = ball.radius;
      s.time = f;
      s.track = b;
      s.vx = 0.5 * s.radius;  // balls roll at such speeds here
      s.vy = 0;
      s.mark = look_at_mark(picture, ball.u + random.uniform(-0.4, 0.4), ball.v + random.uniform(-0.4, 0.4), 11);
      frame.balls.push_back(s);
    }
    frames.push_back(frame);
  }
  return frames;
}

TEST(BallSpin, OfMarkedBallsIsTheirTurn) {
  std::vector<SeenFrame> frames = turning_balls(true);
  measure_spins(frames, 0.02);
  int told = 0, marked = 0;
  double squares = 0, expected = 0;
  for (const SeenFrame& f : frames)
    for (const Sighting& s : f.balls) {
      if (is_plain(s.track)) {
        EXPECT_TRUE(std::isnan(s.spin)) << "ball " << s.track << " bears no mark";
        continue;
      }
      ++marked;
      if (std::isnan(s.spin)) continue;
      ++told;
      const double miss = s.spin - turn_of(s.track);
      EXPECT_LT(std::abs(miss), 0.08) << "ball " << s.track << ", frame " << f.time;
      squares += miss * miss;
      expected += s.spin_se * s.spin_se;
    }
  EXPECT_GT(told, 0.95 * marked);
  EXPECT_LT(std::sqrt(squares / told), 0.02);
  EXPECT_NEAR(std::sqrt(squares / expected), 1, 0.5);
}

TEST(BallSpin, IsNotGuessedWhereNothingIsPainted) {
  std::vector<SeenFrame> frames = turning_balls(false);
  measure_spins(frames, 0.02);
  for (const SeenFrame& f : frames)
    for (const Sighting& s : f.balls) EXPECT_TRUE(std::isnan(s.spin)) << "ball " << s.track;
}

TEST(BallSpin, ChangesItsSignWithTheMirror) {
  std::vector<SeenFrame> frames(1);
  frames[0].balls.resize(1);
  frames[0].balls[0].spin = 0.25;
  turn_upright(frames, 0.3, false);
  EXPECT_EQ(frames[0].balls[0].spin, 0.25);
  turn_upright(frames, 0.0, true);
  EXPECT_EQ(frames[0].balls[0].spin, -0.25);
}

}  // namespace
}  // namespace tumble::analysis
