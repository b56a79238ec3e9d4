#pragma once
#include <vector>

#include "analysis/tracking.h"

namespace tumble::analysis {

// Spins of balls that carry a mark (a line, dots, a painted half) from how their look turns; fills Sighting::spin and
// spin_se [rad/frame], counter-clockwise as the places are, NaN where no mark tells. Wants tracks and places as seen,
// before anything is mirrored. `turn`: of the drum per frame [rad].
//
// What lamps paint on all balls alike stands still in the picture: harmonics regressed on place are taken off first.
// What is left of a ball in three neighbouring frames, d_k, is held against a pattern T that turns evenly,
// d_k = T exp(-i m w t_k): its best T is a mean, so the fit is one search over w, with no template, no unwrapping and
// no state. Three frames, because balls are struck: over longer stretches a spin is not even. Weaker marks get longer
// stretches where these turn evenly. A mark that maps onto itself by part of a turn fits several w: it is the one that
// rolling at the balls' usual speeds makes likely, or none if two are.
//
// A ball is marked when its pattern stands out in brightness and above what spoils patterns in this film, and marks
// are believed at all when, with the class's other marked balls, they are seen to turn otherwise than picture and drum.
void measure_spins(std::vector<SeenFrame>& frames, double turn);

}  // namespace tumble::analysis
