#pragma once
#include <vector>

#include "diagnose/measurement.h"

// By how much the places of tracked balls err from frame to frame, and what more of it would do.
namespace tumble::diagnose {

// Standard deviation of x, and of y [m]: by the third differences of four places in a row, which for balls that ride
// with the drum or fly are next to nothing but noise. The median over all balls and frames, so that impacts do not
// count. NaN where too few are seen. Errors that persist from frame to frame are not counted.
double noise_of_places(const std::vector<SeenFrame>& frames);

// The frames with more noise of that size. The same frames give the same.
std::vector<SeenFrame> noisier(std::vector<SeenFrame> frames, double noise);

}  // namespace tumble::diagnose
