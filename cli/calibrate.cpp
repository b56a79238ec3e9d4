#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "cli/measurements.h"
#include "cli/options.h"
#include "cli/vary.h"
#include "cli/verbs.h"
#include "core/error.h"
#include "core/fingerprint.h"
#include "core/parallel_for.h"
#include "core/version.h"
#include "diagnose/calibrate.h"
#include "diagnose/campaign.h"
#include "diagnose/fit.h"
#include "io/calibration_file.h"
#include "io/config_file.h"
#include "io/config_keys.h"
#include "io/experiments_file.h"
#include "io/output.h"
#include "io/run_journal.h"
#include "io/text_file.h"

namespace tumble::cli {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kLargestJsonMiB = 64;

struct Options : CommonOptions {
  fs::path config, measured, output;
  std::vector<std::string> sets, fit;
  std::size_t simulations = 0;  // 0: by the number of keys
  std::size_t repeats = 4;
  double model_error = 0;
  std::uint64_t seed = 1;
  bool resume = false;
};

std::vector<FitKey> keys_of(const Options& o) {
  std::vector<FitKey> keys;
  for (const std::string& text : o.fit) {
    const FitRange range = parse_fit(text);
    for (const FitKey& before : keys) {
      if (before.key == range.key) throw InputError("--fit: " + range.key, "is given twice; give each key once");
      if (before.key == io::twin_of(range.key))
        throw InputError("--fit: " + range.key, "says the same as " + before.key + "; fit one of the two");
    }
    if (range.key == "run.seed") throw InputError("--fit: run.seed", "is no property of the mill; fit another key");
    keys.push_back({range.key, range.low, range.high});
  }
  return keys;
}

// What is known beforehand of the fitted keys: [uncertain] about the value in MILL.toml.
void add_priors(std::vector<FitKey>& keys, const Experiments& measured, const Config& mill,
                std::vector<std::string>& notes) {
  for (const UncertainKey& u : measured.uncertain) {
    bool used = false;
    for (FitKey& key : keys) {
      if (key.key != u.key) continue;
      used = true;
      key.prior = io::number_at(mill, key.key);
      key.prior_sd = u.sd;
      if (!std::isnan(key.prior)) continue;
      throw InputError(u.place,
                       "is uncertain about a value that MILL.toml does not give; give it there, or remove this");
    }
    if (!used) notes.push_back(u.key + " is uncertain and not fitted: taken as MILL.toml has it");
  }
}

std::vector<std::string> assignments(const std::vector<FitKey>& keys, const std::vector<double>& values) {
  std::vector<std::string> sets;
  for (std::size_t k = 0; k < keys.size(); ++k) sets.push_back(fmt::format("{}={}", keys[k].key, values[k]));
  return sets;
}

// Every experiment's mill at both ends of the ranges, and between: a mistake is to show before the first run, and so is
// a key that takes whole numbers only, which no fit can move.
void check_mills(const std::vector<Experiment>& experiments, const Config& mill, const std::vector<FitKey>& keys) {
  std::vector<double> low, high, between;
  for (const FitKey& key : keys) {
    low.push_back(key.low);
    high.push_back(key.high);
    between.push_back(key.low + (key.high - key.low) / std::sqrt(7.0));  // whole for no range that is given in decimals
  }
  for (const std::vector<double>& ends : {low, high, between}) {
    try {
      io::with_sets(mill, assignments(keys, ends));
    } catch (const InputError& e) {
      const std::string said = e.what(), mark = "--set: ";
      throw InputError(ends == between ? "--fit, between the ends of its range" : "--fit",
                       said.starts_with(mark) ? said.substr(mark.size()) : said);
    }
    for (const Experiment& e : experiments) check_complete(io::config_of(mill, e, assignments(keys, ends)));
  }
  for (const Experiment& e : experiments)
    for (const auto& [key, value] : e.sets)
      for (const FitKey& fitted : keys)
        if (key == fitted.key || key == io::twin_of(fitted.key))
          throw InputError(e.place, "sets " + key + ", which --fit " + fitted.key + " would change; leave one of them");
}

void check_has_number(const Experiment& e) {
  if (std::none_of(kScalarData.begin(), kScalarData.end(),
                   [&](const ScalarDatum& d) { return !std::isnan((e.*d.measured).value); }))
    throw InputError(
        e.place,
        "brings no number to calibrate by; give power_W, torque_N_m, toe_deg, shoulder_deg, torque_series, "
        "motion, film, or tracks with radii");
}

// All that the result depends on, in short.
std::string definition_of(const Config& mill, const diagnose::CalibrationRequest& request) {
  std::string text = fmt::format("{}\n{} {} {} {}\n{}", kVersion, request.simulations, request.repeats,
                                 request.model_error, request.seed, io::to_toml(mill));
  for (const FitKey& k : request.keys)
    text += fmt::format("{} {} {} {} {}\n", k.key, k.low, k.high, k.prior, k.prior_sd);
  for (const Experiment& e : request.experiments) {
    text += fmt::format("{} {}\n", e.name, e.hold_out);
    for (const auto& [key, value] : e.sets) text += key + "=" + value + "\n";
    for (const ScalarDatum& d : kScalarData) text += fmt::format("{} {}\n", (e.*d.measured).value, (e.*d.measured).se);
  }
  return fmt::format("{:016x}", fingerprint(text));
}

void check_outputs(const Options& o, const fs::path& journal, const std::vector<fs::path>& files) {
  std::error_code error;
  const bool going_on = o.resume && fs::exists(journal, error);
  for (const fs::path& file : files) {
    io::check_output_file(file, o.force || going_on);
    io::check_not_input(file, o.config);
    io::check_not_input(file, o.measured);
  }
  if (!o.resume && fs::exists(journal, error))
    say(o, "note: starting afresh over the interrupted " + journal.string() + "; --resume would have gone on with it");
}

void calibrate(Options o) {
  limit_threads(o.threads);
  if (!(o.model_error >= 0 && o.model_error < 1))
    throw InputError("--model-error", "must be a share of power and torque, 0 to below 1");
  const Config mill = io::read_config(o.config, o.sets);
  const Experiments measured = io::read_measured(o.measured);
  diagnose::CalibrationRequest request;
  request.keys = keys_of(o);
  request.repeats = o.repeats;
  request.model_error = o.model_error;
  request.seed = o.seed;
  check_mills(measured.list, mill, request.keys);
  std::vector<std::string> notes;
  add_priors(request.keys, measured, mill, notes);
  const fs::path model = o.output / "model.toml", json = o.output / "calibration.json", page = o.output / "report.html",
                 table = o.output / "runs.csv", journal_path = o.output / "runs.journal";
  std::error_code error;
  if (!o.resume && fs::is_directory(o.output, error))  // shows before films are measured, which takes long
    for (const fs::path& file : {model, json, page, table}) io::check_output_file(file, o.force);
  std::size_t fitted = 0;
  for (const diagnose::Measurement& m : read_measurements(measured, mill, o.output / "films", o, notes)) {
    request.experiments.push_back(m.experiment);
    check_has_number(m.experiment);
    fitted += !m.experiment.hold_out;
  }
  const std::size_t least = diagnose::least_simulations(request.keys.size(), fitted);
  request.simulations = o.simulations ? o.simulations : diagnose::default_simulations(request.keys.size(), fitted);
  if (request.simulations < least)
    throw InputError(
        "--simulations",
        fmt::format("is {}; {} keys and {} experiments to fit need at least {}, better {}", request.simulations,
                    request.keys.size(), fitted, least, diagnose::default_simulations(request.keys.size(), fitted)));

  io::make_output_folder(o.output);
  const std::string definition = definition_of(mill, request);
  if (o.resume && !o.force && fs::exists(json, error)) {
    const std::string said = io::read_text(json, "a calibration.json", kLargestJsonMiB);
    if (io::definition_in(said) != definition)
      throw InputError(json.string(), "is a complete calibration of something else; give another output, or --force");
    say(o, o.output.string() + " is complete");
    return o.json ? print(said) : void();
  }
  check_outputs(o, journal_path, {model, json, page, table});

  io::RunJournal journal(journal_path, o.resume);
  ProgressLine line(o, "calibrating", "the finished runs are kept; go on with: tumble calibrate ... --resume");
  const Progress progress = line.callback();
  const double planned = double(request.simulations / fitted * fitted + request.repeats * measured.list.size());
  double done = 0;
  const diagnose::MillOf mill_of = [&](const Experiment& e, const std::vector<double>& values, std::uint64_t seed) {
    std::vector<std::string> sets = assignments(request.keys, values);
    sets.push_back(fmt::format("run.seed={}", seed));
    return io::config_of(mill, e, sets);
  };
  const diagnose::RunAll run_all = [&](const std::vector<Config>& configs) {
    diagnose::CampaignSink sink;
    sink.progress = [&](double share) { report(progress, (done + share * double(configs.size())) / planned); };
    sink.known = [&](std::size_t run, RunOutcome& outcome) { return journal.find(configs[run], outcome); };
    sink.finished = [&](std::size_t, const Config& config, const RunOutcome& outcome) { journal.add(config, outcome); };
    auto outcomes = diagnose::run_campaign(
        configs.size(), [&](std::size_t i) { return configs[i]; }, sink);
    done += double(configs.size());
    return outcomes;
  };
  Calibration c = diagnose::calibrate(request, mill_of, run_all);
  c.mill = o.config.string();
  c.measured = o.measured.string();
  c.definition = definition;
  c.notes.insert(c.notes.begin(), notes.begin(), notes.end());
  std::vector<double> values;
  for (const FittedKey& key : c.keys) values.push_back(key.value.value);
  c.model_toml = io::to_toml(io::with_sets(mill, assignments(request.keys, values)));
  io::parse_config(c.model_toml, model.string());

  io::write_text(table, io::runs_csv(c));
  io::write_plot_page(page, io::calibration_page(c));
  io::write_text(model, c.model_toml);
  io::write_text(json, io::calibration_json(c));  // last: where it stands, the calibration is complete
  journal.remove();
  for (const std::string& note : c.notes) say(o, "note: " + note);
  for (const FittedKey& key : c.keys)
    say(o, fmt::format("{} = {:.6g}, standard error {:.2g}", key.asked.key, key.value.value, key.value.se));
  if (o.json) print(io::calibration_json(c));
}

}  // namespace

