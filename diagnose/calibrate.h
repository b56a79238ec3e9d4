#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/calibration.h"
#include "core/config.h"
#include "core/experiments.h"

namespace tumble::diagnose {

struct CalibrationRequest {
  std::vector<FitKey> keys;
  std::vector<Experiment> experiments;  // with the numbers from their files filled in
  std::size_t simulations = 0;          // to fit
  std::size_t repeats = 4;              // runs of each experiment to predict
  double model_error = 0;               // share of power and torque that the model cannot do better than
  std::uint64_t seed = 1;
};

// The mill of an experiment with these values of the fitted keys.
using MillOf =
    std::function<Config(const Experiment& experiment, const std::vector<double>& values, std::uint64_t seed)>;
using RunAll = std::function<std::vector<RunOutcome>(const std::vector<Config>& configs)>;

// Fits the keys to the experiments that are not held out, then simulates all of them anew at the best values. `mill_of`
// and `run_all` are called in an order that depends on the request alone. The result lacks the names of files.
Calibration calibrate(const CalibrationRequest& request, const MillOf& mill_of, const RunAll& run_all);

// What a run gives for a datum of an experiment: of the whole mill.
Estimate quantity_of(const RunOutcome& run, const ScalarDatum& datum);

}  // namespace tumble::diagnose
