#pragma once
#include <vector>

#include "analysis/drum_reader.h"
#include "analysis/drum_rings.h"
#include "core/config.h"

namespace tumble::analysis {

// Lengths in pixels at the mill's origin.

// What moves at each radius of the unrolled ring [grey levels].
struct RadialProfile {
  std::vector<double> texture;  // deviation of what turns with the drum
  std::vector<double> charge;   // deviation of what does not, noise included
};
RadialProfile radial_profile(const DrumReader& reader);

struct ShellGuess {
  double radius = 0;     // of the shell in the plane z = 0; 0 where nothing tells
  double deviation = 0;  // its standard error, as a share
  bool on_ring = false;  // an edge goes round there
};

// Nothing but the charge moves by itself, and it reaches as far as the shell: there what moves without turning with the
// drum ends. A ball that touches glass and shell is seen up to R d / (d + r) in the plane of the glass, `distance` d of
// the camera, r the ball's radius in shell radii. An edge that goes round near that is the shell's.
ShellGuess find_shell(const RadialProfile& profile, const PolarGrid& grid, const std::vector<RingEdgePoints>& rings,
                      double distance, double ball_share);

// Lifters by what repeats round the drum between two radii; 0 where nothing does.
int count_lifters(const DrumReader& reader, double inner, double outer);

// Angle of one lifter's middle at drum angle 0 [rad], in [0, spacing); NaN where it does not show. Lifters are where
// the picture, turned back with the drum, changes least: balls pass before everything else.
double lifter_angle(const DrumReader& reader, const std::vector<cv::Mat>& strips, const std::vector<double>& angles,
                    int count, double inner, double outer);

}  // namespace tumble::analysis
