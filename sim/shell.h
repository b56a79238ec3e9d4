#pragma once
#include <cstdint>
#include <vector>

#include "core/mill_shape.h"
#include "sim/lifter_run.h"

// The turning shell as the balls feel it: an exact circle and, on it, the lifters' outlines.
//
// Features are what a ball touches once and with one memory. 0 is the shell's circle. A lifter's outline is cut at its
// re-entrant corners into runs, each a feature: a ball in such a corner lies on both runs, and a ball that rolls over a
// convex crest is never counted twice. Re-entrant corners that turn by less than kSeam in all are no corners but chords
// of a hollow curve, and are not cut: there a ball has but one nearest point, and as many contacts as chords under it
// would make the wall several times as stiff. A wave is one run from trough to trough: along each half of a trough the
// curvature falls steadily, and so no circle touches it twice (Kneser's nesting of the osculating circles); a ball too
// large for the trough lies on two waves. At a cut the corner belongs to both runs, so a force fades in and out with
// the distance and never jumps; at an uncut seam the force turns by the seam's angle, without a step in its potential.
//
// Contact is with what a run shows to the ball: of the faces that the centre is in front of, the nearest point. Steel
// hides a point only if the line to it enters the steel first, at no less than the radius less the overlap there; so a
// hidden point is never within the radius, but where a fin is thinner than the overlap itself (some hundredths of a
// millimetre). A centre in the steel belongs to the nearest run alone, which pushes it out the shortest way.
namespace tumble::sim {

using tumble::Face;

// What a ball that touches the inside of a face, or the corner at either end of it, has struck.
struct FaceLabels {
  Face face = Face::kTop, at_start = Face::kTop, at_end = Face::kTop;
};

// A run at its place on the shell.
struct Feature {
  double cos = 1, sin = 0;         // of its lifter's angle in the mill
  double x = 0, y = 0, reach = 0;  // the run's circle, in the lifter's frame
  int run = 0, lifter = 0;
};

struct Shell {
  double radius = 0;           // R [m]
  double tip_radius = 0;       // [m]
  bool plate_covered = false;  // waves from trough to trough leave nothing of the circle
  int lifter_count = 0;        // places for lifters
  std::vector<LifterFace> faces;
  std::vector<FaceCorners> corners;  // of each face
  std::vector<FaceLabels> labels;    // likewise
  std::vector<FaceBlock> blocks;
  std::vector<Run> runs;
  std::vector<Feature> features;               // of all lifters in order; feature f of the shell is features[f - 1]
  std::vector<int> first_feature;              // of each lifter, and one past the last
  std::vector<double> run_of;                  // the run of each feature, for lanes; -1 of feature 0
  double lifter_centre = 0, lifter_reach = 0;  // circle that holds any lifter: its centre lies on the lifter's radius
};

// As the kernels look at it in lanes (sim/kernels/kernels.h): one convex outline, the quickest, or no faces where it is
// not that; and the runs of any shell, which stay the shell's own.
struct ConvexLifters;
ConvexLifters convex_lifters(const Shell& shell);
struct LifterRuns;
LifterRuns lifter_runs(const Shell& shell);

inline constexpr double kSeam = 0.35;  // 20 degrees [rad]

Shell make_shell(const MillShape& shape);

// Rotation from the lab to the lifters' frames at one mill angle.
struct ShellPose {
  double cos = 1, sin = 0;
};
ShellPose pose_of(double mill_angle);

// Direction of a feature's lifter in the lab.
struct Direction {
  double cos = 1, sin = 0;
};
inline Direction direction_of(const Feature& feature, const ShellPose& pose) {
  return {pose.cos * feature.cos - pose.sin * feature.sin, pose.sin * feature.cos + pose.cos * feature.sin};
}

// Number of features; they are 0 to this, less one.
inline int feature_count(const Shell& shell) { return 1 + static_cast<int>(shell.features.size()); }

// The lifter that a feature other than 0 belongs to.
inline int lifter_of(const Shell& shell, int feature) {
  return shell.features[static_cast<std::size_t>(feature) - 1].lifter;
}

// The nearest point of a feature as a ball's centre sees it, in the lab.
struct WallPoint {
  double distance = 0;    // from the centre [m]; < 0 for a centre in the steel; 2 R where the feature is out of sight
  double nx = 0, ny = 0;  // unit vector from the centre into the wall
  Face face = Face::kPlate;
};
WallPoint nearest_on_wall(const Shell& shell, const ShellPose& pose, int feature, double x, double y);

// Can a ball of this radius at (x, y) touch the feature? Cheap, and never wrongly no.
inline bool may_touch(const Shell& shell, const ShellPose& pose, int feature, double x, double y, double radius) {
  if (feature == 0) {
    const double clear = shell.radius - radius;
    return x * x + y * y >= 0.999999 * clear * clear && !shell.plate_covered;
  }
  const Feature& f = shell.features[static_cast<std::size_t>(feature) - 1];
  const Direction l = direction_of(f, pose);
  const double du = x * l.cos + y * l.sin - f.x, dv = y * l.cos - x * l.sin - f.y;
  const double span = radius + f.reach;
  return du * du + dv * dv <= 1.000001 * span * span;
}

// Appends the features that are nearer than `reach` to the ball's centre (x, y), in ascending order.
struct NearFeature {
  int feature = 0;
  double distance = 0;  // of the steel, whether it is in sight or not [m]
};
void features_near(const Shell& shell, const ShellPose& pose, double x, double y, double reach,
                   std::vector<NearFeature>& out);

// The lifter whose steel holds the point, at mill angle 0; -1 where none does.
int lifter_around(const Shell& shell, double x, double y);

}  // namespace tumble::sim
