#pragma once
#include <vector>

#include "analysis/ball_detector.h"

namespace tumble::analysis {

// Sizes read off the balls themselves: they touch the shell and one another.

struct Contacts {
  double distance = 0;  // commonest between centres of neighbours of one class: twice the radius [px]; 0 if unknown
  int pairs = 0;        // sightings that say so
};

Contacts find_contacts(const std::vector<std::vector<Detection>>& frames, int size_class);

// From detected centres to true ones, in radii, v down: light from one side moves the rims of all balls in proportion
// to their size.
struct LightShift {
  bool found = false;
  double u = 0, v = 0;
};

// From balls of unequal size that touch: the larger one is moved further, so the distance at which they seem to touch
// depends on the direction from one to the other. `radii`: of all classes [px]. Not found for a charge of one size.
LightShift find_light_shift(const std::vector<std::vector<Detection>>& frames, const std::vector<double>& radii);

struct ShellTouch {
  bool found = false;
  double reach = 0;                 // distance from the axis of balls that touch the shell [px]
  double shift_u = 0, shift_v = 0;  // from the detected to the true centres: shading moves all balls alike [px]
  int count = 0;                    // sightings that say so
};

// Where the balls of one class stop: the outermost crowd of their centres between `least` and `most` from the centre.
// `radii`: of all classes [px]. A crowd whose members touch nothing is no charge: bolts, rivets, marks.
ShellTouch find_shell_touch(const std::vector<std::vector<Detection>>& frames, int size_class,
                            const std::vector<double>& radii, const Circle& centre, double least, double most);

}  // namespace tumble::analysis
