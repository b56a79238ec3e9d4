#pragma once
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/calibration.h"

// Fitting parameters of a costly, noisy simulation to measured numbers: docs/calibration.md.
namespace tumble::diagnose {

struct FitTarget {             // one measured number
  std::size_t experiment = 0;  // of 0 ... experiments - 1
  Estimate measured;           // se NaN: as uncertain as one run is scattered
  double model_sd = 0;         // what the model cannot do better than, whatever its parameters
  bool is_direction = false;
  std::string name;  // for notes: "J35-70: power_W"
};

struct FitProblem {
  std::vector<FitKey> keys;
  std::size_t experiments = 0;
  std::vector<FitTarget> targets;
  std::size_t simulations = 0;  // in all; default_simulations() is a sensible number
  std::uint64_t seed = 1;
};
std::size_t default_simulations(std::size_t keys, std::size_t experiments);
std::size_t least_simulations(std::size_t keys, std::size_t experiments);

struct Trial {  // one simulation that is asked for
  std::size_t experiment = 0;
  std::vector<double> at;  // value of each key
  std::uint64_t seed = 0;
};
// For each trial, what the run gives for each target of its experiment, in the order of the targets; NaN where the run
// has no such number.
using Simulate = std::function<std::vector<std::vector<Estimate>>(const std::vector<Trial>&)>;

struct Fit {
  std::vector<FittedKey> keys;
  std::vector<double> correlation;
  double chi2 = kNotGiven;
  double degrees_of_freedom = 0;
  bool misfit = false;
  std::vector<Estimate> emulated;  // of each target at the best values; NaN where it had no part
  std::vector<std::string> notes;
};

// A third of the simulations spread over the whole range, the rest round the best place found so far in ever smaller
// boxes; an emulator for each target; the least misfit of the emulators. Deterministic. Throws WorkError where too few
// runs succeed.
Fit fit(const FitProblem& problem, const Simulate& simulate);

}  // namespace tumble::diagnose
