#include "diagnose/in_turns.h"

#include <algorithm>
#include <atomic>
#include <mutex>

#include "core/parallel_for.h"

namespace tumble::diagnose {

void in_turns(std::size_t count, const Progress& progress,
              const std::function<void(std::size_t piece, const Progress& own)>& work) {
  std::mutex telling;
  double done = 0;
  std::atomic<std::size_t> next = 0;
  const auto turn = [&](std::size_t, std::size_t) {
    for (std::size_t i = next++; i < count; i = next++) {
      double own = 0;
      const auto advance = [&](double share) {
        const std::lock_guard lock(telling);
        done += share - own;
        own = share;
        report(progress, done / double(count));
      };
      work(i, advance);
      advance(1);
    }
  };
  parallel_for(std::min(count, static_cast<std::size_t>(thread_limit())), 1, turn);
}

}  // namespace tumble::diagnose
