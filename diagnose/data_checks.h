#pragma once
#include "diagnose/measurement.h"

namespace tumble::diagnose {

// Refuses data that cannot be this mill's: lengths or times in another unit, another direction of rotation or of up,
// the film of another speed, another number of lifters or balls, a torque that the seen charge cannot need. What a
// suspect of the diagnosis may do to data is let through. Throws InputError with the numbers and what would be right.
void check_data(const Measurement& m);

}  // namespace tumble::diagnose
