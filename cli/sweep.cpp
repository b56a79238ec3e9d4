#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/options.h"
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

struct Plan {
  Sweep sweep;
  Config mill;
  std::vector<std::string> sets_at(std::size_t run) const {
    std::vector<std::string> sets;
    const auto index = sweep.at(run / sweep.repeats);
    for (std::size_t k = 0; k < index.size(); ++k)
      sets.push_back(sweep.varied[k].key + "=" + sweep.varied[k].values[index[k]]);
    sets.push_back(fmt::format("run.seed={}", sweep.first_seed + run % sweep.repeats));
    return sets;
  }
  Config config_of(std::size_t run) const { return io::with_sets(mill, sets_at(run)); }
  std::size_t runs() const { return sweep.points() * sweep.repeats; }
};

// Reads all, and asks of every run whether it can be: a mistake is to show now, not after a night.
Plan make_plan(const Options& o) {
  Plan plan;
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

// A short try of the first run tells what a ball costs for a second; the rest is counting.
void dry_run(const Plan& plan, const Options& o) {
  const auto seconds_for = [&](double revolutions) {
    Config probe = plan.config_of(0);
    probe.run.spin_up_auto = false;
    probe.run.spin_up = 0;
    probe.run.revolutions = revolutions;
    const std::clock_t start = std::clock();  // the processor's: others at work on the machine do not show
    diagnose::run_once(probe, [](double) { stop_if_asked("nothing was written"); });
    return double(std::clock() - start) / CLOCKS_PER_SEC;
  };
  const auto work = [](const Config& c, double revolutions) {  // balls x simulated seconds
    double balls = 0;
    for (const int n : class_counts(c)) balls += n;
    return balls * revolutions * 60 / speed_rpm(c.mill);
  };
  constexpr double kShort = 0.05, kLong = 0.25, kAutoSpinUp = 30;
  const Config first = plan.config_of(0);
  const double begin = seconds_for(kShort);
  const double each = std::max(0.0, seconds_for(kLong) - begin) / work(first, kLong - kShort);
  double total = 0;
  bool automatic = false;
  for (std::size_t p = 0; p < plan.sweep.points(); ++p) {
    const Config c = plan.config_of(p * plan.sweep.repeats);
    automatic = automatic || c.run.spin_up_auto;
    total += (begin + each * work(c, (c.run.spin_up_auto ? kAutoSpinUp : c.run.spin_up) + c.run.revolutions)) *
             double(plan.sweep.repeats);
  }
  const int threads = static_cast<int>(std::min<std::size_t>(plan.runs(), static_cast<std::size_t>(thread_limit())));
  const double wall = total / threads;
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
void write_tables(const Options& o, const Plan& plan, const Experiments& measured, const std::vector<fs::path>& keep) {
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
void show_again(const Options& o, Plan& plan, const Experiments& measured, const std::vector<fs::path>& files) {
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
  if (o.engine == "slurm")
    throw InputError("--engine", "slurm is not in this version; local uses all cores of this machine");
  if (o.engine != "local") throw InputError("--engine", "is \"" + o.engine + "\"; give local");
  Plan plan = make_plan(o);
  Experiments measured;
  if (!o.measured.empty()) measured = io::read_measured(o.measured);
  for (const Experiment& e : measured.list) io::config_of(plan.mill, e);  // fits the mill
  if (o.dry_run) return dry_run(plan, o);
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
  diagnose::CampaignSink sink;
  ProgressLine line(o, "sweeping", "the finished runs are kept; go on with: tumble sweep ... --resume");
  sink.progress = line.callback();
  sink.known = [&](std::size_t run, RunOutcome& outcome) { return journal.find(plan.config_of(run), outcome); };
  sink.finished = [&](std::size_t run, const Config& config, const RunOutcome& outcome) {
    journal.add(config, outcome);
    if (!outcome.error.empty())
      say(o, fmt::format("run {} ({}) failed: {}", run, fmt::join(plan.sets_at(run), ", "), outcome.error));
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
  verb->add_option("--engine", o->engine, "local: all cores of this machine")->capture_default_str();
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
