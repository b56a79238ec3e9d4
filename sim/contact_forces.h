#pragma once
#include "sim/running_mill.h"

namespace tumble::sim {

// Forces between balls, and of shell and lifters on the balls, at the mill's present step: into charge.fx, fy, moment;
// losses, torque and ended impacts into the ledger. The near lists are fresh. Throws WorkError where two bodies overlap
// by more than half a radius.
void ball_forces(RunningMill& mill);
void wall_forces(RunningMill& mill);

}  // namespace tumble::sim
