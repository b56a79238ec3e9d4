#pragma once
#include "core/charge_motion.h"
#include "core/deviation.h"

namespace tumble::diagnose {

// Every quantity that summary.json names and that at least one of the two has: b - a with standard error and z.
Deviation compare(const ChargeMotion& a, const ChargeMotion& b);

}  // namespace tumble::diagnose
