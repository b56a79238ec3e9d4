#pragma once
#include "core/config.h"
#include "core/experiments.h"
#include "core/sweep.h"
#include "io/plot_page.h"

namespace tumble::io {

// The figures of a sweep: torque, power, toe, shoulder ... against the varied key that has most numbers, a line for
// each combination of the others, with what was measured where it is at one of the key's values or between them.
PlotPage sweep_page(const Sweep& sweep, const Config& mill, const Experiments& measured);

}  // namespace tumble::io
