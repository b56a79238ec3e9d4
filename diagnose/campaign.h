#pragma once
#include <cstddef>
#include <functional>
#include <vector>

#include "core/config.h"
#include "core/progress.h"
#include "core/run_outcome.h"

// Many independent runs, one per core at a time.
namespace tumble::diagnose {

// Simulates one mill and measures its frames as they come; none is kept. A run that fails, by its config or by leaving
// physics, comes back with the reason in `error`; only Interrupted passes.
RunOutcome run_once(const Config& config, const Progress& progress = {});

struct CampaignSink {  // any may be empty; never called by two threads at once
  // Is there a result of this run already? Then it is not run again.
  std::function<bool(std::size_t run, RunOutcome& outcome)> known;
  std::function<void(std::size_t run, const Config& config, const RunOutcome& outcome)> finished;
  Progress progress;  // share of the whole campaign; may throw Interrupted, which ends it
};

// Runs config_of(0) ... config_of(count - 1), which is called when the run begins, so that a million configs need no
// memory, and by several threads at once. Outcomes in the order of the configs, whatever the number of threads.
std::vector<RunOutcome> run_campaign(std::size_t count, const std::function<Config(std::size_t)>& config_of,
                                     const CampaignSink& sink = {});

}  // namespace tumble::diagnose
