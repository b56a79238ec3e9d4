#pragma once
#include <array>
#include <string>

#include "core/motion_quantities.h"

namespace tumble {

// What is kept of one run among many: no frames, only numbers. Of one slice unless it says mill.
struct RunOutcome {
  std::string error;  // why the run failed, in one line; empty where it did not, and only then is the rest there

  std::array<Estimate, kMotionQuantities.size()>
      motion;                       // in the order of kMotionQuantities: torque, toe, shoulder ...
  Estimate power;                   // [W]
  double slices = kNotGiven;        // from one slice to the mill
  double energy_error = kNotGiven;  // (drive work - change of energy - dissipation) / drive work, over the frames
  double locked_balls = kNotGiven;  // in the last frame
  double spin_up_revolutions = kNotGiven;
  bool steady = false;
};

// Where a quantity of summary.json stands in RunOutcome::motion: a name that is not there does not compile.
consteval std::size_t motion_index(const char* name) {
  for (std::size_t i = 0; i < kMotionQuantities.size(); ++i) {
    const char *a = kMotionQuantities[i].name, *b = name;
    while (*a && *a == *b) ++a, ++b;
    if (*a == *b) return i;
  }
  throw "no such quantity";
}

inline const Estimate& torque_of(const RunOutcome& run) { return run.motion[motion_index("torque_N_m")]; }

}  // namespace tumble
