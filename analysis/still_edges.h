#pragma once
#include "analysis/toe_shoulder.h"

namespace tumble::analysis {

// Toe and shoulder of a single still, or of the mean of a few, with errors from the picture alone: what the charge's
// ring shows of gaps and clusters between the edges could as well have been at them. `width`: of the box, one lifter
// spacing [bins]; `ball`: mean diameter as seen from the axis, within which occupancy is one ball's [degrees].
EdgeEstimates edges_of_still(const RingProfile& profile, int width, double ball);

}  // namespace tumble::analysis
