#pragma once
#include <cstddef>

#include "io/run_file.h"

namespace tumble::cli {

// The run at any time: keeps the two stored frames round it.
class RunPlayer {
 public:
  explicit RunPlayer(const io::RunReader& run) : run_(run) {}

  Frame at(double time);

 private:
  void load(std::size_t i);

  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);
  const io::RunReader& run_;
  std::size_t index_ = kNone;
  Frame a_, b_;
};

}  // namespace tumble::cli
