#pragma once
#include <vector>

#include "analysis/ball_detector.h"

namespace tumble::analysis {

// Sizes read off the balls themselves: they touch the shell and one another.

struct ShellTouch {
  bool found = false;
  double reach = 0;                 // distance from the axis of balls that touch the shell [px]
  double shift_u = 0, shift_v = 0;  // from the detected to the true centres: shading moves all balls alike [px]
  int count = 0;                    // sightings that say so
};

// Where balls of one size class stop: the outermost crowd of centres that does not go all the way round (bolts do).
ShellTouch find_shell_touch(const std::vector<std::vector<Detection>>& frames, int size_class, const Circle& centre);

// Commonest distance between neighbours of one size class [px]: twice the radius, as far as they touch. 0 if too few.
double contact_distance(const std::vector<std::vector<Detection>>& frames, int size_class);

}  // namespace tumble::analysis
