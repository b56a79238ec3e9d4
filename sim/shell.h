#pragma once
#include <cstdint>
#include <vector>

#include "core/mill_shape.h"

// The turning shell as the balls feel it: an exact circle and, on it, equal convex lifters.
// Features: 0 is the shell's circle, k + 1 is lifter k. A ball has one nearest point on each.
namespace tumble::sim {

// One face of a lifter in the lifter's own frame (x along the radius through its foot's middle).
struct LifterFace {
  double x = 0, y = 0;    // where the face starts [m]
  double tx = 0, ty = 0;  // unit vector along it
  double nx = 0, ny = 0;  // unit normal, out of the lifter
  double length = 0;      // [m]
};

struct Shell {
  double radius = 0;      // R [m]
  double tip_radius = 0;  // [m]
  int lifter_count = 0;
  std::vector<LifterFace> faces;               // faces[0] is the foot, inside the steel
  double lifter_centre = 0, lifter_reach = 0;  // bounding circle: distance of its centre from the axis, radius [m]
  std::vector<double> lifter_cos, lifter_sin;  // of the lifters' angles in the mill
};

Shell make_shell(const MillShape& shape);

// Nearest point of a lifter as seen from a ball's centre, in the lifter's frame.
struct Nearest {
  double distance = 0;    // from the centre [m]; < 0 for a centre inside the lifter
  double nx = 0, ny = 0;  // unit vector from the centre to the point (or out of the lifter, reversed)
};
Nearest nearest_on_lifter(const Shell& shell, double x, double y);

// Rotation from the lab to the lifters' frames at one mill angle.
struct ShellPose {
  double cos = 1, sin = 0;
};
ShellPose pose_of(double mill_angle);

// Direction of lifter k in the lab.
struct Direction {
  double cos = 1, sin = 0;
};
inline Direction lifter_direction(const Shell& shell, const ShellPose& pose, int k) {
  const double c = shell.lifter_cos[k], s = shell.lifter_sin[k];
  return {pose.cos * c - pose.sin * s, pose.sin * c + pose.cos * s};
}

// Number of features; they are 0 to this, less one.
inline int feature_count(const Shell& shell) { return 1 + shell.lifter_count; }

// The lifter that a feature other than 0 belongs to.
inline int lifter_of(const Shell&, int feature) { return feature - 1; }

// The parts of a shell where impacts are counted apart: `leading` looks in the direction of rotation.
enum class Face { kPlate, kLeading, kTop, kTrailing, kCount };

// The nearest point of a feature as a ball's centre sees it, in the lab.
struct WallPoint {
  double distance = 0;    // from the centre [m]; < 0 for a centre inside the steel
  double nx = 0, ny = 0;  // unit vector from the centre into the wall
  Face face = Face::kPlate;
};
WallPoint nearest_on_wall(const Shell& shell, const ShellPose& pose, int feature, double x, double y);

// Can a ball of this radius at (x, y) touch the feature? Cheap, and never wrongly no.
inline bool may_touch(const Shell& shell, const ShellPose& pose, int feature, double x, double y, double radius) {
  if (feature == 0) {
    const double clear = shell.radius - radius;
    return x * x + y * y >= 0.999999 * clear * clear;
  }
  const Direction l = lifter_direction(shell, pose, feature - 1);
  const double du = x * l.cos + y * l.sin - shell.lifter_centre, v = y * l.cos - x * l.sin;
  const double span = radius + shell.lifter_reach;
  return du * du + v * v <= 1.000001 * span * span;
}

// Appends the features that are nearer than `reach` to the ball's centre (x, y), in ascending order.
void features_near(const Shell& shell, double mill_angle, double x, double y, double reach, std::vector<int>& out);

}  // namespace tumble::sim
