#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "cli/film_beside.h"
#include "cli/film_theme.h"
#include "cli/options.h"
#include "cli/picture_output.h"
#include "cli/steps.h"
#include "cli/verbs.h"
#include "core/error.h"
#include "core/parallel_for.h"
#include "io/output.h"
#include "render/sheet.h"

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
  std::vector<fs::path> runs;
  fs::path output;
  std::string camera = "lab";
  std::optional<std::string> size, preset;
  std::optional<double> fps, crf, zoom, slow, at, from, seconds, every;
  std::string overlay = "toe,shoulder", colour = "speed", theme = "dark";
  std::uint64_t look_seed = 1;
  std::string context = "osmesa";
  FilmPlan plan;
  BesidePlan beside;
  bool colour_given = false;
};

const std::map<std::string, render::ContextKind> kContexts = {{"osmesa", render::ContextKind::kOsmesa},
                                                              {"egl", render::ContextKind::kEgl}};

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

render::View parse_view(const std::string& camera, const std::optional<double>& zoom) {
  using From = render::View::From;
  render::View view;
  if (camera.starts_with("ball:")) {
    const char* const end = camera.data() + camera.size();
    const auto read = std::from_chars(camera.data() + 5, end, view.ball);
    if (read.ec != std::errc() || read.ptr != end)
      throw InputError("--camera", "is \"" + camera + "\"; give the ball's number, such as ball:17");
    view.from = From::kBall;
    view.zoom = 2;
  } else {
    view.from =
        parse_name<From>(camera, "--camera", {{"lab", From::kLab}, {"shell", From::kShell}, {"ball:N", From::kBall}});
    if (view.from == From::kBall) throw InputError("--camera", "needs the ball's number, such as ball:17");
  }
  if (zoom) view.zoom = *zoom;
  if (!(view.zoom >= 0.2 && view.zoom <= 50)) throw InputError("--zoom", "must lie between 0.2 and 50");
  return view;
}

// An option that this kind of output has no use for is a mistake, and not silently left out.
void refuse_odd(const Options& o, OutputKind kind) {
  const bool is_still = kind == OutputKind::kPicture || kind == OutputKind::kDrawing;
  const auto refuse = [&](bool given, const char* option, const char* why) {
    if (given) throw InputError(option, why);
  };
  if (is_still) {
    refuse(o.fps.has_value(), "--fps", "is of films; a still has none");
    refuse(o.slow.has_value(), "--slow", "is of films; a still has none");
    refuse(o.crf.has_value() || o.preset.has_value(), o.crf ? "--crf" : "--preset", "is of films; a still has none");
    refuse(o.every.has_value(), "--every", "is of films and folders; a still is taken --at one moment");
    refuse(o.at && (o.from || o.seconds), "--at", "already says when; leave out --from and --for");
  } else {
    refuse(o.at.has_value(), "--at", "is of stills; give -o STILL.png, .svg or .pdf, or --from and --for");
  }
  refuse(o.every.has_value() && kind != OutputKind::kFolder, "--every", "is of folders; a film has --fps and --slow");
  refuse(o.every.has_value() && (o.fps || o.slow), "--every", "already says when; leave out --fps and --slow");
  const fs::path extension = o.output.extension();
  if (kind == OutputKind::kFilm && extension != ".mp4") {
    refuse(o.preset.has_value(), "--preset", "is x264's; only .mp4 has it");
    refuse(o.crf.has_value() && extension == ".gif", "--crf", "is of .mp4 and .webm; a GIF has none");
  }
}

void read_times(Options& o) {
  const auto check = [](const std::optional<double>& value, const char* option, double& into) {
    if (!value) return;
    if (!(*value >= 0 && *value < 1e9)) throw InputError(option, "must be a time in s, >= 0");
    into = *value;
  };
  check(o.from, "--from", o.plan.from);
  check(o.seconds, "--for", o.plan.seconds);
  check(o.at, "--at", o.plan.at);
  check(o.every, "--every", o.plan.every);
  if (o.every && *o.every < 1e-6) throw InputError("--every", "must be at least 1e-6 s");
  if (o.slow) o.plan.style.slow = *o.slow;
  if (!(o.plan.style.slow >= 0.01 && o.plan.style.slow <= 1e4))
    throw InputError("--slow", "must lie between 0.01 and 10000; 1 is true time, 4 is four times slower");
  if (o.plan.is_still || o.every) o.plan.style.slow = kNotGiven;
}

