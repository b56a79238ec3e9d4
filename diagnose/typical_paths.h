#pragma once
#include <span>
#include <vector>

#include "core/charge_motion.h"
#include "core/deviation.h"

namespace tumble::diagnose {

// Paths of single balls for a turn about the centre of circulation, one for each of a few shares of all turns by how
// far from the centre they pass through the bed: balls of two mills are never the same, but the turn that, say, half
// of all turns stay inside of is. From the first `seconds` of the motion. Nothing where no ball was followed all round.
std::vector<BallPath> typical_paths(const ChargeMotion& motion, double seconds = 30);

// Paths of given balls, from where each was first followed without a gap for `seconds`, or else its longest stretch.
// Throws InputError where the motion has no such ball.
std::vector<BallPath> paths_of(const ChargeMotion& motion, std::span<const int> balls, double seconds = 2);

}  // namespace tumble::diagnose
