#pragma once
#include <filesystem>
#include <vector>

#include "analysis/charge_motion.h"
#include "cli/console.h"
#include "cli/film_plan.h"
#include "core/charge_motion.h"
#include "io/run_file.h"

// The steps of the one path that have to do with pictures, each from files to files, shared by the verbs and by `tumble
// run` that strings them up.
namespace tumble::cli {

namespace fs = std::filesystem;

// The charge's true motion, from a run file.
ChargeMotion measure_run(const io::RunReader& run, const CommonOptions& options);

// Of it, toe and shoulder frame by frame: what their marks need.
std::vector<ProfileRow> measure_run_edges(const io::RunReader& run, const CommonOptions& options);

// Ends of the colour scale of all runs, by what their frames hold: up to what one ball in a hundred exceeds, so that a
// single impact does not darken the film.
struct Range {
  double low = 0, high = 1;
};
Range scale_of(const std::vector<Shot>& shots, render::Colour colour);

// Renders runs, side by side where there are several, as what `output` is by its name (cli/picture_output.h). Returns
// the number of pictures.
std::size_t render_shots(const std::vector<Shot>& shots, const FilmPlan& plan, const fs::path& output,
                         const CommonOptions& options);
// One run.
std::size_t render_run(const io::RunReader& run, const ChargeMotion& truth, const FilmPlan& plan,
                       const fs::path& output, const CommonOptions& options);

// The one door for all inputs: run file, folder of stills, film, tracks in pixels (.csv). What only tracks need is not
// looked at for others.
ChargeMotion measure(const fs::path& input, const analysis::TracksOptions& film, const CommonOptions& options);

}  // namespace tumble::cli
