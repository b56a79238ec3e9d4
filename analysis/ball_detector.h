#pragma once
#include <opencv2/core.hpp>
#include <vector>

#include "analysis/ball_net.h"
#include "analysis/ball_refiner.h"
#include "analysis/circles.h"

namespace tumble::analysis {

struct Detection {
  double u = 0, v = 0;   // centre [px]
  double radius = 0;     // of its size class [px]
  double score = 0;      // that a ball is there, [0, 1]
  double visible = 1;    // share of its disc that nothing hides, [0, 1]
  double deviation = 0;  // of each coordinate of the centre, standard [px]
  int size_class = 0;
};

// How large the balls of this film are.
struct BallLook {
  double explained = 0;       // area of sure balls in the pictures learned from that are of these sizes [px^2]
  std::vector<double> radii;  // of the size classes [px], ascending; empty where no balls are seen
  std::vector<double> rims;   // of the edges of their outlines [px]; NaN where these are not sharp (ball_rim.h)
};

struct ScaleRange {  // pixels per unit of the known radii
  double least = 0, most = 1e9;
};

// Sizes of the balls from a few pictures of the film. `known` sizes (any unit, ascending) give the number of classes
// and their ratios; without them, classes are found. `scales` bounds that unknown: graded charges look alike one class
// up or down.
BallLook learn_look(BallNet& net, const std::vector<cv::Mat>& pictures, const Circle& bound,
                    const std::vector<double>& known, ScaleRange scales = {});

struct Detections {
  std::vector<Detection> balls;  // clearest first
  cv::Mat charge;                // CV_32F, that balls cover the place, [0, 1]; coarser than the picture
  cv::Rect window;               // of the picture, that `charge` covers [px]
};

struct BallEyes {  // what finds balls, and what puts their centres right
  BallNet net;
  BallRefiner refiner;
};

// Fills look.rims where the film is sharp enough.
void learn_rims(BallEyes& eyes, const std::vector<cv::Mat>& pictures, const Circle& bound, BallLook& look);

// Balls of these sizes in one picture, with their centres within `bound`.
Detections detect_balls(BallEyes& eyes, const cv::Mat& bgr, const BallLook& look, const Circle& bound,
                        double least_score);

}  // namespace tumble::analysis
