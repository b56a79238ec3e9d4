#pragma once
#include <string>
#include <vector>

#include "core/config.h"
#include "diagnose/observation.h"
#include "trials/trial.h"

// The experiments of a trial: as they are handed out, and as the mill and its operators really were.
namespace tumble::trials {

struct Condition {
  std::string name;
  std::vector<std::pair<std::string, std::string>> sets;  // of the mill that is handed out: speed and charge, both
  bool hold_out = false;
};

struct ConditionPlan {
  std::vector<double> speeds;  // of critical
  std::vector<double> hold_out_speeds, hold_out_fillings;
};
// Throws InputError where two are alike or the mill cannot be so.
std::vector<Condition> conditions_of(const Config& mill, const ConditionPlan& plan);

// The mill as handed out, with the condition's settings.
Config stated_config(const Config& mill, const Condition& condition);
// As it was: what is hidden in the physics, what was uncertain, and what operators misjudged (speed_error,
// filling_error). Its seed is the caller's to set.
Config true_config(const Config& mill, const Condition& condition, const TrialKey& key);

// How the instruments of this trial erred.
struct Errors {
  diagnose::Observer camera;
  double torque_offset = 0;  // share of the mean torque of the fitted experiments
};
Errors errors_of(const TrialKey& key);

}  // namespace tumble::trials
