#pragma once
#include "core/frame.h"

namespace tumble {

// The state between two frames of one run as a film shows it: `between`, and where frames are so sparse that two paths
// cross, the balls pushed apart: no pair overlaps by much more than in one of the frames, or a tenth of its smaller
// radius. A flight stays exact; docs/conventions.md says how well the rest is met.
Frame slow_motion(const Frame& a, const Frame& b, const Balls& balls, double time);

}  // namespace tumble
