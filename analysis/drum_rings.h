#pragma once
#include <opencv2/core.hpp>
#include <vector>

#include "analysis/drum_pose.h"

namespace tumble::analysis {

// A circle about the axis that the mean picture shows, in the plane z = 0 of a pose.
struct RingEdgePoints {
  double radius = 0;                // [px at the origin]
  double strength = 0;              // mean step of brightness across it, outside minus inside [grey levels]
  double coverage = 0;              // share of the directions in view in which it was found
  double roughness = 0;             // deviation of its points from the circle [px]
  std::vector<cv::Point2d> points;  // one a direction in which it was found
};

// Steps of brightness that go round the axis, between two radii; each is looked for within `reach` of its commonest
// radius. Innermost first.
std::vector<RingEdgePoints> find_rings(const cv::Mat& grey, const DrumPose& pose, double inner, double outer,
                                       double reach);

// Where something turns in a picture that otherwise stands still: first guess.
struct TurningDisc {
  bool found = false;
  cv::Point2d axis;
  double radius = 0;          // outermost at which things move nearly all round [px]
  double wider = 0;           // outermost of those that lie mostly outside of the picture, if larger [px]; 0: none
  double moving_besides = 0;  // area outside of it where things move, in areas of the disc
};

// `mean`, `deviation`: of the pictures over time, CV_32F.
TurningDisc find_turning_disc(const cv::Mat& mean, const cv::Mat& deviation);

}  // namespace tumble::analysis
