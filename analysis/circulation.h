#pragma once
#include "analysis/velocity_field.h"
#include "core/charge_motion.h"

namespace tumble::analysis {

// Mean time of a full turn of a ball about the centre of circulation [s]: 2 pi over the mean angular speed of balls in
// the charge, whose tracks are followed from frame to frame. `least`: from the centre; nearer to it, noise turns.
// NaN where there is no centre or balls do not turn with the mill.
Estimate circulation_time(const Spool<TrackPoint>& tracks, const FieldStatistics& field, double centre_x,
                          double centre_y, double least);

}  // namespace tumble::analysis
