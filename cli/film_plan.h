#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include "core/charge_motion.h"
#include "io/film_file.h"
#include "io/run_file.h"
#include "render/renderer.h"

namespace tumble::cli {

struct FilmPlan {
  render::Style style;
  io::FilmFormat format;
  // What of the run is shown: after its first frame [s]; not given: all of it.
  double from = 0, seconds = kNotGiven;
  double every = kNotGiven;  // true time between pictures [s]; not given: what rate and slowness make of it
  double at = kNotGiven;     // a still: after the first frame [s]; not given: in the middle of what is shown
  bool is_still = false;
};

// One run of a film.
struct Shot {
  const io::RunReader* run = nullptr;
  const ChargeMotion* truth = nullptr;  // gives the toe and shoulder marks; may be null
  std::string label;                    // what tells it from the others, where there are several
  double begin = 0;                     // what counts as its first moment: its own time [s]
};

// When pictures are taken: after the shots' beginnings [s].
struct Timeline {
  double first = 0, step = 0;
  std::size_t count = 0;
  double at(std::size_t i) const { return first + static_cast<double>(i) * step; }
};

// The film ends with its shortest run. Throws InputError where the plan leaves the runs.
Timeline timeline_of(const std::vector<Shot>& shots, const FilmPlan& plan);

// The runs begin with a lifter where the first one has one. Labels say what differs between the configs, else the
// files' names.
std::vector<Shot> shots_side_by_side(const std::vector<io::RunReader>& runs, const std::vector<ChargeMotion>& truths);

}  // namespace tumble::cli
