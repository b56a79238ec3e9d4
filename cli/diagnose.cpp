#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>

#include "cli/diagnosed_laws.h"
#include "cli/diagnosis_runs.h"
#include "cli/measurements.h"
#include "cli/options.h"
#include "cli/signature_library.h"
#include "cli/tasks.h"
#include "cli/verbs.h"
#include "core/error.h"
#include "core/parallel_for.h"
#include "diagnose/verdict.h"
#include "io/config_file.h"
#include "io/config_keys.h"
#include "io/diagnosis_file.h"
#include "io/diagnosis_words.h"
#include "io/experiments_file.h"
#include "io/output.h"
#include "io/text_file.h"

namespace tumble::cli {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kLargestMiB = 4;

struct Options : CommonOptions {
  fs::path config, measured, output, library;
  std::string engine = "local";
  std::size_t blocks = diagnose::kGoodBlocks;
  std::size_t seeds = 6;
};

fs::path library_folder(const Options& o) {
  if (!o.library.empty()) return o.library;
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache) return fs::path(cache) / "tumble";
  if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache" / "tumble";
  throw InputError("--library", "is not given, and neither XDG_CACHE_HOME nor HOME says where a cache may be; give it");
}

// The library goes a little to both sides of what MILL.toml has, however wide the range.
void check_room(const Config& mill, const UncertainKey& u, double value) {
  constexpr double kLittle = 0.1;
  for (const double away : {-kLittle * u.sd, kLittle * u.sd}) try {
      io::with_sets(mill, {fmt::format("{}={}", u.key, value + away)});
    } catch (const InputError& e) {
      throw InputError(u.place,
                       fmt::format("is uncertain about {:g}, which leaves no room on one side ({}); give MILL.toml "
                                   "a value within the range, or leave this out",
                                   value, e.what()));
    }
}

void diagnose_mill(const Options& o) {
  limit_threads(o.threads);
  const bool by_slurm = is_slurm(o.engine);
  if (by_slurm) check_slurm();
  const Config mill = io::read_config(o.config);
  check_complete(mill);
  const Experiments experiments = io::read_experiments(o.measured);
  const std::vector<double> middle = values_of(mill, experiments.uncertain);
  for (std::size_t k = 0; k < middle.size(); ++k) check_room(mill, experiments.uncertain[k], middle[k]);
  const fs::path verdict = o.output / "verdict.json", model = o.output / "model.toml", page = o.output / "report.html",
                 tabulated = o.output / "model_tabulated.toml", film = o.output / "film.mp4";
  std::error_code error;
  if (fs::is_directory(o.output, error)) {  // shows before films are measured, which takes long
    for (const fs::path& file : {model, verdict, page, tabulated, film}) {
      io::check_output_file(file, o.force);
      io::check_not_input(file, o.config);
      io::check_not_input(file, o.measured);
      for (const Experiment& e : experiments.list) io::check_not_input(file, e.film);
    }
    DiagnosisRuns::check(o.output, o.force);
  }
  std::vector<std::string> notes;
  diagnose::DiagnosisRequest request;
  request.measurements = read_measurements(experiments, mill, o.output / "films", o, notes);
  request.uncertain = experiments.uncertain;
  request.middle = middle;
  request.seeds = o.seeds;
  io::make_output_folder(o.output);

  LibraryPlan library{library_folder(o), o.blocks, request.uncertain, {}};
  for (const diagnose::Measurement& m : request.measurements)
    if (!m.experiment.hold_out) library.mills.push_back(m.config);
  request.conditions = conditions_of(library);
  ProgressLine line(o, "library of signatures", "what was simulated is kept; the same command goes on with it");
  std::size_t simulated = 0;
  if (by_slurm) {
    ProgressLine queue(o, "library by Slurm", "what was simulated is kept; the same command goes on with it");
    simulated = make_library_by_slurm(library, o.output / "slurm", o.threads, queue.callback());
  }
  simulated += build_library(library, request.conditions, line.callback());

  ProgressLine proving(o, "putting to the proof", "the library is kept; the same command goes on from it");
  const diagnose::MillWith mill_with = [](const Config& config, const std::vector<std::string>& sets) {
    return io::with_sets(config, sets);
  };
  Diagnosis d = diagnose::find_out(request, mill_with, proving.callback());
  d.mill = o.config.string();
  d.measured = o.measured.string();
  d.simulations += static_cast<int>(simulated);
  d.seconds = line.seconds();
  d.caveats.insert(d.caveats.end(), notes.begin(), notes.end());
  d.mill_toml = io::read_text(o.config, "a MILL.toml", kLargestMiB);
  add_laws(d, request.measurements);
  d.model_toml = io::repaired_mill(d.mill_toml, o.config.string(), d);
  DiagnosisRuns runs(o.output, d, request.measurements, o);
  d.torque = runs.torque();
  d.sentence = io::diagnosis_sentence(d);
  const std::vector<io::DiagnosisFilm> films = runs.film(film);

  if (films.empty()) fs::remove(film, error);  // of a diagnosis that this one replaces, as is model_tabulated.toml
  if (d.model_tabulated_toml.empty()) fs::remove(tabulated, error);
  runs.keep();
  io::write_text(model, d.model_toml);
  if (!d.model_tabulated_toml.empty()) io::write_text(tabulated, d.model_tabulated_toml);
  io::write_diagnosis_page(page, d, films);
  io::write_text(verdict, io::diagnosis_json(d));  // last: where it stands, the diagnosis is complete
  for (const std::string& note : notes) say(o, "note: " + note);
  say(o, d.sentence);
  if (o.json) print(io::diagnosis_json(d));
}

}  // namespace

void add_diagnose(CLI::App& app) {
  auto o = std::make_shared<Options>();
  CLI::App* verb =
      app.add_subcommand("diagnose", "Find where simulation and measurement disagree, and name what is missing");
  verb->add_option("config", o->config, "MILL.toml")->required();
  verb->add_option("--measured", o->measured, "EXPERIMENTS.toml")->required();
  verb->add_option("-o,--output", o->output, "Folder for report.html, verdict.json, model.toml, runs")->required();
  verb->add_option("--library", o->library,
                   "Folder of the library of signatures (default: $XDG_CACHE_HOME/tumble or ~/.cache/tumble)");
  add_engine(*verb, o->engine);
  verb->add_option("--blocks", o->blocks, "Size of the library: fewer blocks are quicker and tell less")
      ->check(CLI::Range(2, 100))
      ->capture_default_str();
  verb->add_option("--seeds", o->seeds, "Simulations of each experiment to prove each model")
      ->check(CLI::Range(4, 1000))
      ->capture_default_str();
  add_common(*verb, *o);
  verb->footer("Example: tumble diagnose mill.toml --measured experiments.toml -o diagnosis");
  verb->callback([o] { diagnose_mill(*o); });
}

}  // namespace tumble::cli
