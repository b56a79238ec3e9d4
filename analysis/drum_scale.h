#pragma once
#include <vector>

#include "analysis/drum_reader.h"
#include "analysis/drum_rings.h"
#include "core/config.h"

namespace tumble::analysis {

// Lengths in pixels at the mill's origin.

struct ShellGuess {
  double radius = 0;     // of the shell; 0 where nothing tells
  double deviation = 0;  // its standard error, as a share
  bool on_ring = false;  // an edge goes round there in the plane z = 0
};

// Nothing but the charge moves by itself, and it reaches as far as the shell: there what moves without turning with the
// drum ends, direction by direction. A ball that touches shell and glass is seen up to the shell in the plane of its
// centre, `ball` behind the glass, unless the shell's front hides it. An edge that goes round near there is the
// shell's.
ShellGuess find_shell(const DrumReader& reader, const std::vector<RingEdgePoints>& rings, double ball);

// Lifters by what repeats round the drum between two radii; 0 where nothing does.
int count_lifters(const DrumReader& reader, double inner, double outer);

// Angle of one lifter's middle at drum angle 0 [rad], in [0, spacing); NaN where it does not show. Lifters are where
// the picture, turned back with the drum, changes least: balls pass before everything else.
double lifter_angle(const DrumReader& reader, const std::vector<cv::Mat>& strips, const std::vector<double>& angles,
                    int count, double inner, double outer);

}  // namespace tumble::analysis
