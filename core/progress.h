#pragma once
#include <functional>

namespace tumble {

// Called now and then with the share done in [0, 1]. It may throw Interrupted: whoever calls it must be safe to leave.
using Progress = std::function<void(double done)>;

inline void report(const Progress& progress, double done) {
  if (progress) progress(done);
}

}  // namespace tumble
