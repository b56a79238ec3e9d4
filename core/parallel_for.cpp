#include "core/parallel_for.h"

#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>

namespace tumble {
namespace {
std::unique_ptr<tbb::global_control> g_limit;  // lives as long as the process: oneTBB forgets the limit with it
}

void limit_threads(int count) {
  g_limit.reset();
  if (count > 0) {
    g_limit = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism, count);
  }
}

int thread_limit() {
  const auto limit = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  return std::max(1, std::min(static_cast<int>(limit), tbb::info::default_concurrency()));
}

void parallel_for(std::size_t count, std::size_t grain, const std::function<void(std::size_t, std::size_t)>& body) {
  const std::size_t ranges = (count + grain - 1) / grain;
  if (ranges <= 1 || thread_limit() == 1) {
    for (std::size_t r = 0; r < ranges; ++r) body(r * grain, std::min(count, (r + 1) * grain));
    return;
  }
  // A thread that waits for the others may not begin another task meanwhile, such as a whole run of a sweep.
  tbb::this_task_arena::isolate([&] {
    tbb::parallel_for(std::size_t{0}, ranges,
                      [&](std::size_t r) { body(r * grain, std::min(count, (r + 1) * grain)); });
  });
}

}  // namespace tumble
