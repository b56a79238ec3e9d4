#pragma once
#include <cstddef>
#include <functional>

#include "core/progress.h"

namespace tumble::diagnose {

// Works through 0 ... count - 1 on all threads: whoever is free takes the next, since pieces differ in length and a
// fixed division would leave cores idle. `work` reports its own share; the whole's is passed on, never by two threads
// at once. What `work` throws ends it all.
void in_turns(std::size_t count, const Progress& progress,
              const std::function<void(std::size_t piece, const Progress& own)>& work);

}  // namespace tumble::diagnose