std::size_t render_runs(const std::vector<io::RunReader>& runs, const Options& o) {
  const render::Style& style = o.plan.style;
  std::vector<ChargeMotion> truths;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    truths.emplace_back();
    if (render::shows_mean(style.overlay) || render::shows_residence(style))
      truths.back() = measure_run(runs[i], o);
    else if (style.overlay.toe || style.overlay.shoulder)
      truths.back().profile = measure_run_edges(runs[i], o);
    truths.back().origin = o.runs[i].string();
  }
  if (runs.size() == 1) return render_run(runs[0], truths[0], o.plan, o.output, o);
  const std::vector<Shot> shots = shots_side_by_side(runs, truths);
  const auto end = [](const Shot& shot) { return shot.run->time().back() - shot.begin; };
  const auto [shortest, longest] =
      std::minmax_element(shots.begin(), shots.end(), [&](const Shot& a, const Shot& b) { return end(a) < end(b); });
  if (!o.plan.is_still && end(*longest) > 1.01 * end(*shortest))
    say(o, fmt::format("note: the film ends with its shortest run, {}, after {:.2f} s", shortest->truth->origin,
                       end(*shortest)));
  return render_shots(shots, o.plan, o.output, o);
}

// What a run beside a film has no use for.
void settle_beside(Options& o, OutputKind kind, Theme theme) {
  const auto refuse = [](bool given, const char* option, const char* why) {
    if (given) throw InputError(option, why);
  };
  refuse(theme == Theme::kFilm, "--theme",
         "film does not go with --beside; render the film first, then its run beside it");
  refuse(theme == Theme::kLight, "--theme", "light does not go with --beside; its pair of colours needs a dark ground");
  refuse(o.runs.size() > 1, "--beside", "shows one run; leave out the others");
  refuse(kind != OutputKind::kFilm && kind != OutputKind::kFolder, "--output",
         "of a run beside a film must be FILM.mp4, .webm, .gif or FRAMES/");
  refuse(o.camera != "lab" || o.zoom, "--beside", "has a camera of its own; leave out --camera and --zoom");
  refuse(o.from || o.seconds || o.every, "--beside", "shows all of the film; leave out --from, --for and --every");
  refuse(o.context != "osmesa", "--beside", "is drawn by osmesa; leave out --context");
  o.beside.run = o.runs[0];
  o.beside.rate_given = o.fps.has_value();
  o.beside.picture = o.plan;
  render::Colour& colour = o.beside.picture.style.colour;
  if (!o.colour_given) colour = render::Colour::kSteel;
  refuse(colour == render::Colour::kResidence || colour == render::Colour::kForce, "--colour",
         "beside a film must be speed, size, spin or steel");
}

void report_beside(const BesideResult& done, const Options& o) {
  if (!o.json) return;
  nlohmann::ordered_json summary = {
      {"output", o.output.string()}, {"frames", done.frames},       {"frames_per_second", done.frames_per_second},
      {"slow", o.plan.style.slow},   {"run_from_s", done.run_from}, {"run_pace", done.pace}};
  if (!std::isnan(done.only_film)) {
    summary["only_film"] = done.only_film;
    summary["only_simulation"] = done.only_run;
  }
  print(summary.dump(2) + "\n");
}

