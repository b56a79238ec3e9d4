#pragma once
#include <vector>

#include "analysis/charge_statistics.h"
#include "core/charge_motion.h"

namespace tumble::analysis {

// What the places in a film are wrong by all together, and which therefore does not average out: standard errors.
struct SharedErrors {
  double axis = 0;   // of the mill's axis, along x and along y [m]
  double scale = 0;  // of all lengths, relative
  double roll = 0;   // of the camera [rad]
};

// Adds these errors to those that `motion` has from scatter in time: what depends on them is measured again from its
// tracks with axis, scale and roll off by one standard error, to both sides. `geometry`, `hidden` and, by frame,
// `unseen` as they were for the motion; what paths bridge is added once.
void add_shared_errors(ChargeMotion& motion, const MillGeometry& geometry, const std::vector<bool>& hidden,
                       const FrameSpool<TrackPoint>& unseen, const SharedErrors& errors);

}  // namespace tumble::analysis
