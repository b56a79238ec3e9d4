#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>
#include <tuple>
#include <vector>

#include "cli/film_input.h"
#include "cli/options.h"
#include "cli/side_by_side.h"
#include "cli/steps.h"
#include "cli/verbs.h"
#include "core/error.h"
#include "core/mill_shape.h"
#include "core/parallel_for.h"
#include "core/units.h"
#include "core/version.h"
#include "diagnose/compare.h"
#include "diagnose/impacts.h"
#include "diagnose/typical_paths.h"
#include "io/comparison_file.h"
#include "io/motion_file.h"
#include "io/output.h"
#include "io/run_file.h"

namespace tumble::cli {
namespace {

struct Options : CommonOptions {
  fs::path a, b, output;
  std::vector<int> balls_a, balls_b;
  bool no_films = false;
  FilmInput film;
};

// A folder for the small films, gone with its owner.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string name = (fs::temp_directory_path() / "tumble-compare-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
      throw WorkError(name, std::string("cannot be made for the films: ") + std::strerror(errno));
    path_ = name;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// A folder that this command made goes again if the work fails.
class OutputFolder {
 public:
  explicit OutputFolder(const fs::path& path) : path_(path.has_filename() ? path : path.parent_path()) {
    std::error_code unknown;
    was_there_ = fs::exists(path_, unknown) || unknown;
    io::make_output_folder(path);
  }
  ~OutputFolder() {
    std::error_code ignored;
    if (!was_there_) fs::remove(path_, ignored);  // only if it is empty
  }
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

 private:
  fs::path path_;
  bool was_there_ = true;
};

struct Source {
  ChargeMotion motion;
  std::optional<io::RunReader> run;
  fs::path film;  // a film file
  MillShape shape;

  Shown shown() const { return {&motion, run ? &*run : nullptr, film}; }
};

MillShape shape_of(const ChargeMotion& m) {
  MillShape shape;
  shape.radius = std::isfinite(m.mill_radius) ? m.mill_radius : 0;
  shape.tip_radius = std::isfinite(m.tip_radius) ? m.tip_radius : shape.radius;
  shape.lifter_count = m.lifter_count;
  return shape;
}

void check_there(const fs::path& input) {
  std::error_code error;
  if (!fs::exists(input, error))
    throw InputError(input.string(), "does not exist; give a run file, a motion file or a film");
}

Source read(const fs::path& input, const analysis::TracksOptions& film, const CommonOptions& options) {
  Source s;
  std::error_code error;
  if (io::is_motion_file(input)) {
    s.motion = io::read_motion(input);
    s.motion.origin = input.string();
    s.shape = shape_of(s.motion);
  } else if (io::is_run_file(input)) {
    s.run.emplace(input);
    s.motion = measure_run(*s.run, options);
    s.motion.origin = input.string();
    s.shape = make_mill_shape(s.run->setup().config);
    if (!s.run->complete()) s.motion.caveats.push_back("The run was interrupted: its averages are over a part of it.");
    if (!s.run->result().caveat.empty()) s.motion.caveats.push_back(s.run->result().caveat);
  } else {
    s.motion = measure(input, film, options);
    if (!analysis::are_stills(input.string()) && input.extension() != ".csv") s.film = input;
    const bool drawn = film.mill != nullptr && film.mill->mill.diameter > 0;
    s.shape = drawn ? make_mill_shape(*film.mill) : shape_of(s.motion);
  }
  if (s.motion.frames == 0) throw InputError(input.string(), "holds no frames; nothing can be compared");
  return s;
}

double averaged_seconds(const io::RunReader& run) {
  const Config& c = run.setup().config;
  return c.run.revolutions * 2 * kPi / std::abs(run.setup().mill_speed);
}

void compare(Options o) {
  limit_threads(o.threads);
  for (const fs::path& input : {o.a, o.b}) check_there(input);
  settle(o.film);
  const OutputFolder folder(o.output);
  const fs::path json_file = o.output / "deviation.json", report_file = o.output / "report.html";
  for (const fs::path& file : {json_file, report_file}) {
    io::check_output_file(file, o.force);
    for (const fs::path& input : {o.a, o.b, o.film.mill}) io::check_not_input(file, input);
  }

  const Source a = read(o.a, o.film.told, o), b = read(o.b, o.film.told, o);
  Deviation deviation = diagnose::compare(a.motion, b.motion);
  if (a.run && b.run)
    for (SampledDifference& impacts : diagnose::compare_impacts(a.run->result().spectrum, averaged_seconds(*a.run),
                                                                b.run->result().spectrum, averaged_seconds(*b.run)))
      deviation.lines.push_back(std::move(impacts));
  std::error_code error;
  if (fs::equivalent(o.a, o.b, error))
    deviation.caveats.insert(deviation.caveats.begin(), "A and B are the same file.");

  io::Comparison comparison;
  comparison.deviation = &deviation;
  comparison.version = kVersion;
  for (const auto& [side, source, balls] :
       {std::tuple{&comparison.a, &a, &o.balls_a}, {&comparison.b, &b, &o.balls_b}}) {
    side->motion = &source->motion;
    side->shape = source->shape;
    if (!(source->motion.mill_radius > 0)) continue;
    side->paths = diagnose::typical_paths(source->motion);
    for (BallPath& path : diagnose::paths_of(source->motion, *balls)) side->paths.push_back(std::move(path));
  }
  std::optional<ScratchFolder> scratch;
  if (!o.no_films && (a.shown().any() || b.shown().any())) {
    scratch.emplace();
    const SideBySide films = small_films(a.shown(), b.shown(), scratch->path(), o);
    comparison.a.film = {films.a, films.a_caption};
    comparison.b.film = {films.b, films.b_caption};
    comparison.film_note = films.note;
    comparison.film_rate = films.rate;
    comparison.film_slow = films.slow;
  }
  const std::string page = io::comparison_page(comparison), json = io::deviation_json(comparison);
  io::write_text(json_file, json);
  io::write_text(report_file, page);
  for (const std::string& caveat : deviation.caveats) say(o, "note: " + caveat);
  say(o, deviation.sentence);
  say(o, "wrote " + report_file.string() + " and deviation.json");
  if (o.json) print(io::deviation_summary(comparison));
}

}  // namespace

void add_compare(CLI::App& app) {
  auto o = std::make_shared<Options>();
  CLI::App* verb =
      app.add_subcommand("compare", "Two of run file, motion file, film: where they differ, and by how much");
  verb->add_option("a", o->a, "RUN.h5, MOTION.h5, a film, a folder of stills or TRACKS.csv")->required();
  verb->add_option("b", o->b, "What to compare it with, likewise; differences are B - A")->required();
  verb->add_option("-o,--output", o->output, "Folder for report.html and deviation.json")->required();
  add_film_input(*verb, o->film);
  verb->add_option("--balls-a", o->balls_a, "Numbers of balls of A whose paths are wanted too, such as 3,17")
      ->delimiter(',');
  verb->add_option("--balls-b", o->balls_b, "The same of B")->delimiter(',');
  verb->add_flag("--no-films", o->no_films, "Leave the films out of the report");
  add_common(*verb, *o);
  verb->footer("Example: tumble compare film.mp4 run.h5 --mill mill.toml -o comparison");
  verb->callback([o] { compare(*o); });
}

}  // namespace tumble::cli