void add_calibrate(CLI::App& app) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("calibrate", "Fit keys of MILL.toml to measured experiments");
  const auto repeatable = [](CLI::Option* option) {
    option->expected(1)->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
    return option;
  };
  verb->add_option("config", o->config, "MILL.toml")->required();
  verb->add_option("--measured", o->measured, "EXPERIMENTS.toml")->required();
  repeatable(verb->add_option("--fit", o->fit, "KEY=LOW:HIGH, the range to look in; may be repeated"))->required();
  verb->add_option("-o,--output", o->output, "Folder for model.toml, calibration.json, report.html and runs.csv")
      ->required();
  repeatable(verb->add_option("--set", o->sets, "Override a key for all runs, such as --set run.revolutions=6"));
  verb->add_option("--simulations", o->simulations,
                   "Runs to fit with (default: 15 an experiment for one key, 30 for two, 48 for three)")
      ->check(CLI::Range(1, 1000000));
  verb->add_option("--repeat", o->repeats, "Runs of each experiment at the fitted values")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  verb->add_option("--model-error", o->model_error, "Share of power and torque that the model cannot do better than")
      ->capture_default_str();
  verb->add_option("--seed", o->seed, "Of the choice of runs")->check(CLI::Range(0, 1000000))->capture_default_str();
  verb->add_flag("--resume", o->resume, "Go on with an interrupted calibration");
  add_common(*verb, *o);
  verb->footer(
      "Example: tumble calibrate mill.toml --measured experiments.toml --fit contact.friction=0.05:0.6 -o calibration");
  verb->callback([o] { calibrate(*o); });
}

}  // namespace tumble::cli
