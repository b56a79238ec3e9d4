#pragma once
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

namespace tumble::analysis {

struct SeenBall {        // by the net, in the pixels of the picture that it was given
  double u = 0, v = 0;   // centre [px], integer = pixel centre
  double radius = 0;     // [px]
  double score = 0;      // that a ball is there, [0, 1]
  double visible = 0;    // share of its disc that nothing hides, [0, 1]
  double deviation = 0;  // of each coordinate of the centre, standard [px]
};

struct BallSight {
  std::vector<SeenBall> balls;  // clearest first
  cv::Mat charge;               // CV_32F, half the picture's size: that balls cover the place, [0, 1]
};

// A small convolutional network that knows what balls look like: steel, painted or hollow, lit from anywhere, half
// hidden, blurred. It was taught by pictures of make_films alone (docs/film-analysis.md) and sees balls of 8 px radius
// best, up to 2.5 times that; pictures are to be scaled so that the smallest balls have kNetRadius.
inline constexpr double kNetRadius = 8;  // [px]

// Not to be used by two threads at once; one each is fine, and gives the same bits.
class BallNet {
 public:
  BallNet();
  ~BallNet();
  BallNet(const BallNet&) = delete;
  BallNet& operator=(const BallNet&) = delete;

  // `bgr`: 8 bits. `least_score`: candidates below are left out.
  BallSight look(const cv::Mat& bgr, double least_score);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble::analysis
