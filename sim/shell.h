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

// Appends the features that are nearer than `reach` to the ball's centre (x, y), in ascending order.
void features_near(const Shell& shell, double mill_angle, double x, double y, double reach, std::vector<int>& out);

}  // namespace tumble::sim
