#pragma once
#include <span>

#include "core/charge_motion.h"
#include "core/config.h"
#include "diagnose/measurement.h"

namespace tumble::diagnose {

// The motion of balls seen frame by frame, by the analysis' own path: their toe is what a film's or a run's toe is.
// Balls whose radius is not known are left out. Velocities are differences between neighbouring frames.
ChargeMotion motion_of(std::span<const SeenFrame> frames, const Config& mill);

// Of one turn [rad/s]; by the mill's angle where frames tell it, else as the config has it.
double turning_speed(std::span<const SeenFrame> frames, const Config& mill);

}  // namespace tumble::diagnose
