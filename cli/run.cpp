#include <chrono>
#include <memory>

#include "cli/options.h"
#include "cli/run_summary.h"
#include "cli/simulation.h"
#include "cli/steps.h"
#include "cli/verbs.h"
#include "core/parallel_for.h"
#include "core/version.h"
#include "diagnose/compare.h"
#include "io/config_file.h"
#include "io/motion_file.h"
#include "io/output.h"
#include "io/report_file.h"

namespace tumble::cli {
namespace {

struct Options : CommonOptions {
  fs::path config, output;
  std::vector<std::string> sets;
  FilmPlan plan;
};

struct Clock {
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - start).count();
    start = now;
    return seconds;
  }
};

// The main job: simulate, render, analyse the rendered film, compare what it found with what the simulation knew.
void run(Options o) {
  limit_threads(o.threads);
  const Config config = io::read_config(o.config, o.sets);
  check_complete(config);
  io::make_output_folder(o.output);
  const fs::path run_file = o.output / "run.h5", film_file = o.output / "film.mp4",
                 motion_file = o.output / "motion.h5", report_file = o.output / "report.html";
  for (const fs::path& file : {run_file, film_file, motion_file, report_file}) io::check_output_file(file, o.force);

  Clock clock;
  io::RunReport report;
  simulate_to_file(config, run_file, false, o);
  report.seconds_simulating = clock.lap();

  const io::RunReader reader(run_file);
  ChargeMotion truth = measure_run(reader, o);
  truth.origin = run_file.string();
  o.plan.format.threads = o.threads;
  clock.lap();
  render_run(reader, truth, o.plan, film_file, o);
  report.seconds_rendering = clock.lap();

  // The analyser is told what a laboratory knows of its mill: the drawing and the ball sizes. Speed and filling are
  // left for it to find.
  Config drawing;
  drawing.mill.diameter = config.mill.diameter;
  drawing.mill.critical_speed_rpm = config.mill.critical_speed_rpm;
  drawing.mill.lifters = config.mill.lifters;
  drawing.charge.balls = config.charge.balls;
  analysis::TracksOptions film_options;
  film_options.mill = &drawing;
  const ChargeMotion film = measure(film_file, film_options, o);
  for (const std::string& caveat : film.caveats) say(o, "note: " + caveat);
  io::write_motion(motion_file, film);
  report.seconds_analysing = clock.lap();

  const Deviation deviation = diagnose::compare(truth, film);
  const RunSummary summary = summarise(reader);
  report.setup = &reader.setup();
  report.result = &reader.result();
  report.truth = &truth;
  report.film = &film;
  report.deviation = &deviation;
  report.film_file = film_file;
  report.summary = &summary;
  report.config_text = io::to_toml(config);
  report.version = kVersion;
  io::write_run_report(report_file, report);
  say(o, "wrote " + run_file.string() + ", film.mp4, motion.h5 and report.html: open the report in a browser");
  if (o.json) print(to_json(summary, reader));
}

}  // namespace

void add_run(CLI::App& app) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("run", "The main job: simulate, render, analyse the film, compare, report");
  verb->add_option("config", o->config, "MILL.toml")->required();
  verb->add_option("-o,--output", o->output, "Folder for run.h5, film.mp4, motion.h5 and report.html")->required();
  verb->add_option("--set", o->sets, "Override a key, such as --set mill.speed=0.8; may be repeated")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  add_common(*verb, *o);
  verb->footer("Example: tumble run examples/lab_mill_55cm.toml -o out");
  verb->callback([o] { run(*o); });
}

}  // namespace tumble::cli
