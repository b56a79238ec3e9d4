#pragma once
#include <vector>

#include "core/charge_motion.h"
#include "core/deviation.h"

namespace tumble::diagnose {

// Paths of single balls for a turn about the centre of circulation, one for each of a few shares of all turns by how
// far from the centre they pass through the bed: balls of two mills are never the same, but the turn that, say, half
// of all turns stay inside of is. From the first `seconds` of the motion. Nothing where no ball was followed all round.
std::vector<BallPath> typical_paths(const ChargeMotion& motion, double seconds = 30);

}  // namespace tumble::diagnose
