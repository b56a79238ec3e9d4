#pragma once
#include <vector>

#include "analysis/ball_detector.h"
#include "analysis/view.h"

namespace tumble::analysis {

struct LifterLattice {       // equal lifters at equal spacing, turning with the drum
  int count = 0;             // 0: none known
  double angle = kNotGiven;  // of one lifter's middle where the drum's turn is zero, as seen by the camera [rad]
};

// A lifter keeps centres of balls off its flanks by a radius and more: turned back with the drum and folded onto one
// spacing, the balls between tips and shell leave that gap empty, while a lifter that was itself taken for a ball sits
// in the gap's middle. `guess` is good to a quarter spacing; it is kept where too few balls tell.
LifterLattice find_lifters(const std::vector<std::vector<Detection>>& balls, const std::vector<double>& drum_angle,
                           const MillView& view, int count, double guess);

// Whether no ball can have its centre here because a lifter is in the way: beside its middle line by less than the
// radius, and further out than a ball that lies on the tip.
bool within_lifter(const Detection& d, const MillView& view, const LifterLattice& lifters, double drum_angle);

}  // namespace tumble::analysis
