#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/options.h"
#include "cli/slurm_queue.h"
#include "cli/sweep_plan.h"
#include "cli/tasks.h"
#include "cli/vary.h"
#include "cli/verbs.h"
#include "core/error.h"
#include "core/parallel_for.h"
#include "core/sweep.h"
#include "core/version.h"
#include "diagnose/campaign.h"
#include "io/config_file.h"
#include "io/experiments_file.h"
#include "io/json_number.h"
#include "io/output.h"
#include "io/run_journal.h"
#include "io/sweep_figures.h"
#include "io/sweep_file.h"
#include "io/sweep_page.h"

namespace tumble::cli {
namespace fs = std::filesystem;
namespace {

constexpr double kMostRuns = 1e6;

struct Options : CommonOptions {
  fs::path config, output, csv, page, figures, measured;
  std::vector<std::string> sets, vary;
  int repeats = 1;
  std::string engine = "local";
  bool resume = false, dry_run = false;
};

// Reads all, and asks of every run whether it can be: a mistake is to show now, not after a night.
SweepPlan make_plan(const Options& o) {
  SweepPlan plan;
  plan.mill = io::read_config(o.config, o.sets);
  std::vector<std::string> notes;
  double runs = o.repeats;
  for (const std::string& text : o.vary) {
    VariedKey varied = parse_vary(text, notes);
    for (const VariedKey& before : plan.sweep.varied) {
      if (before.key == varied.key)
        throw InputError("--vary: " + varied.key, "is given twice; give all its values in one");
      if (before.key == io::twin_of(varied.key))
        throw InputError("--vary: " + varied.key, "says the same as " + before.key + "; vary one of the two");
    }
    if (varied.key == "run.seed") throw InputError("--vary: run.seed", "is what --repeat changes; give --repeat K");
    runs *= double(varied.values.size());
    plan.sweep.varied.push_back(std::move(varied));
  }
  if (runs > kMostRuns)
    throw InputError("--vary", fmt::format("comes to {:.3g} runs, more than a million; vary less at a time", runs));
  for (const std::string& note : notes) say(o, "note: " + note);
  plan.sweep.repeats = static_cast<std::size_t>(o.repeats);
  plan.sweep.first_seed = plan.mill.run.seed;
  plan.sweep.mill_toml = io::to_toml(plan.mill);
  for (std::size_t p = 0; p < plan.sweep.points(); ++p) {
    try {
      check_complete(plan.config_of(p * plan.sweep.repeats));
    } catch (const InputError& e) {
      const std::string said = e.what(), mark = "--set: ";
      throw InputError(said.starts_with(mark) ? "--vary" : "",
                       said.starts_with(mark) ? said.substr(mark.size()) : said);
    }
  }
  return plan;
}

void dry_run(const SweepPlan& plan, const Options& o) {
  const int threads = static_cast<int>(std::min<std::size_t>(plan.runs(), static_cast<std::size_t>(thread_limit())));
  const double wall = seconds_of(plan) / threads;
  const bool automatic = has_auto_spin_up(plan);
  print(o.json ? nlohmann::ordered_json{{"runs", plan.runs()},
                                        {"points", plan.sweep.points()},
                                        {"threads", threads},
                                        {"seconds", io::json_number(wall, 3)}}
                         .dump(2) +
                     "\n"
               : fmt::format("{} runs at {} points, about {:.2g} s on {} threads{}\n", plan.runs(), plan.sweep.points(),
                             wall, threads,
                             automatic ? "; where spin_up is \"auto\", 30 revolutions of it are assumed" : ""));
}

std::size_t failures(const Sweep& sweep) {
  return static_cast<std::size_t>(
      std::count_if(sweep.runs.begin(), sweep.runs.end(), [](const RunOutcome& run) { return !run.error.empty(); }));
}

std::string summary(const Sweep& sweep) {
  nlohmann::ordered_json points = nlohmann::ordered_json::array();
  for (std::size_t p = 0; p < sweep.points(); ++p) {
    nlohmann::ordered_json point;
    const auto index = sweep.at(p);
    for (std::size_t k = 0; k < index.size(); ++k) {
      const std::string& value = sweep.varied[k].values[index[k]];
      const double number = io::number_of(value);
      point[sweep.varied[k].key] = std::isnan(number) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(number);
    }
    for (const std::string name : {"torque_N_m", "mill_power_W", "toe_deg", "shoulder_deg"}) {
      const Estimate e = io::over_repeats(sweep, p, io::run_quantity(name));
      point[name] = io::json_number(e.value, 9);
      point[name + "_se"] = io::json_number(e.se, 4);
    }
    points.push_back(std::move(point));
  }
  return nlohmann::ordered_json{{"runs", sweep.runs.size()}, {"failed", failures(sweep)}, {"points", points}}.dump(2) +
         "\n";
}

// What shows a finished sweep. `keep`: files that stay as they are.
void write_tables(const Options& o, const SweepPlan& plan, const Experiments& measured,
                  const std::vector<fs::path>& keep) {
  const auto wanted = [&](const fs::path& file) {
    return !file.empty() && std::find(keep.begin(), keep.end(), file) == keep.end();
  };
  if (wanted(o.csv)) io::write_sweep_csv(o.csv, plan.sweep);
  if (wanted(o.page)) io::write_plot_page(o.page, io::sweep_page(plan.sweep, plan.mill, measured));
  if (!o.figures.empty()) io::write_sweep_figures(o.figures, plan.sweep, plan.mill, measured, keep);
}

// True where the output is there and is this very sweep.
bool is_done(const Options& o, const Sweep& sweep) {
  std::error_code error;
  if (!o.resume || o.force || !fs::exists(o.output, error)) return false;
  if (io::read_sweep_definition(o.output) != io::definition_of(sweep))
    throw InputError(o.output.string(), "is a complete sweep of something else; give another output, or --force");
  return true;
}

// From its file: what is asked for and is not there yet is written, nothing is simulated.
void show_again(const Options& o, SweepPlan& plan, const Experiments& measured, const std::vector<fs::path>& files) {
  plan.sweep.runs = io::read_sweep_runs(o.output, plan.sweep);
  std::vector<fs::path> there;
  std::error_code error;
  for (const fs::path& file : files) {
    if (fs::exists(file, error))
      there.push_back(file);
    else
      io::check_output_file(file, false);
  }
  write_tables(o, plan, measured, there);
  say(o,
      o.output.string() + " is complete" + (there.size() < files.size() ? "; its tables and figures are written" : ""));
}

void sweep(Options o) {
  limit_threads(o.threads);
  const bool by_slurm = is_slurm(o.engine);
  SweepPlan plan = make_plan(o);
  Experiments measured;
  if (!o.measured.empty()) measured = io::read_measured(o.measured);
  for (const Experiment& e : measured.list) io::config_of(plan.mill, e);  // fits the mill
  if (o.dry_run) return dry_run(plan, o);
  if (by_slurm) check_slurm();
  if (o.output.empty()) throw InputError("--output", "is required; give -o SWEEP.h5");
  if (o.page.empty()) o.page = fs::path(o.output).replace_extension(".html");
  std::vector<fs::path> files{o.page};  // beside the output itself
  if (!o.csv.empty()) files.push_back(o.csv);
  if (!o.figures.empty()) {
    if (io::axis_key(plan.sweep) == plan.sweep.varied.size())
      throw InputError("--figures", "no varied key has numbers for values; vary one that has, such as mill.speed");
    io::make_output_folder(o.figures);
    for (fs::path& file : io::sweep_figure_files(o.figures, plan.sweep)) files.push_back(std::move(file));
  }
  std::vector<fs::path> outputs = files;
  outputs.push_back(o.output);
  for (const fs::path& output : outputs)
    for (const fs::path& input : {o.config, o.measured})
      if (!input.empty()) io::check_not_input(output, input);
  io::check_apart(outputs);
  if (is_done(o, plan.sweep)) {
    show_again(o, plan, measured, files);
    return o.json ? print(summary(plan.sweep)) : void();
  }

  fs::path journal_path = o.output;
  journal_path += ".runs";
  std::error_code error;
  const bool interrupted = fs::exists(journal_path, error);
  io::check_output_file(o.output, o.force);
  for (const fs::path& file : files)  // an interrupted sweep may have got to its tables
    io::check_output_file(file, o.force || (o.resume && interrupted));
  if (interrupted && !o.resume)
    say(o, "note: starting afresh over the interrupted " + journal_path.string() +
               "; --resume would have gone on with it");

  io::RunJournal journal(journal_path, o.resume);
  fs::path queue = o.output;
  queue += ".slurm";
  if (!o.resume) discard_slurm_queue(queue);
  const std::string if_stopped = "the finished runs are kept; go on with: tumble sweep ... --resume";
  if (by_slurm) {
    ProgressLine line(o, "sweeping by Slurm", if_stopped);
    sweep_by_slurm(plan, journal, queue, o.threads, line.callback());
  } else {
    TasksJournals(queue).add_to(journal);  // of a sweep by Slurm that was interrupted
  }
  ProgressLine line(o, "sweeping", if_stopped);
  diagnose::CampaignSink sink;
  sink.progress = line.callback();
  const auto tell_failure = [&](std::size_t run, const RunOutcome& outcome) {
    if (!outcome.error.empty())
      say(o, fmt::format("run {} ({}) failed: {}", run, fmt::join(plan.sets_at(run), ", "), outcome.error));
  };
  sink.known = [&](std::size_t run, RunOutcome& outcome) {
    const bool known = journal.find(plan.config_of(run), outcome);
    if (known) tell_failure(run, outcome);
    return known;
  };
  sink.finished = [&](std::size_t run, const Config& config, const RunOutcome& outcome) {
    journal.add(config, outcome);
    tell_failure(run, outcome);
  };
  plan.sweep.runs = diagnose::run_campaign(
      plan.runs(), [&](std::size_t run) { return plan.config_of(run); }, sink);
  const std::size_t failed = failures(plan.sweep);
  if (failed == plan.runs())
    throw WorkError(o.output.string(), "every run failed; the first: " + plan.sweep.runs.front().error);
  if (failed > 0) say(o, fmt::format("note: {} of {} runs failed; column error tells why", failed, plan.runs()));

  write_tables(o, plan, measured, {});
  io::write_sweep(o.output, plan.sweep);  // last: where it stands, the sweep is complete
  journal.remove();
  discard_slurm_queue(queue);
  if (o.json) print(summary(plan.sweep));
}

}  // namespace

void add_sweep(CLI::App& app) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("sweep", "Simulate a mill at every combination of some keys' values");
  verb->add_option("config", o->config, "MILL.toml")->required();
  verb->add_option("-o,--output", o->output, "SWEEP.h5 to write");
  const auto repeatable = [](CLI::Option* option) {
    option->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    return option;
  };
  repeatable(verb->add_option("--vary", o->vary, "KEY=FROM:TO:STEP (end included) or KEY=A,B,C; may be repeated"))
      ->required();
  repeatable(verb->add_option("--set", o->sets, "Override a key for all runs, such as --set run.revolutions=3"));
  verb->add_option("--repeat", o->repeats, "Runs at each point, with seeds run.seed, run.seed + 1 ...")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  verb->add_option("--csv", o->csv, "Also write a table, a row per run");
  verb->add_option("--page", o->page, "The page with the figures (default: SWEEP.html beside the output)");
  verb->add_option("--figures", o->figures,
                   "Folder for torque, power, toe and shoulder as .svg, .pdf and .csv for papers");
  verb->add_option("--measured", o->measured, "EXPERIMENTS.toml, or CSV, whose points the figures show");
  add_engine(*verb, o->engine);
  verb->add_flag("--resume", o->resume,
                 "Go on with an interrupted sweep; of a complete one write the tables and figures that are missing");
  verb->add_flag("--dry-run", o->dry_run, "Only say how many runs, and about how long they take");
  add_common(*verb, *o);
  verb->footer(
      "Example: tumble sweep examples/lab_mill_55cm.toml --vary mill.speed=0.5:1.0:0.1 --repeat 4 -o sweep.h5 --csv "
      "sweep.csv");
  verb->callback([o] { sweep(*o); });
}

}  // namespace tumble::cli
