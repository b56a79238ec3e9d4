#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "cli/steps.h"
#include "io/run_file.h"

namespace tumble::cli {

// One of two sources, as far as it can be shown as a film: a run, or a film file; neither for anything else.
struct Shown {
  const ChargeMotion* motion = nullptr;
  const io::RunReader* run = nullptr;
  fs::path film;

  bool any() const { return run != nullptr || !film.empty(); }
};

struct SideBySide {
  fs::path a, b;  // files in a folder of the caller's; empty where there is none
  std::string a_caption, b_caption;
  std::string note;  // how they keep step
  double rate = 30;  // pictures per second
  double slow = 1;   // times slower than true time
};

// Small films of both that keep step: the same stretch of true time, begun with the lifters in the same place; where
// the mills turn alike but for 2 %, by their angle, so that they stay so.
SideBySide small_films(const Shown& a, const Shown& b, const fs::path& folder, const CommonOptions& options);

}  // namespace tumble::cli
