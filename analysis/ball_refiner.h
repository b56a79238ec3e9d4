#pragma once
#include <memory>
#include <opencv2/core.hpp>
#include <span>

#include "analysis/ball_net.h"

namespace tumble::analysis {

// A second small network that looks at one ball at a time and says where its centre is: within a few hundredths of its
// radius, whatever its highlights, its marks and its neighbours. Taught as the first.
class BallRefiner {
 public:
  BallRefiner();
  ~BallRefiner();
  BallRefiner(const BallRefiner&) = delete;
  BallRefiner& operator=(const BallRefiner&) = delete;

  // Balls of a picture in which their radius is about kNetRadius: puts their u, v, radius, visible and deviation right.
  void refine(const cv::Mat& bgr, std::span<SeenBall> balls);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tumble::analysis
