#include "analysis/ball_detector.h"

#include <gtest/gtest.h>

#include "tests/analysis/painted_mill.h"

namespace tumble::analysis {
namespace {

struct Score {
  int found = 0, missed = 0, invented = 0;
  double mean_u = 0, mean_v = 0, spread = 0;  // of centres found against true ones [px]
};

Score score(const std::vector<Detection>& detections, const std::vector<PaintedBall>& balls, double least_score) {
  Score s;
  std::vector<double> du, dv;
  std::vector<char> used(detections.size(), 0);
  for (const PaintedBall& b : balls) {
    bool hit = false;
    for (std::size_t i = 0; i < detections.size() && !hit; ++i) {
      if (used[i] || std::hypot(detections[i].u - b.u, detections[i].v - b.v) > 0.5 * b.radius) continue;
      used[i] = 1;
      hit = true;
      du.push_back(detections[i].u - b.u);
      dv.push_back(detections[i].v - b.v);
    }
    ++(hit ? s.found : s.missed);
  }
  for (std::size_t i = 0; i < detections.size(); ++i) s.invented += !used[i] && detections[i].score >= least_score;
  for (std::size_t i = 0; i < du.size(); ++i) {
    s.mean_u += du[i] / static_cast<double>(du.size());
    s.mean_v += dv[i] / static_cast<double>(dv.size());
  }
  for (std::size_t i = 0; i < du.size(); ++i)
    s.spread += (std::pow(du[i] - s.mean_u, 2) + std::pow(dv[i] - s.mean_v, 2)) / static_cast<double>(du.size());
  s.spread = std::sqrt(s.spread);
  return s;
}

TEST(BallDetector, LearnsTheSizeAndFindsTouchingShiningMarkedBalls) {
  PaintedMill mill;
  mill.lifters = 0;
  const auto balls = packed_bed(mill, 9.3, 35, 5);
  ASSERT_GT(balls.size(), 60u);
  const cv::Mat picture = paint(mill, balls, 6);
  const Circle bound{mill.u, mill.v, mill.radius};
  BallEyes eyes;
  const BallLook look = learn_look(eyes.net, {picture}, bound, {});
  ASSERT_EQ(look.radii.size(), 1u);
  EXPECT_NEAR(look.radii[0], 9.3, 0.9);  // its true size comes from contacts
  const Score s = score(detect_balls(eyes, picture, look, bound, 0.2).balls, balls, 0.5);
  EXPECT_LE(s.missed, 1);
  EXPECT_EQ(s.invented, 0);
  EXPECT_LT(s.spread, 0.35);
  EXPECT_LT(std::hypot(s.mean_u, s.mean_v), 0.5);  // the one hard lamp pulls
}

TEST(BallDetector, TellsTwoKnownSizesApart) {
  PaintedMill mill;
  mill.lifters = 0;
  std::vector<PaintedBall> balls;
  for (int k = 0; k < 9; ++k) {
    const double r = k % 2 == 0 ? 9.0 : 13.5;
    balls.push_back({140.0 + 40 * (k % 3) + 0.37 * k, 130.0 + 42 * (k / 3) + 0.21 * k, r, 0.7 * k, {150, 150, 150}});
  }
  const cv::Mat picture = paint(mill, balls, 8);
  const Circle bound{mill.u, mill.v, mill.radius};
  BallEyes eyes;
  const BallLook look = learn_look(eyes.net, {picture}, bound, {0.012, 0.018});
  ASSERT_EQ(look.radii.size(), 2u);
  EXPECT_NEAR(look.radii[1] / look.radii[0], 1.5, 1e-9);
  const auto found = detect_balls(eyes, picture, look, bound, 0.5).balls;
  int right = 0;
  for (const PaintedBall& b : balls)
    for (const Detection& d : found)
      if (std::hypot(d.u - b.u, d.v - b.v) < 3) right += d.size_class == (b.radius > 11);
  EXPECT_EQ(right, 9);
}

TEST(BallDetector, SeesDarkBallsOnABrightGround) {
  PaintedMill mill;
  mill.lifters = 0;
  mill.noise = 0;
  cv::Mat picture(mill.height, mill.width, CV_8UC3, cv::Scalar(200, 200, 200));
  std::vector<PaintedBall> balls;
  for (int k = 0; k < 12; ++k) balls.push_back({120.0 + 45 * (k % 4), 120.0 + 45 * (k / 4), 10, 0.5 * k, {60, 60, 60}});
  const cv::Mat lit = paint(mill, balls, 4);
  for (int v = 0; v < picture.rows; ++v)
    for (int u = 0; u < picture.cols; ++u)
      for (const PaintedBall& b : balls)
        if (std::hypot(u - b.u, v - b.v) < b.radius) picture.at<cv::Vec3b>(v, u) = lit.at<cv::Vec3b>(v, u);
  const Circle bound{mill.u, mill.v, mill.radius};
  BallEyes eyes;
  const BallLook look = learn_look(eyes.net, {picture}, bound, {});
  EXPECT_EQ(score(detect_balls(eyes, picture, look, bound, 0.5).balls, balls, 0).missed, 0);
}

TEST(BallDetector, SeesNothingInAnEmptyMill) {
  PaintedMill mill;
  mill.lifters = 0;
  BallLook look;
  look.radii = {9};
  BallEyes eyes;
  EXPECT_TRUE(detect_balls(eyes, paint(mill, {}, 9), look, {mill.u, mill.v, mill.radius}, 0.5).balls.empty());
}

}  // namespace
}  // namespace tumble::analysis
