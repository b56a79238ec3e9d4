#pragma once
#include <Eigen/Core>
#include <vector>

#include "core/config.h"

namespace tumble {

// The inside of the shell in the mill's own frame (it turns by the mill angle, and is never accumulated).
// A circle, and `lifter_count` equal convex polygons on it: ball against circle and ball against convex polygon each
// have one nearest point, so contacts need neither chords nor rules for shared corners.
// Vectors are unaligned: the struct is copied and stored freely.
struct MillShape {
  double radius = 0;      // R of the shell [m]
  double tip_radius = 0;  // of the circle through the lifter tips; = radius without lifters [m]
  int lifter_count = 0;
  std::vector<Eigen::Vector2d> lifter;  // lifter 0, corners counter-clockwise [m]; its foot's middle is at angle 0

  double pitch() const;  // angle from lifter to lifter [rad]
};

// Expects a checked config. Without lifters, or where their sizes are not known (partial file), only the circle.
MillShape make_mill_shape(const Mill& mill);

// The visible inner outline at mill angle 0, counter-clockwise, arcs broken into chords of at most `chord` [m].
std::vector<Eigen::Vector2d> outline(const MillShape& shape, double chord);

}  // namespace tumble
