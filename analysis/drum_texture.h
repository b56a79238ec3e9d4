#pragma once
#include <opencv2/core.hpp>
#include <vector>

#include "analysis/drum_pose.h"

namespace tumble::analysis {

// Angles counter-clockwise as the camera sees the mill [rad]; lengths in pixels at the mill's origin.

// The ring of the drum that is unrolled: rows from `inner` outwards, one pixel each, columns round the drum.
struct PolarGrid {
  double inner = 0;
  int rows = 0, columns = 0;

  double radius(double row) const { return inner + row; }
  double pitch() const;  // of the columns [rad]
};

// Unrolls pictures as a camera at `pose` sees the plane z = 0.
class Unroller {
 public:
  Unroller(const DrumPose& pose, const PolarGrid& grid);
  cv::Mat operator()(const cv::Mat& grey) const;       // 8 bit, rows x columns; 0 where the picture ends
  const cv::Mat& in_view() const { return in_view_; }  // 8 bit, 255 where the picture shows the place
  const PolarGrid& grid() const { return grid_; }
  const DrumPose& pose() const { return pose_; }

 private:
  DrumPose pose_;
  PolarGrid grid_;
  cv::Mat coarse_map_, fine_map_, in_view_;
};

// What stands still in the unrolled pictures, and what a picture is besides.
struct StillPart {
  cv::Mat mean, deviation;  // over time, CV_32F
};
StillPart find_still_part(const std::vector<cv::Mat>& strips);

// What turns with the drum: the co-turning mean of what does not stand still, cut into pieces that are found one by
// one in other pictures.
class DrumTexture {
 public:
  static constexpr int kPieceColumns = 32, kPieces = 64;  // round each band: they overlap by half

  DrumTexture(const Unroller& unroll, const StillPart& still, double blur);

  // Adds the moving part of a picture at a drum angle; `finish` when all are in: pieces are cut where most of what
  // moves is texture, no nearer than `margin` rows to where that ends.
  void add(const cv::Mat& moving, double angle);
  void finish(int margin);

  const std::vector<cv::Range>& bands() const { return bands_; }  // of rows, innermost first
  // Bands without a gap between them lie on one surface: numbers of the surfaces, 0 for the outermost.
  int surface(int band) const;
  DrumPiece piece(int index) const;  // layer is the surface
  int pieces() const { return static_cast<int>(bands_.size()) * kPieces; }
  double coherence(int row) const { return coherence_[static_cast<std::size_t>(row)]; }  // share of what moves, [0, 1]

  struct Found {
    bool seen = false;
    double along_radius = 0, across = 0;  // from where it was expected [px]; across > 0 counter-clockwise
    double likeness = 0;                  // correlation with the texture, [-1, 1]
    double grey_deviation = 0;
    Eigen::Matrix2d weight;  // inverse covariance [1/px^2]
  };
  // All pieces in the moving part of one picture, expected at a drum angle.
  std::vector<Found> find(const cv::Mat& moving, double angle) const;

  // The picture's place of a sighting.
  cv::Point2d pixel_of(int piece, double angle, const Found& found) const;

  const cv::Mat& pattern() const { return pattern_; }  // CV_32F, rows x columns, at drum angle 0
  cv::Mat moving_part(const cv::Mat& strip) const;     // without what stands still, blurred like the pattern

 private:
  struct Window {  // of one piece: sums over its rows and columns
    Eigen::Matrix4d gram, inverse;
    bool usable = false;
  };
  long columns_of(double angle) const;

  const Unroller* unroll_;
  const StillPart* still_;
  double blur_;
  std::vector<cv::Range> bands_;
  std::vector<double> power_, coherence_;  // by row
  MillCamera camera_;
  cv::Mat view_, sum_, weight_, pattern_, by_row_, by_column_, out_of_view_;
  std::vector<Window> windows_;
};

}  // namespace tumble::analysis
