#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/film_beside.h"
#include "cli/film_theme.h"
#include "cli/options.h"
#include "cli/steps.h"
#include "cli/verbs.h"
#include "core/error.h"
#include "core/parallel_for.h"
#include "io/output.h"

namespace tumble::cli {
namespace {

const std::map<std::string, render::Colour> kColours = {{"speed", render::Colour::kSpeed},
                                                        {"size", render::Colour::kSize},
                                                        {"spin", render::Colour::kSpin},
                                                        {"steel", render::Colour::kSteel}};

struct Options : CommonOptions {
  fs::path run, output;
  std::string size = "1280x720", overlay = "toe,shoulder", colour = "speed", theme = "default";
  std::uint64_t look_seed = 1;
  double fps = 60;
  FilmPlan plan;
  BesidePlan beside;
  bool colour_given = false;
};

render::Overlay parse_overlay(const std::string& list) {
  render::Overlay overlay;
  overlay.toe = overlay.shoulder = overlay.tracks = overlay.velocity = false;
  std::istringstream words(list);
  for (std::string word; std::getline(words, word, ',');) {
    if (word == "toe")
      overlay.toe = true;
    else if (word == "shoulder")
      overlay.shoulder = true;
    else if (word == "tracks")
      overlay.tracks = true;
    else if (word == "velocity")
      overlay.velocity = true;
    else if (word != "none" && !word.empty())
      throw InputError("--overlay", "\"" + word + "\" is unknown; give any of toe,shoulder,tracks,velocity or none");
  }
  return overlay;
}

enum class Theme { kDefault, kFilm };
const std::map<std::string, Theme> kThemes = {{"default", Theme::kDefault}, {"film", Theme::kFilm}};

void render(Options o) {
  limit_threads(o.threads);
  const bool filmed = parse_name(o.theme, "--theme", kThemes) == Theme::kFilm;
  parse_size(o.size, "--size", o.plan.format.width, o.plan.format.height);
  parse_rate(o.fps, "--fps", o.plan.format.fps_numerator, o.plan.format.fps_denominator);
  if (!(o.plan.style.slow >= 0.01 && o.plan.style.slow <= 1e4))
    throw InputError("--slow", "must lie between 0.01 and 10000; 1 is true time, 4 is four times slower");
  o.plan.style.width = o.plan.format.width;
  o.plan.style.height = o.plan.format.height;
  o.plan.style.colour = parse_name(o.colour, "--colour", kColours);
  o.plan.style.overlay = parse_overlay(o.overlay);
  o.plan.format.threads = o.threads;

  std::error_code error;
  const bool pictures = !o.output.has_filename() || fs::is_directory(o.output, error);
  if (pictures) {
    io::make_output_folder(o.output);
    io::check_output_file(o.output / picture_name(0), o.force);
  } else {
    if (o.output.extension() != ".mp4")
      throw InputError(o.output.string(), "is no .mp4; give FILM.mp4, or FRAMES/ for a folder of PNG");
    io::check_not_input(o.output, o.run);
    io::check_output_file(o.output, o.force);
  }
  const io::RunReader run(o.run);
  if (!o.beside.film.empty()) {
    if (filmed)
      throw InputError("--theme", "film does not go with --beside; render the film first, then its run beside it");
    io::check_not_input(o.output, o.beside.film);
    o.beside.run = o.run;
    o.beside.picture = o.plan;
    if (!o.colour_given) o.beside.picture.style.colour = render::Colour::kSteel;
    const BesideResult done = render_beside(run, o.beside, o.output, pictures, o);
    if (!o.json) return;
    nlohmann::ordered_json summary = {
        {"output", o.output.string()}, {"frames", done.frames},       {"frames_per_second", done.frames_per_second},
        {"slow", o.plan.style.slow},   {"run_from_s", done.run_from}, {"run_pace", done.pace}};
    if (!std::isnan(done.only_film)) {
      summary["only_film"] = done.only_film;
      summary["only_simulation"] = done.only_run;
    }
    print(summary.dump(2) + "\n");
    return;
  }
  ChargeMotion truth;
  if (!filmed && (o.plan.style.overlay.toe || o.plan.style.overlay.shoulder)) truth = measure_run(run, o);
  truth.origin = o.run.string();
  const std::size_t frames = filmed ? render_filmed_run(run, o.plan, o.look_seed, o.output, pictures, o)
                                    : render_run(run, truth, o.plan, o.output, pictures, o);
  if (!o.json) return;
  const nlohmann::ordered_json summary = {{"output", o.output.string()},    {"frames", frames},
                                          {"frames_per_second", o.fps},     {"slow", o.plan.style.slow},
                                          {"width_px", o.plan.style.width}, {"height_px", o.plan.style.height}};
  print(summary.dump(2) + "\n");
}

}  // namespace

void add_render(CLI::App& app) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("render", "Turn a run into a film, or into numbered pictures");
  verb->add_option("run", o->run, "RUN.h5")->required();
  verb->add_option("-o,--output", o->output, "FILM.mp4, or FRAMES/ for PNG files")->required();
  verb->add_option("--size", o->size, "Picture size in pixels")->capture_default_str();
  verb->add_option("--fps", o->fps, "Film frames per second")->capture_default_str();
  verb->add_option("--slow", o->plan.style.slow, "How many times slower than true time")->capture_default_str();
  verb->add_option("--colour", o->colour, "Colour of the balls: speed, size, spin or steel")->capture_default_str();
  verb->add_option("--overlay", o->overlay, "Any of toe,shoulder,tracks,velocity, or none")->capture_default_str();
  verb->add_flag("--mirror", o->plan.style.mirror, "See the mill from its other end: it turns clockwise");
  verb->add_option("--theme", o->theme,
                   "default, or film: as a laboratory's camera sees the mill, without marks, colours and text")
      ->capture_default_str();
  verb->add_option("--look-seed", o->look_seed, "Which light and materials the film theme takes")
      ->capture_default_str();
  verb->add_option("--preset", o->plan.format.preset, "x264 preset, ultrafast to veryslow")->capture_default_str();
  verb->add_option("--crf", o->plan.format.crf, "x264 quality, 0 (lossless) to 51")->capture_default_str();
  verb->add_option("--beside", o->beside.film,
                   "A real film, a folder of stills or one, or the MOTION.h5 made of it: the run beside it, in step");
  verb->add_option("--as", o->beside.view,
                   "side (two panels), overlay (the run's balls in the film), wipe, or difference (what only one has)")
      ->capture_default_str();
  verb->add_option("--run-from", o->beside.run_from,
                   "Where in the run the film begins, s; not given: as early as the lifters are in phase");
  verb->add_option("--wipe-at", o->beside.wipe, "Share of a wipe that shows the film, 0 to 1; not given: it sweeps");
  verb->add_option("--opacity", o->beside.opacity, "Of the balls in an overlay, 0 (outlines alone) to 1")
      ->capture_default_str();
  verb->add_option("--passages", o->beside.passages, "Lifter passages that a difference is a running mean over")
      ->capture_default_str();
  add_film_input(*verb, o->beside.input);
  add_common(*verb, *o);
  verb->footer(
      "Examples: tumble render run.h5 -o film.mp4 --slow 4 --overlay toe,shoulder,tracks\n"
      "          tumble render run.h5 -o beside.mp4 --beside film.mp4 --as overlay");
  verb->callback([o, verb] {
    o->colour_given = verb->count("--colour") > 0;
    o->beside.rate_given = verb->count("--fps") > 0;
    render(*o);
  });
}

}  // namespace tumble::cli
