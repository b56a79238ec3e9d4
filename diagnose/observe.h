#pragma once
#include "diagnose/measurement.h"
#include "diagnose/observation.h"

namespace tumble::diagnose {

// The numbers of an experiment, as an observer sees them who is the measurement's own for all zeros: to see what it
// would be without an error, look with the opposite one. `torque_offset` is taken off the torque [N m of one slice].
// NaN where the experiment does not tell; `noise` is what the measurement's own uncertainty makes of each number.
Observation observe(const Measurement& measurement, const ObservationLayout& layout, double span,
                    const Observer& observer = {}, double torque_offset = 0);

// The span of velocities that these frames can show: a multiple of their spacing, 4 ms at least; NaN without frames.
double span_of(const Measurement& measurement);

}  // namespace tumble::diagnose
