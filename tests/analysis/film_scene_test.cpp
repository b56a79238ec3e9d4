#include "analysis/film_scene.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "core/units.h"
#include "tests/analysis/painted_drum.h"

namespace tumble::analysis {
namespace {

constexpr double kShell = 0.3, kTips = 0.28, kBall = 0.02;

// Balls of one layer that lie between the lifters' tips and the shell, as a camera sees them, and that touch.
FilmPass pass_on_lifters(const MillCamera& camera) {
  Random random(3);
  FilmPass pass;
  for (int f = 0; f < 40; ++f) {
    std::vector<FilmBall> balls;
    for (int row = 0; row < 3; ++row)
      for (int k = 0; k < 12; ++k) {
        const double rho = kTips - kBall + 0.004 * random.uniform() - 2 * kBall * row;
        const double a = 3.5 + 2 * kBall / rho * k + 0.01 * f;
        FilmBall ball;
        const cv::Point2d p = picture_of(camera, {rho * std::cos(a), rho * std::sin(a), -kBall});
        ball.found.u = p.x;
        ball.found.v = p.y;
        ball.found.score = ball.found.visible = 0.95;
        ball.found.deviation = 0.1;
        balls.push_back(ball);
      }
    pass.balls.append(balls);
  }
  return pass;
}

double radius_found(double edge) {  // of a strong edge all round, in true shell radii
  constexpr double kWrong = 1.06;   // what was taken for the shell is smaller by as much
  const MillCamera camera = camera_for({1280, 720}, 1500, 0, 0, 300, kShell, {640, 360}, 0);
  Config known;
  known.mill.diameter = 2 * kShell;
  known.mill.lifters.height = kShell - kTips;
  DrumView drum;
  drum.camera = with_lengths_times(camera, kWrong);
  drum.scale = {1.0, 0.01};
  drum.focal = {camera.focal, 0.1};
  drum.rings = {{kWrong * edge * kShell, 40, 1.0, RingKind::kUnknown}};
  FilmScene scene = make_scene(drum, known);
  std::vector<std::string> caveats;
  settle_lengths(scene, pass_on_lifters(camera), {kBall * scene.pixels_per_unit}, {kBall}, 0.05, caveats);
  return scene.radius * scene.pixels_per_unit / 300;
}

TEST(FilmScene, TouchingBallsAndAnEdgeOutvoteAWrongShellWhereBallsLieOnTheLifters) {
  EXPECT_NEAR(radius_found(1.0), 1, 0.012);
  EXPECT_GT(std::abs(radius_found(1.1) - 1), 0.02);  // no edge where the balls want the shell: nothing is certain
}

TEST(FilmScene, BinsAreHiddenAsFarAsBallsBehindACoverReach) {
  std::vector<double> share(360, 0.0);
  for (int i = 268; i < 278; ++i) share[static_cast<std::size_t>(i)] = 1;
  const std::vector<bool> hidden = hidden_bins(share, 0, false, 5 * kPi / 180);
  for (const int i : {263, 270, 282}) EXPECT_TRUE(hidden[static_cast<std::size_t>(i)]) << i;
  for (const int i : {262, 283}) EXPECT_FALSE(hidden[static_cast<std::size_t>(i)]) << i;
  const std::vector<bool> mirrored = hidden_bins(share, 0, true, 0);  // 180 degrees less the angle
  EXPECT_TRUE(mirrored[262] && mirrored[271] && !mirrored[261] && !mirrored[272]);
}

}  // namespace
}  // namespace tumble::analysis
