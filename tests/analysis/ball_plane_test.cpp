#include "analysis/ball_plane.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "core/units.h"

namespace tumble::analysis {
namespace {

double normal(Random& random) {
  double sum = -6;
  for (int i = 0; i < 12; ++i) sum += random.uniform();
  return sum;
}

TEST(SharpEdge, IsWhereTheCrowdBeginsUnderBlurAndStrays) {
  Random random(5);
  std::vector<double> values;
  for (int i = 0; i < 6000; ++i) {
    const bool at_edge = random.uniform() < 0.5, stray = random.uniform() < 0.1;
    const double beyond = at_edge ? 0.0 : -0.05 * std::log(1 - random.uniform());
    values.push_back(stray ? random.uniform(0.85, 1.2) : 1.013 + beyond + 0.01 * normal(random));
  }
  const Estimate edge = sharp_edge(values, 0.85, 1.2, +1);
  EXPECT_NEAR(edge.value, 1.013, 0.003);
  EXPECT_LT(edge.se, 0.003);
  EXPECT_TRUE(std::isnan(sharp_edge({1, 1, 1}, 0.85, 1.2, +1).value));
}

Sighting ball(double x, double y, double score = 0.9) {
  Sighting s;
  s.x = x;
  s.y = y;
  s.radius = 0.01;
  s.deviation = 1e-4;
  s.score = score;
  return s;
}

// A ring of balls against a shell of 0.3 that is `scale` too large in these places, rows of touching ones inside.
std::vector<SeenFrame> bed(double scale) {
  Random random(7);
  std::vector<SeenFrame> frames;
  for (int f = 0; f < 30; ++f) {
    SeenFrame frame;
    for (int row = 0; row < 3; ++row)
      for (int k = 0; k < 20; ++k) {
        const double rho = 0.29 - 0.02 * row, a = 3.5 + 0.02 / rho * k + 0.01 * f;
        frame.balls.push_back(ball(scale * (rho * std::cos(a) + 2e-4 * normal(random)),
                                   scale * (rho * std::sin(a) + 2e-4 * normal(random))));
      }
    frames.push_back(frame);
  }
  return frames;
}

TEST(BallPlane, SetsTheScaleByWhereBallsStopAndTouch) {
  for (const double scale : {0.96, 1.0, 1.03}) {
    const BallPlane plane = measure_ball_plane(bed(scale), 0.3, {1.0, 0.05});
    EXPECT_NEAR(plane.factor.value * scale, 1, 0.003) << scale;
  }
}

TEST(BallPlane, TellsHowFarOutBallsCome) {
  EXPECT_NEAR(measure_ball_plane(bed(1), 0.3, {1.0, 0.05}).outermost, 1, 0.003);
  EXPECT_NEAR(measure_ball_plane(bed(1), 0.5, {1.0, 0.05}).outermost, 0.6, 0.003);
}

TEST(BallPlane, DepthBehindTheGlassIsAnError) {
  // Balls of 10 mm radius in a mill 60 mm long lie 0 to 40 mm behind where they touch the glass.
  const DepthDoubt shallow = depth_doubt(true, 0.06, 0.01, 2.0, 0.3);
  EXPECT_NEAR(shallow.place_error, 0.01 * std::hypot(2 / std::sqrt(3.0), 0.3), 1e-12);
  EXPECT_NEAR(shallow.glass_error, 0.3 * 0.03 / 2, 1e-12);
  EXPECT_EQ(depth_doubt(true, 0.02, 0.01, 2.0, 0.3).place_error, 0);  // no room
  EXPECT_GT(depth_doubt(false, kNotGiven, 0.01, 2.0, 0.3).place_error, 0);
}

TEST(BallPlane, TellsOneLayerFromBallsThatCoverOneAnother) {
  std::vector<SeenFrame> frames = bed(1);
  EXPECT_TRUE(in_one_layer(frames));
  for (SeenFrame& f : frames)
    for (int k = 0; k < 10; ++k) {
      Sighting behind = f.balls[static_cast<std::size_t>(k)];
      behind.x += 0.012;  // 0.6 of the distance at which they touch
      f.balls.push_back(behind);
    }
  EXPECT_FALSE(in_one_layer(frames));
}

TEST(BallPlane, DropsWhatLiesBeyondTheShellAndWhatCannotBeThereToo) {
  SeenFrame frame;
  frame.balls = {ball(0.29, 0), ball(0.296, 0.1), ball(0.1, 0), ball(0.11, 0, 0.4), ball(0.13, 0)};
  drop_beyond(frame, 0.3);
  ASSERT_EQ(frame.balls.size(), 4u);  // the second was a bolt
  drop_impossible(frame, 0.02);
  ASSERT_EQ(frame.balls.size(), 3u);
  for (const Sighting& s : frame.balls) EXPECT_GT(s.score, 0.5);  // the less certain one of the two went
}

}  // namespace
}  // namespace tumble::analysis
