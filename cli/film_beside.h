#pragma once
#include <string>

#include "cli/film_input.h"
#include "cli/steps.h"
#include "render/beside.h"

namespace tumble::cli {

// A run beside or over a real film: what the user asks for.
struct BesidePlan {
  fs::path run;   // its file, to be named
  fs::path film;  // a film, a folder of stills or one, or the MOTION.h5 that was made of it
  FilmInput input;
  std::string view = "side";
  double wipe = kNotGiven;      // share of the square that shows the film; NaN: the line sweeps
  double run_from = kNotGiven;  // where in the run the film begins [s]; NaN: with the lifters in phase
  double opacity = 0.12;
  double passages = 1;      // of lifters, that a difference is a running mean over
  bool rate_given = false;  // film.format's; else the film's own
  FilmPlan picture;
};

struct BesideResult {
  std::size_t frames = 0;
  double frames_per_second = kNotGiven;                // of the film that was written
  double run_from = kNotGiven, pace = kNotGiven;       // where the run begins [s], and its clock against the film's
  double only_film = kNotGiven, only_run = kNotGiven;  // last difference
};

// `output` as in render_run: a film or a folder.
BesideResult render_beside(const io::RunReader& run, BesidePlan plan, const fs::path& output,
                           const CommonOptions& options);

// The verb `render`. A program that cannot read films gives nullptr, and --beside is refused.
using RenderBeside = BesideResult (*)(const io::RunReader&, BesidePlan, const fs::path&, const CommonOptions&);
void add_render(CLI::App& app, RenderBeside beside);

}  // namespace tumble::cli
