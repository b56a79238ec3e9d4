#pragma once
#include <span>

#include "render/canvas.h"

namespace tumble::render {

// The torque of a whole run with a cursor at one moment of it.
struct TorqueTrace {
  std::span<const double> time, torque;  // [s], [N m]
  double passage = 0;                    // running mean over this time, one lifter passage [s]
  double now = 0;                        // [s]
};

// The running mean at time `now` [N m]; NaN without a trace.
double running_torque(const TorqueTrace& trace);
double mean_torque(const TorqueTrace& trace);  // NaN without a trace

// Plot with its axes inside `box`: the band from smallest to largest, the running mean, the whole run's mean, the
// cursor. Nothing for a trace of fewer than two samples.
void draw_torque_plot(Canvas& canvas, const Box& box, const TorqueTrace& trace);

}  // namespace tumble::render
