#include "cli/run_player.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/slow_motion.h"

namespace tumble::cli {

Frame RunPlayer::at(double time) {
  const std::vector<double>& times = run_.time();
  const auto after = std::upper_bound(times.begin(), times.end(), time + 1e-9);
  const std::size_t i = after == times.begin() ? 0 : static_cast<std::size_t>(after - times.begin()) - 1;
  load(i);
  if (i + 1 >= times.size()) return a_;
  return time - times[i] < 1e-9 ? a_ : slow_motion(a_, b_, run_.setup().balls, time);
}

void RunPlayer::load(std::size_t i) {
  if (i == index_) return;
  const bool next = index_ != kNone && i == index_ + 1;
  index_ = i;
  if (next)
    std::swap(a_, b_);
  else
    a_ = run_.frame(i);
  if (i + 1 < run_.frame_count()) b_ = run_.frame(i + 1);
}

}  // namespace tumble::cli
