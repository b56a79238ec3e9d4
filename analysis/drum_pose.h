#pragma once
#include <Eigen/Core>
#include <vector>

#include "analysis/mill_camera.h"

namespace tumble::analysis {

// What the picture of a turning drum depends on, as free numbers; lengths in pixels at the mill's origin, so that no
// scale is among them. The mill's y axis has no share along the camera's x: a level camera before a level mill sees it
// upright.
struct DrumPose {
  enum Index { kOriginU, kOriginV, kTiltX, kTiltY, kLogFocal, kK1, kCentreU, kCentreV, kTwist, kCount };
  using Numbers = Eigen::Matrix<double, kCount, 1>;

  // Of the mill's origin from the principal point, without distortion [px]; turns of the mill about the camera's x and
  // y [rad]; log of the focal length [px]; k1; principal point [px]; turn of the drum while the picture is read out,
  // from its first row to its last [rad].
  Numbers numbers = Numbers::Zero();
  cv::Size picture;

  MillCamera camera() const;
  double twist() const { return numbers[kTwist]; }
  // Turn of the drum that a row sees beyond that of the middle row [rad].
  double turn_at(double v) const { return twist() * ((v + 0.5) / picture.height - 0.5); }

  // Where the picture shows what lies at (radius, angle) in the plane `z` when the middle row is read out.
  cv::Point2d picture_of(const MillCamera& camera, double radius, double angle, double z) const;
};

// A frontal view with the drum's axis at a pixel.
DrumPose frontal_pose(cv::Size picture, const cv::Point2d& axis);

// One piece of the drum's texture found in one picture.
struct PieceSighting {
  int frame = 0, piece = 0;
  cv::Point2d pixel;
  Eigen::Matrix2d weight;  // inverse covariance, along the radius and across it [1/px^2]
};

struct DrumPiece {
  double radius = 0, angle = 0;  // on the drum, roughly [px, rad]
  int layer = 0;                 // pieces of a layer share their depth; layer 0 is the plane z = 0
};

// A circle about the axis in the plane z = 0: the points of an edge.
struct RingSighting {
  std::vector<cv::Point2d> points;
  double radius = 0;     // roughly [px]
  double deviation = 1;  // of a point, allowing for neighbours that err alike [px]
};

struct DrumSightings {
  std::vector<DrumPiece> pieces;
  std::vector<PieceSighting> sightings;
  std::vector<RingSighting> rings;
  int layers = 1;
};

struct PosePrior {
  DrumPose::Numbers mean, deviation;
  double depth_deviation = 1;  // of the layers [px]
};

// What may be supposed of a camera that nothing is known of: docs/film-analysis.md.
PosePrior usual_camera(cv::Size picture, double drum_radius);

struct PoseFit {
  DrumPose pose;
  Eigen::Vector2d light_shift = Eigen::Vector2d::Zero();  // by which light moves the whole texture [px]
  std::vector<double> angles;                             // of the drum, by frame [rad]
  std::vector<double> depths;                             // z by layer [px]
  std::vector<double> ring_radii;
  Eigen::Matrix<double, DrumPose::kCount, DrumPose::kCount> covariance;
  double cost = 0;    // weighted by how well each piece fits
  double misfit = 0;  // mean log of the pieces' typical chi2: for comparing fits of the same sightings
};

// Least squares over camera, drum angles and the pieces' places (bundle adjustment on a turning plane), robust.
PoseFit fit_pose(const DrumSightings& seen, const DrumPose& start, const std::vector<double>& angles,
                 const std::vector<double>& depths, const PosePrior& prior);

}  // namespace tumble::analysis
