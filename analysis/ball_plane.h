#pragma once
#include <vector>

#include "analysis/tracking.h"
#include "core/sharp_edge.h"

namespace tumble::analysis {

// What the balls say of the lengths that a camera gives: they touch at the sum of their radii, and stop at the shell.
struct BallPlane {
  Estimate touching;             // seen over true distance of balls that touch
  Estimate reach;                // seen over true distance from the axis of balls that lie against the shell
  double outermost = kNotGiven;  // how far out the balls' sides come, 99th percentile [mill radii]
  double uneven = 0;  // how badly the places where they stop in each direction lie on one circle about the axis
  Estimate factor;    // by which places are to be multiplied; touching and reach together with
                      // what was known before
};

// `frames`: places about the axis with the radii as known; `mill_radius`: of the shell; both in one unit. `prior`: of
// the factor, before the balls are asked.
BallPlane measure_ball_plane(const std::vector<SeenFrame>& frames, double mill_radius, const Estimate& prior);

// R by the balls' radii over the one that they were measured with.
Estimate shell_by_balls(const BallPlane& plane);

// The factor alone, of witnesses that are not NaN.
Estimate lengths_factor(const BallPlane& plane, const Estimate& prior);

// What the unknown depth of the balls behind the glass does to lengths.
struct DepthDoubt {
  double place_error = 0;  // relative standard error of places, as for balls that touch the glass, by it
  double glass_error = 0;  // and of the scale in the plane of the glass
};

// `length`: of the mill, NaN where unknown; `radius`: of a ball, usually; `distance`: of the camera, all in one unit.
// `focal_error`: relative; the distance is wrong by as much.
DepthDoubt depth_doubt(bool one_layer, double length, double radius, double distance, double focal_error);

// Drops what lies beyond the shell, such as bolts.
void drop_beyond(SeenFrame& frame, double mill_radius);

// Balls that hardly ever cover one another, though many touch, lie in one layer.
bool in_one_layer(const std::vector<SeenFrame>& frames);

// In a shallow mill balls hardly come to lie before one another: of two sightings nearer to each other than two balls
// can be in this length, the less certain one is dropped (a shadow, a mark, a half of a ball). Nothing happens where
// the length is NaN.
void drop_impossible(SeenFrame& frame, double length);

}  // namespace tumble::analysis
