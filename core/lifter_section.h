#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "core/config.h"

namespace tumble {

// The parts of a shell where contacts are counted apart, by the names in core/frame.h.
// A face is `leading` when it looks in the direction of rotation and `trailing` when it looks back, by the sign of its
// normal's component across the radius. What looks at the axis within 15 degrees is a lifter's `top` in the upper half
// of its height, else `plate`, as the shell itself is (a wave's trough, a polygon's flange). A corner goes by the mean
// of its faces' normals.
enum class Face { kPlate, kLeading, kTop, kTrailing, kCount };

// One lifter's outline in its own frame: x along the radius through its foot's middle, y across, > 0 in the direction
// of rotation [m]. An open chain from the trailing foot over the top to the leading foot, steel on its right. Its ends
// lie in the shell's steel, so that no gap opens at the foot; a wave's ends lie on the shell's circle.
struct LifterSection {
  std::vector<Eigen::Vector2d> chain;
  bool smooth = false;  // a curve, whose corners are none: chords of it

  double tip_radius() const;  // nearest that the chain comes to the axis [m]
};

// Curves are chords with at most this sagitta, over the shell's radius: 3 micrometres in a laboratory mill, a tenth of
// a usual overlap, so that a ball on a rounded edge feels no facets.
inline constexpr double kSagitta = 1e-5;

// What of the section's lengths is worn off: heights shrink towards the shell by `height_loss`, feet stay, so slanted
// faces grow flatter, as worn liners do; then convex edges become arcs of radius `rounding` [m], or of what fits.
struct Wear {
  double height_loss = 0, rounding = 0;
};

// The section of one lifter; empty where its sizes are not all known. Expects lifters that are checked.
LifterSection make_section(const Mill& mill, const Wear& wear);

// The part of the chain inside the circle of this radius about the axis, ends on the circle.
std::vector<Eigen::Vector2d> clipped(const LifterSection& section, double radius);

// The line with the points left out that lie within `tolerance` of it, for drawings (Douglas & Peucker 1973).
std::vector<Eigen::Vector2d> thinned(const std::vector<Eigen::Vector2d>& line, double tolerance);

// The face that a piece of a section with this normal (out of the steel) is, at this place.
Face face_of(const LifterSection& section, double shell_radius, const Eigen::Vector2d& place,
             const Eigen::Vector2d& normal);

// What is wrong with the section ("crosses itself"); empty where it is a body on the shell, clear of the axis and of
// its neighbours, whose feet are `pitch` [rad] apart.
std::string flaw_of(const LifterSection& section, double shell_radius, double pitch);

}  // namespace tumble
