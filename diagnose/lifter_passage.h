#pragma once
#include <span>
#include <vector>

#include "core/charge_motion.h"

// Torque over a lifter's passage: the mean over all passages at the same place of the lifters, which are the only clock
// that two mills have in common. No frame is compared with a frame.
namespace tumble::diagnose {

struct OverPassage {
  std::vector<double> past_deg;               // a lifter's angle past 3 o'clock; the middle of each place
  std::vector<std::vector<Estimate>> torque;  // by motion, then place [N m of one slice]
};

// Of motions whose profile tells the mill's angle at the times of their torque series, which is taken to be the mean
// since the row before. Empty where they have not the same number of lifters, or one has too few rows a passage.
OverPassage torque_over_passage(std::span<const ChargeMotion* const> motions);

}  // namespace tumble::diagnose
