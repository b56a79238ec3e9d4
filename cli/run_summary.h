#pragma once
#include <string>

#include "core/statistics.h"
#include "io/run_file.h"

namespace tumble::cli {

// What a run comes to in a few numbers; of one slice unless it says mill.
struct RunSummary {
  Estimate torque;          // [N m]
  Estimate torque_closure;  // M g x_com [N m]
  Estimate power;           // [W]
  Estimate mill_power;      // [W]
  double slices = 1;
  double energy_error = kNotGiven;  // (drive work - change of energy - dissipation) / drive work, over the frames
  double locked_balls = 0;          // in the last frame
};

RunSummary summarise(const io::RunReader& run);
std::string to_json(const RunSummary& summary, const io::RunReader& run);

}  // namespace tumble::cli
