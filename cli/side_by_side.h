#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/steps.h"
#include "io/run_file.h"

namespace tumble::cli {

// How two mills are shown in step: A's clock, begun `a_from` seconds after its first frame, and B's, which begins
// `b_from` after its own and runs `pace` times as fast.
struct InStep {
  double a_from = 0, b_from = 0, pace = 1;
  bool by_lifters = false;  // begun with the lifters in the same place
  bool by_angle = false;    // and kept so, by the angle of the mills; else by the clock

  double b_at(double a_time) const { return b_from + pace * (a_time - a_from); }
};

// By the lifters where both are known; by the angle where the mills turn alike but for 2 %, or one has no clock.
InStep in_step(const ChargeMotion& a, const ChargeMotion& b);

// Small films, for pages: their rate [pictures per second], x264's crf, one after the other until the file is small
// enough, and how large that is [bytes].
inline constexpr double kSmallRate = 30;
inline constexpr double kSmallQuality[] = {26, 32, 38};
inline constexpr std::uintmax_t kSmallSize = 6u << 20;

struct Stretch {
  double from = 0;     // after the source's first frame [s]
  double seconds = 0;  // of its own time
  double step = 0;     // between pictures, likewise
};

double mean_of(const std::vector<double>& values);
double span_of(const ChargeMotion& motion);        // from its first frame to its last [s]
double seconds_shown(const ChargeMotion& motion);  // of that: no more than three turns
// So many seconds, as slowly as makes them last, and no more pictures than a page bears.
Stretch stretch_of(double from, double seconds);
// The film's frames nearest to each moment.
std::vector<int> frames_of(const ChargeMotion& film, const Stretch& stretch);

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

// Small films of both that keep step over the same stretch of true time.
SideBySide small_films(const Shown& a, const Shown& b, const fs::path& folder, const CommonOptions& options);

}  // namespace tumble::cli
