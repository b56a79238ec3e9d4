#pragma once
#include <filesystem>
#include <functional>
#include <string>

#include "analysis/charge_motion.h"
#include "cli/console.h"
#include "core/charge_motion.h"
#include "io/film_file.h"
#include "io/run_file.h"
#include "render/renderer.h"

// The steps of the one path that have to do with pictures, each from files to files, shared by the verbs and by `tumble
// run` that strings them up.
namespace tumble::cli {

namespace fs = std::filesystem;

// The charge's true motion, from a run file.
ChargeMotion measure_run(const io::RunReader& run, const CommonOptions& options);

// Top of the colour scale: what one ball in a hundred exceeds, so that a single impact does not darken the film.
double scale_top(const io::RunReader& run, render::Colour colour);

struct FilmPlan {
  render::Style style;
  io::FilmFormat format;
  // What of the run is shown: after its first frame [s]; not given: all of it.
  double from = 0, seconds = kNotGiven;
};

// Of a PNG in a folder of pictures: frame_000000.png.
std::string picture_name(std::size_t index);

// Renders a run as a film (`output` is a file) or as numbered PNGs (`output` is a folder that exists). `truth` gives
// the toe and shoulder marks. Returns the number of pictures.
std::size_t render_run(const io::RunReader& run, const ChargeMotion& truth, const FilmPlan& plan,
                       const fs::path& output, bool as_pictures, const CommonOptions& options);

// The one door for all inputs: run file, folder of stills, film, tracks in pixels (.csv). What only tracks need is not
// looked at for others.
ChargeMotion measure(const fs::path& input, const analysis::TracksOptions& film, const CommonOptions& options);

}  // namespace tumble::cli
