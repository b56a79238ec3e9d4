#pragma once
#include <cstdint>
#include <vector>

#include "sim/running_mill.h"

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
void look_for_locked_balls(const RunningMill& mill, LockedBalls& locked);

// Verdict over a stretch of the history: no drift of torque or centre of mass beyond z_limit standard errors, and no
// pocket filled or emptied meanwhile. Locked balls tell most: three of them cost 1 % of the torque, far less than the
// scatter of a few revolutions, but they add up over dozens.
struct Steadiness {
  bool steady = true;
  double torque_z = 0, closure_z = 0;  // drift between the halves in standard errors
  double locked_change = 0;            // balls locked since the first quarter of the stretch
};
Steadiness judge(const History& history, std::size_t from, std::size_t to, std::size_t balls, double z_limit);

}  // namespace tumble::sim
