#pragma once
#include "sim/running_mill.h"

namespace tumble::sim {

// Contacts of a patch at the balls' present positions: their forces into the share's rows, their losses into its
// sums, and what has begun and ended. Throws WorkError where bodies overlap by more than half a radius.
void contact_forces(const RunningMill& mill, const ChargeView& balls, Patch& patch, Share& share);

// Books what began and ended in all shares: impacts and falls.
void book_events(RunningMill& mill);

}  // namespace tumble::sim