void render(Options o, RenderBeside beside) {
  limit_threads(o.threads);
  const Theme theme = parse_name(o.theme, "--theme", kThemes);
  const bool filmed = theme == Theme::kFilm;
  o.plan.style.theme = theme == Theme::kLight ? render::ThemeName::kLight : render::ThemeName::kDark;
  const OutputKind kind = output_kind(o.output);
  refuse_odd(o, kind);
  if (kind == OutputKind::kFilm) o.plan.format = io::usual_format(o.output.string());
  if (o.size) parse_size(*o.size, "--size", o.plan.format.width, o.plan.format.height);
  if (o.fps) parse_rate(*o.fps, "--fps", o.plan.format.fps_numerator, o.plan.format.fps_denominator);
  if (o.preset) o.plan.format.preset = *o.preset;
  if (o.crf) o.plan.format.crf = *o.crf;
  o.plan.format.threads = o.threads;
  o.plan.is_still = kind == OutputKind::kPicture || kind == OutputKind::kDrawing;
  read_times(o);
  o.plan.style.width = o.plan.format.width;
  o.plan.style.height = o.plan.format.height;
  o.plan.style.colour = parse_name(o.colour, "--colour", kColours);
  o.plan.style.overlay = parse_overlay(o.overlay);
  o.plan.style.view = parse_view(o.camera, o.zoom);
  o.plan.style.context = parse_name(o.context, "--context", kContexts);
  const bool is_beside = !o.beside.film.empty();
  if (is_beside && !beside) throw InputError("--beside", "reads films, as `tumble render` can; call that");
  if (is_beside) settle_beside(o, kind, theme);
  if (filmed) {
    if (kind == OutputKind::kDrawing) throw InputError(o.output.string(), "cannot hold a filmed mill; give a .png");
    if (o.runs.size() > 1) throw InputError("--theme", "film shows one run; leave out the others");
    if (o.camera != "lab" || o.zoom)
      throw InputError("--theme", "film has a camera of its own; leave out --camera and --zoom");
    if (o.context != "osmesa") throw InputError("--theme", "film is drawn by osmesa; leave out --context");
    if (o.plan.is_still || o.every) o.plan.style.slow = 1;
  }

  if (kind == OutputKind::kFolder) {
    io::make_output_folder(o.output);
    io::check_output_file(o.output / picture_name(0), o.force);
  } else {
    for (const fs::path& run : o.runs) io::check_not_input(o.output, run);
    if (is_beside) io::check_not_input(o.output, o.beside.film);
    io::check_output_file(o.output, o.force);
  }
  std::vector<io::RunReader> runs;
  for (const fs::path& path : o.runs) {
    runs.emplace_back(path);
    if (runs.back().frame_count() == 0) throw InputError(path.string(), "holds no frames; simulate for longer");
  }
  if (is_beside) return report_beside(beside(runs[0], o.beside, o.output, o), o);
  const std::size_t frames =
      filmed ? render_filmed_run(runs[0], o.plan, o.look_seed, o.output, o) : render_runs(runs, o);
  if (!o.json) return;
  nlohmann::ordered_json summary = {{"output", o.output.string()}, {"frames", frames}};
  if (!o.plan.is_still) {
    summary["frames_per_second"] = o.fps ? *o.fps : double(o.plan.format.fps_numerator) / o.plan.format.fps_denominator;
    if (!o.every) summary["slow"] = o.plan.style.slow;
  }
  summary["width_px"] = o.plan.style.width;
  summary["height_px"] = o.plan.style.height;
  print(summary.dump(2) + "\n");
}

}  // namespace

void add_render(CLI::App& app, RenderBeside beside) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("render", "Turn runs into a film, numbered pictures, or a still");
  verb->add_option("runs", o->runs, "RUN.h5; several, up to 12, stand side by side")
      ->required()
      ->expected(1, static_cast<int>(render::kMostMills));
  verb->add_option("-o,--output", o->output, "FILM.mp4, .webm or .gif; FRAMES/ for PNG files; STILL.png, .svg or .pdf")
      ->required();
  verb->add_option("--size", o->size, "Picture size in pixels [1280x720; of a GIF 640x360]");
  verb->add_option("--fps", o->fps, "Film frames per second [60; of a GIF 25]");
  verb->add_option("--slow", o->slow, "How many times slower than true time [1]");
  verb->add_option("--from", o->from, "Begin so long after the first frame, in s [0]");
  verb->add_option("--for", o->seconds, "Show so much of the run, in s of true time [all]");
  verb->add_option("--at", o->at, "When a still is taken, in s after the first frame [the middle]");
  verb->add_option("--every", o->every, "Of a folder: true time between pictures, in s");
  verb->add_option("--camera", o->camera,
                   "lab; shell, which turns with it while gravity goes round; or ball:N, which follows ball N")
      ->capture_default_str();
  verb->add_option("--zoom", o->zoom, "How many times closer [1; 2 with ball:N]");
  verb->add_option("--context", o->context, "What draws: osmesa, or egl (a graphics card where there is one)")
      ->capture_default_str();
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
  verb->add_option("--preset", o->preset, "x264 preset, ultrafast to veryslow [veryfast]");
  verb->add_option("--crf", o->crf, "Quality, 0 (lossless) to 51 (.mp4) or 63 (.webm) [20; 36]");
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
      "          tumble render n50.h5 n70.h5 n90.h5 -o speeds.webm\n"
      "          tumble render run.h5 -o still.svg --at 1.5\n"
      "          tumble render run.h5 -o beside.mp4 --beside film.mp4 --as overlay");
  verb->callback([o, verb, beside] {
    o->colour_given = verb->count("--colour") > 0;
    render(*o, beside);
  });
}

}  // namespace tumble::cli
