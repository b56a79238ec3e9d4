#pragma once
#include <cstdint>

#include "core/checkpoint.h"
#include "sim/history.h"
#include "sim/running_mill.h"

namespace tumble::sim {

// Means between two events of a run.
struct Sums {
  double torque = 0, torque_shear = 0, torque_external = 0, mass_moment = 0;
  long steps = 0;
};

// A run at one moment: the mill and how far the plan has come. All that a checkpoint must hold.
struct RunState {
  RunningMill mill;
  History history;
  LockedBalls locked;
  Sums frame, sample;                // since the last frame, since the last sample
  double work_at_frame = 0;          // drive work up to the last frame [J]
  std::int64_t averaging_from = -1;  // step at which the averaged revolutions began; -1 during spin-up
  std::int64_t sampled_before = 0;   // history samples of the spin-up
  std::int64_t frames_written = 0;
  bool spin_up_gave_up = false;  // "auto" reached its longest
};

// The state as words, which stay where they are until they are told, and back into a state that was made from the same
// config. The near lists are not kept: renewing them changes no bit.
Checkpoint checkpoint_of(const RunState& run);
void restore(RunState& run, const StoredCheckpoint& stored);

// Upper bound of the number of words for so many balls, history samples and lifters.
std::size_t most_words(std::size_t balls, std::size_t samples, std::size_t lifters);

}  // namespace tumble::sim
