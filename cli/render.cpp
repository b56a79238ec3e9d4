#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/film_theme.h"
#include "cli/options.h"
#include "cli/steps.h"
#include "cli/verbs.h"
#include "core/error.h"
#include "core/parallel_for.h"
#include "io/output.h"

namespace tumble::cli {
namespace {

const std::map<std::string, render::Colour> kColours = {
    {"speed", render::Colour::kSpeed}, {"size", render::Colour::kSize},           {"spin", render::Colour::kSpin},
    {"steel", render::Colour::kSteel}, {"residence", render::Colour::kResidence}, {"force", render::Colour::kForce}};

const std::map<std::string, bool render::Overlay::*> kOverlays = {{"toe", &render::Overlay::toe},
                                                                  {"shoulder", &render::Overlay::shoulder},
                                                                  {"tracks", &render::Overlay::tracks},
                                                                  {"velocity", &render::Overlay::velocity},
                                                                  {"chains", &render::Overlay::chains},
                                                                  {"occupancy", &render::Overlay::occupancy},
                                                                  {"streamlines", &render::Overlay::streamlines},
                                                                  {"mean_velocity", &render::Overlay::mean_velocity},
                                                                  {"surface", &render::Overlay::surface},
                                                                  {"head", &render::Overlay::head},
                                                                  {"circulation", &render::Overlay::circulation},
                                                                  {"departure", &render::Overlay::departure},
                                                                  {"impact", &render::Overlay::impact}};

struct Options : CommonOptions {
  fs::path run, output;
  std::string size = "1280x720", overlay = "toe,shoulder", colour = "speed", theme = "dark";
  std::uint64_t look_seed = 1;
  double fps = 60;
  FilmPlan plan;
};

render::Overlay parse_overlay(const std::string& list) {
  render::Overlay overlay;
  const auto set_all = [&](bool shown) {
    for (const auto& [name, member] : kOverlays) overlay.*member = shown;
  };
  set_all(false);
  std::istringstream words(list);
  for (std::string word; std::getline(words, word, ',');) {
    if (const auto found = kOverlays.find(word); found != kOverlays.end()) {
      overlay.*found->second = true;
    } else if (word == "all") {
      set_all(true);
    } else if (word != "none" && !word.empty()) {
      std::string known;
      for (const auto& [name, member] : kOverlays) known += (known.empty() ? "" : ",") + name;
      throw InputError("--overlay", "\"" + word + "\" is unknown; give any of " + known + ", or all, or none");
    }
  }
  return overlay;
}

enum class Theme { kDark, kLight, kFilm };
const std::map<std::string, Theme> kThemes = {
    {"dark", Theme::kDark}, {"default", Theme::kDark}, {"light", Theme::kLight}, {"film", Theme::kFilm}};

void render(Options o) {
  limit_threads(o.threads);
  const Theme theme = parse_name(o.theme, "--theme", kThemes);
  const bool filmed = theme == Theme::kFilm;
  o.plan.style.theme = theme == Theme::kLight ? render::ThemeName::kLight : render::ThemeName::kDark;
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
  ChargeMotion truth;
  const render::Style& style = o.plan.style;
  if (!filmed && (style.overlay.toe || style.overlay.shoulder || render::shows_mean(style.overlay) ||
                  render::shows_residence(style)))
    truth = measure_run(run, o);
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
  verb->add_option("--colour", o->colour, "Colour of the balls: speed, size, spin, steel, residence or force")
      ->capture_default_str();
  verb->add_option("--overlay", o->overlay,
                   "Any of toe,shoulder,tracks,velocity,chains (contact forces) and, of the run's mean, occupancy,"
                   "streamlines,mean_velocity,surface,head,circulation,departure,impact; or all, or none")
      ->capture_default_str();
  verb->add_flag("--mirror", o->plan.style.mirror, "See the mill from its other end: it turns clockwise");
  verb->add_option(
          "--theme", o->theme,
          "dark, light (for paper), or film: as a laboratory's camera sees the mill, without marks, colours and text")
      ->capture_default_str();
  verb->add_option("--look-seed", o->look_seed, "Which light and materials the film theme takes")
      ->capture_default_str();
  verb->add_option("--preset", o->plan.format.preset, "x264 preset, ultrafast to veryslow")->capture_default_str();
  verb->add_option("--crf", o->plan.format.crf, "x264 quality, 0 (lossless) to 51")->capture_default_str();
  add_common(*verb, *o);
  verb->footer("Example: tumble render run.h5 -o film.mp4 --slow 4 --overlay toe,shoulder,tracks");
  verb->callback([o] { render(*o); });
}

}  // namespace tumble::cli
