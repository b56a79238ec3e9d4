#pragma once
#include "core/frame.h"

namespace tumble {

// The state between two frames of one run as a film shows it: `between`, and where frames are so sparse that two paths
// cross, the balls pushed apart: no pair overlaps by much more than in one of the frames, or a tenth of its smaller
// radius. A flight stays exact; elsewhere `between` is off by at most 4/27 of the frames' distance in time times the
// velocity that contacts change meanwhile (the largest value of the cubic's Peano kernel).
Frame slow_motion(const Frame& a, const Frame& b, const Balls& balls, double time);

}  // namespace tumble
