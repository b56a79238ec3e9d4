#pragma once
#include <Eigen/Core>
#include <vector>

#include "core/config.h"
#include "core/lifter_section.h"

namespace tumble {

// The inside of the shell in the mill's own frame (it turns by the mill angle, and is never accumulated): a circle, and
// on it lifters that may differ, for single ones wear and break off. Lifter k stands at angle k x pitch.
struct MillShape {
  double radius = 0;                    // R of the shell [m]
  double tip_radius = 0;                // nearest that any lifter comes to the axis; = radius without lifters [m]
  int lifter_count = 0;                 // places for lifters, taken or not
  std::vector<LifterSection> sections;  // the different ones; empty where their sizes are not known
  std::vector<int> section_of;          // which section each lifter has; -1 for one that is missing

  double pitch() const;  // angle from lifter to lifter [rad]
};

// Expects a checked config. Without lifters, or where their sizes are not known (partial file), only the circle.
MillShape make_mill_shape(const Mill& mill);      // as new
MillShape make_mill_shape(const Config& config);  // with what effects.lifter_wear and missing_lifters make of it

// The visible inner outline at mill angle 0, counter-clockwise, arcs of the shell broken into chords of at most
// `chord` [m]. Where lifters come close they may share a point, which is given once.
struct OutlinePoint {
  Eigen::Vector2d at;        // [m]
  int lifter = -1;           // -1 on the shell
  Face face = Face::kPlate;  // what the outline is from here to the next point
};
std::vector<OutlinePoint> labelled_outline(const MillShape& shape, double chord);
std::vector<Eigen::Vector2d> outline(const MillShape& shape, double chord);

}  // namespace tumble
