#pragma once
#include <functional>

#include "core/config.h"
#include "core/experiments.h"
#include "trials/trial.h"

// What is hidden in each trial, by chance alone.
namespace tumble::trials {

struct DrawPlan {
  Config mill;                          // as it is handed out
  std::vector<UncertainKey> uncertain;  // the truth lies off by up to two of their standard deviations
  std::vector<Kind> kinds;              // each equally often
  Tier tier = Tier::kTracks;
  std::size_t n = 0;
};

// Whatever hides within a kind comes equally often, too; the order is by chance. `entropy`: 64 random bits at every
// call. Throws InputError for a kind of which this mill or this data can have none.
std::vector<TrialKey> draw_keys(const DrawPlan& plan, const std::function<std::uint64_t()>& entropy);

}  // namespace tumble::trials
