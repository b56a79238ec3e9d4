#pragma once
#include "core/charge_motion.h"
#include "core/deviation.h"

namespace tumble::diagnose {

// Everything that at least one of the two has: b - a with standard error and z, what of it is beyond chance, one number
// for the whole and a verdict (docs/compare.md). Time averages are compared, never one frame with another.
//
// Mills of other diameters (by more than 2 %) are compared in what has no length in it: angles, shares, occupancy in
// units of the mill's radius.
Deviation compare(const ChargeMotion& a, const ChargeMotion& b);

}  // namespace tumble::diagnose
