#pragma once
#include <string>
#include <vector>

#include "core/run_outcome.h"
#include "core/statistics.h"

// What `calibrate` asks and what it finds.
namespace tumble {

struct FitKey {
  std::string key;
  double low = 0, high = 0;     // where to look
  double prior = kNotGiven;     // known beforehand: value ...
  double prior_sd = kNotGiven;  // ... and standard deviation; NaN = nothing but the range
};

struct FittedKey {
  FitKey asked;
  Estimate value;             // at the least misfit
  bool at_bound = false;      // the data would have it outside of the range
  bool undetermined = false;  // the data hardly say more than the range did
};

struct Prediction {  // of one datum, simulated anew at the fitted values
  std::string experiment;
  std::string quantity, unit;  // as in EXPERIMENTS.toml
  bool is_direction = false;
  bool hold_out = false;
  double speed_fraction = kNotGiven;
  Estimate measured;
  Estimate simulated;  // mean of the runs, with its standard error
};

struct PredictionGroup {  // of the fitted, or of the held-out, experiments
  std::size_t count = 0;
  double rms_relative_error = kNotGiven;  // of power and torque
  double rms_degrees = kNotGiven;         // of directions
  double reduced_chi = kNotGiven;         // rms of (simulated - measured) / standard error of both; 1 is agreement
};

struct DesignRun {  // one simulation of the fit
  std::string experiment;
  std::vector<double> at;  // value of each fitted key
  std::uint64_t seed = 0;
  RunOutcome outcome;
};

struct Calibration {
  std::string mill, measured;  // names of the files
  std::string definition;      // of all that was asked, in short
  std::vector<FittedKey> keys;
  std::vector<double> correlation;  // of the keys, row by row
  double chi2 = kNotGiven;          // at the least misfit; held-out data have no part in it
  double degrees_of_freedom = 0;
  bool misfit = false;  // chi2 is more than chance allows (5 %): the errors are widened by its root
  std::vector<Prediction> predictions;
  PredictionGroup fitted, held_out;
  std::vector<DesignRun> runs;
  std::size_t prediction_runs = 0;
  std::vector<std::string> notes;
  std::string model_toml;
};

}  // namespace tumble
