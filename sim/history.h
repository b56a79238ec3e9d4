#pragma once
#include <cstdint>
#include <vector>

#include "sim/mill.h"

namespace tumble::sim {

// Course of a run, sampled evenly in mill angle: what "steady" is judged by.
inline constexpr int kSamplesPerRevolution = 32;

struct History {
  std::vector<double> torque;   // mean over each sample's interval [N m]
  std::vector<double> closure;  // M g x_com, likewise [N m]
  std::vector<double> locked;   // balls that turn with the shell
  std::size_t size() const { return torque.size(); }
};

// Finds balls that turn with the shell: their angle in the mill's frame stays within one lifter pitch (no more than 30
// degrees) for a whole revolution. Any other ball of a charge turns back by a revolution meanwhile.
struct LockedBalls {
  std::vector<double> home;   // angle in the mill's frame when last seen to move on [rad]
  std::vector<double> since;  // mill angle at that moment [rad]
  int count = 0;
};
void look_for_locked_balls(const Mill& mill, LockedBalls& locked);

// Verdict over a stretch of the history.
struct Steadiness {
  bool steady = true;
  double torque_z = 0, closure_z = 0;  // drift between the halves in standard errors
  double locked_change = 0;            // balls locked meanwhile (means of the last and first quarter)
};
Steadiness judge(const History& history, std::size_t from, std::size_t to, std::size_t balls, double z_limit);

}  // namespace tumble::sim
