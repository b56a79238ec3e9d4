#pragma once
#include <functional>

#include "trials/draw.h"
#include "trials/trial_data.h"

// A folder of blind trials.
namespace tumble::trials {

struct MakePlan {
  DrawPlan draw;  // its mill and what is uncertain are the laboratory's
  LabPlan lab;
  std::filesystem::path data, keys;
};

// Keys first, into `keys`; then their seals, into `data`; then the data, trial by trial, one per core at a time.
// Neither folder may hold anything, unless it is gone on with what is there, by the keys that are there, or trials that
// are there are taken away first. Progress may throw Interrupted: finished trials stay. Throws InputError.
enum class IfThere { kRefuse, kResume, kReplace };
void make_trials(const MakePlan& plan, const std::function<std::uint64_t()>& entropy, IfThere if_there,
                 const Progress& progress);

}  // namespace tumble::trials
