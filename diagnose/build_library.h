#pragma once
#include <functional>
#include <string>
#include <vector>

#include "core/experiments.h"
#include "diagnose/library.h"

// The signatures of the conditions that a mill was measured in: simulated where they are not there yet, chunk by chunk.
namespace tumble::diagnose {

struct Condition {
  Config config;  // as the experiment has it
  std::vector<Suspect> suspects;
  std::vector<double> middle;      // values of the uncertain keys
  std::string definition;          // all that its signatures hang on
  std::vector<SignatureRun> runs;  // filled by build_library; those that failed are left out
  std::size_t failed = 0;
};

// `middle`: what the config has for the uncertain keys; `toml`: the text of bare(config).
Condition make_condition(const Config& config, const std::vector<UncertainKey>& uncertain, std::vector<double> middle,
                         const std::string& toml);

struct LibrarySink {  // never called by two threads at once
  std::function<bool(std::size_t condition, std::size_t chunk, std::vector<std::vector<float>>& rows)> read;
  std::function<void(std::size_t condition, std::size_t chunk, const std::vector<std::vector<float>>& rows)> write;
  Progress progress;
};

// The mill of a run: the condition's with these assignments. Throws InputError where there can be no such mill.
using MillWith = std::function<Config(const Config& condition, const std::vector<std::string>& sets)>;

// Where a mill cannot be, its uncertain keys' distances from MILL.toml become so much smaller.
inline constexpr double kRetreat = 0.7;

// Fills `runs` of all conditions with `blocks` blocks each. Chunks are simulated in an order in which all conditions
// grow together. Returns the number of simulations that were run now.
std::size_t build_library(std::vector<Condition>& conditions, const std::vector<UncertainKey>& uncertain,
                          std::size_t blocks, const MillWith& mill_with, const LibrarySink& sink);

}  // namespace tumble::diagnose
