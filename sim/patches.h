#pragma once
#include "sim/running_mill.h"

// How the work of a step is cut up into patches, and dealt out to threads. It changes no bit of what is simulated.
namespace tumble::sim {

// Patches of about so many balls, fewer where there are many threads.
void cut_up(RunningMill& mill, int threads, int balls_per_patch);

// After a search: which patches wait for which, and as much work for each thread.
void share_out(RunningMill& mill);

}  // namespace tumble::sim
