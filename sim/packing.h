#pragma once
#include "core/config.h"
#include "core/progress.h"
#include "sim/charge.h"
#include "sim/mill_model.h"

namespace tumble::sim {

// The balls that the config asks for, classes shuffled by run.seed.
Balls draw_balls(const Config& config);

// Lays the balls loosely into the lower part of the resting mill (angle 0), without overlap; positions by run.seed.
// Throws InputError when they do not fit.
Charge place_loosely(const Config& config, const MillModel& model, const Balls& balls);

// Lets the charge fall and come to rest in the resting mill, `longest_settling` [s] at most. Returns it with velocities
// zero.
double longest_settling(const MillModel& model);
Charge settle(const MillModel& model, Charge charge, const Progress& progress);

}  // namespace tumble::sim
