#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/statistics.h"

// What a diagnosis said of a trial: verdict.json, as far as it is scored.
namespace tumble::trials {

struct Named {
  std::string name;
  std::map<std::string, Estimate> parameters;
};

struct Ranked {
  std::string name;
  double probability = kNotGiven;
};

struct Verdict {
  std::string verdict;                                   // "missing_effect" ...; empty: there is none, or it is broken
  std::vector<Named> effects;                            // named
  std::vector<Ranked> ranking;                           // most probable first
  double gap_before = kNotGiven, gap_after = kNotGiven;  // on what was held out, reduced chi
  double gap_runner_up = kNotGiven;                      // the same, the second best repaired instead
  bool has_next_experiment = false;
  std::string broken;  // why it cannot be read
};

// Never throws for what the file holds or does not hold: a missing or broken verdict is a wrong one.
Verdict read_verdict(const std::filesystem::path& path);
Verdict parse_verdict(const std::string& json);

}  // namespace tumble::trials
