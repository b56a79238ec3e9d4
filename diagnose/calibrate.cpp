#include "diagnose/calibrate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/angle.h"
#include "core/error.h"
#include "core/random.h"
#include "diagnose/fit.h"

namespace tumble::diagnose {
namespace {

// Runs that predict have seeds apart from those that fit, which lie below this.
constexpr std::uint64_t kPredictionSeeds = 2'000'000'000;

// Digits that mean something: model.toml is to be read by people, and predictions are made with what it says.
double rounded(const Estimate& e) {
  const double digits = e.se > 0 ? std::ceil(std::log10(std::abs(e.value) / e.se)) + 2 : 6;
  const int shown = static_cast<int>(std::clamp(std::isfinite(digits) ? digits : 6.0, 3.0, 12.0));
  return std::strtod(fmt::format("{:.{}g}", e.value, shown).c_str(), nullptr);
}

struct Fitted {  // one experiment that is not held out
  const Experiment* experiment;
  std::vector<const ScalarDatum*> data;
};

std::vector<Fitted> to_fit(const std::vector<Experiment>& experiments) {
  std::vector<Fitted> list;
  for (const Experiment& e : experiments) {
    if (e.hold_out) continue;
    Fitted fitted{&e, {}};
    for (const ScalarDatum& d : kScalarData)
      if (!std::isnan((e.*d.measured).value)) fitted.data.push_back(&d);
    if (!fitted.data.empty()) list.push_back(std::move(fitted));
  }
  return list;
}

FitProblem problem_of(const CalibrationRequest& request, const std::vector<Fitted>& fitted) {
  FitProblem problem;
  problem.keys = request.keys;
  problem.experiments = fitted.size();
  problem.simulations = request.simulations;
  problem.seed = request.seed;
  for (std::size_t e = 0; e < fitted.size(); ++e)
    for (const ScalarDatum* d : fitted[e].data) {
      const Estimate& measured = fitted[e].experiment->*d->measured;
      const double model_sd = d->is_direction ? 0 : request.model_error * std::abs(measured.value);
      problem.targets.push_back({e, measured, model_sd, d->is_direction, fitted[e].experiment->name + ": " + d->name});
    }
  return problem;
}

// The runs at the best values are new: where they lie farther from the emulators than both errors allow, the fit was
// led astray by too few runs.
void check_emulators(Calibration& c, const std::vector<Estimate>& emulated) {
  double sum = 0, count = 0;
  std::size_t t = 0;
  for (const Prediction& p : c.predictions) {
    if (p.hold_out) continue;
    const Estimate& guess = emulated[t++];  // both in the order of experiments and data
    const double d = p.simulated.value - guess.value, se = std::hypot(p.simulated.se, guess.se);
    if (std::isnan(d) || !(se > 0)) continue;
    const double z = (p.is_direction ? wrap_180(d) : d) / se;
    sum += z * z;
    ++count;
  }
  constexpr double kTooFar = 2;
  if (count > 0 && std::sqrt(sum / count) > kTooFar)
    c.notes.push_back(
        fmt::format("the runs at the fitted values lie {:.1f} standard errors (rms) from what the fit "
                    "expected of them: it wants more simulations (--simulations)",
                    std::sqrt(sum / count)));
}

double difference(const Prediction& p) {
  const double d = p.simulated.value - p.measured.value;
  return p.is_direction ? wrap_180(d) : d;
}

PredictionGroup group_of(const std::vector<Prediction>& predictions, bool hold_out, double repeats) {
  PredictionGroup group;
  double relative = 0, degrees2 = 0, chi2 = 0;
  std::size_t scalars = 0, directions = 0;
  for (const Prediction& p : predictions) {
    if (p.hold_out != hold_out || std::isnan(p.simulated.value)) continue;
    const double d = difference(p);
    ++group.count;
    if (p.is_direction)
      ++directions, degrees2 += d * d;
    else
      ++scalars, relative += d * d / (p.measured.value * p.measured.value);
    // Without an uncertainty of its own a measurement counts as uncertain as one run is scattered.
    const double measured_se = std::isnan(p.measured.se) ? p.simulated.se * std::sqrt(repeats) : p.measured.se;
    chi2 += d * d / (measured_se * measured_se + p.simulated.se * p.simulated.se);
  }
  if (scalars > 0) group.rms_relative_error = std::sqrt(relative / double(scalars));
  if (directions > 0) group.rms_degrees = std::sqrt(degrees2 / double(directions));
  if (group.count > 0) group.reduced_chi = std::sqrt(chi2 / double(group.count));
  return group;
}

void predict(Calibration& c, const CalibrationRequest& request, const std::vector<double>& values,
             const MillOf& mill_of, const RunAll& run_all) {
  std::vector<Config> configs;
  for (const Experiment& e : request.experiments)
    for (std::size_t k = 0; k < request.repeats; ++k)
      configs.push_back(mill_of(e, values, kPredictionSeeds + request.seed * request.repeats + k));
  const std::vector<RunOutcome> runs = run_all(configs);
  c.prediction_runs = runs.size();
  for (std::size_t i = 0; i < request.experiments.size(); ++i) {
    const Experiment& e = request.experiments[i];
    const std::size_t first = i * request.repeats;
    std::size_t failed = 0;
    for (std::size_t k = 0; k < request.repeats; ++k) failed += !runs[first + k].error.empty();
    if (failed > 0)
      c.notes.push_back(fmt::format("{}: {} of {} runs at the fitted values failed", e.name, failed, request.repeats));
    for (const ScalarDatum& d : kScalarData) {
      if (std::isnan((e.*d.measured).value)) continue;
      std::vector<Estimate> repeats;
      for (std::size_t k = 0; k < request.repeats; ++k)
        if (const Estimate q = quantity_of(runs[first + k], d); !std::isnan(q.value)) repeats.push_back(q);
      c.predictions.push_back({e.name, d.name, d.unit, d.is_direction, e.hold_out, speed_fraction(configs[first].mill),
                               e.*d.measured, mean_of_repeats(repeats, d.is_direction)});
    }
  }
  c.fitted = group_of(c.predictions, false, double(request.repeats));
  c.held_out = group_of(c.predictions, true, double(request.repeats));
}

}  // namespace

Estimate quantity_of(const RunOutcome& run, const ScalarDatum& datum) {
  if (!run.error.empty()) return {};
  const std::string name = datum.name;
  const auto of_mill = [&](const Estimate& e) { return Estimate{e.value * run.slices, e.se * run.slices}; };
  if (name == "power_W") return of_mill(run.power);
  if (name == "torque_N_m") return of_mill(torque_of(run));
  for (std::size_t i = 0; i < kMotionQuantities.size(); ++i)
    if (name == kMotionQuantities[i].name) return run.motion[i];
  return {};
}

Calibration calibrate(const CalibrationRequest& request, const MillOf& mill_of, const RunAll& run_all) {
  const std::vector<Fitted> fitted = to_fit(request.experiments);
  const FitProblem problem = problem_of(request, fitted);
  Calibration c;
  for (const FitTarget& t : problem.targets)
    if (std::isnan(t.measured.se))
      c.notes.push_back(t.name + " states no uncertainty: the scatter of one run stands for it");

  const Fit found = fit(problem, [&](const std::vector<Trial>& trials) {
    std::vector<Config> configs;
    for (const Trial& t : trials) configs.push_back(mill_of(*fitted[t.experiment].experiment, t.at, t.seed));
    const std::vector<RunOutcome> runs = run_all(configs);
    std::vector<std::vector<Estimate>> results(trials.size());
    for (std::size_t i = 0; i < trials.size(); ++i) {
      const Fitted& of = fitted[trials[i].experiment];
      for (const ScalarDatum* d : of.data) results[i].push_back(quantity_of(runs[i], *d));
      c.runs.push_back({of.experiment->name, trials[i].at, trials[i].seed, runs[i]});
    }
    return results;
  });
  c.keys = found.keys;
  c.correlation = found.correlation;
  c.chi2 = found.chi2;
  c.degrees_of_freedom = found.degrees_of_freedom;
  c.misfit = found.misfit;
  c.notes.insert(c.notes.end(), found.notes.begin(), found.notes.end());
  const auto failed =
      std::count_if(c.runs.begin(), c.runs.end(), [](const DesignRun& r) { return !r.outcome.error.empty(); });
  if (failed > 0)
    c.notes.push_back(
        fmt::format("{} of {} runs of the fit failed; column error of runs.csv tells why", failed, c.runs.size()));

  std::vector<double> values;
  for (FittedKey& key : c.keys) values.push_back(key.value.value = rounded(key.value));
  predict(c, request, values, mill_of, run_all);
  check_emulators(c, found.emulated);
  return c;
}

}  // namespace tumble::diagnose
