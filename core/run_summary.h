#pragma once
#include <vector>

#include "core/statistics.h"

namespace tumble {

// What a run comes to in a few numbers, over its written frames; of one slice unless it says mill.
struct RunSummary {
  Estimate torque;           // [N m]
  Estimate torque_closure;   // M g x_com [N m]
  Estimate torque_external;  // of fluid and pool on the charge [N m]
  Estimate power;            // of the drive [W]
  double slices = 1;
  Estimate mill_torque, mill_power;   // the slice's times slices; the error too
  std::vector<Estimate> dissipation;  // by cause [W], in the order of RunSetup::dissipation_causes
  double stored_power = kNotGiven;    // growth of kinetic + potential + elastic energy per second [W]
  double ball_impacts = kNotGiven, wall_impacts = kNotGiven;  // [1/s]
  double energy_error = kNotGiven;  // (drive work - change of energy - dissipation) / drive work, over the frames
  double locked_balls = 0;          // in the last frame

  // By frame, for plots.
  std::vector<double> time;      // [s]
  std::vector<double> locked;    // balls
  std::vector<double> external;  // torque_external [N m]
};

}  // namespace tumble
