#pragma once
#include "core/diagnosis.h"
#include "diagnose/posterior.h"
#include "diagnose/prove.h"

// From what was measured to a Diagnosis: library, posterior, proof.
namespace tumble::diagnose {

struct DiagnosisRequest {
  std::vector<Measurement> measurements;  // of all experiments, those held out too
  std::vector<UncertainKey> uncertain;
  std::vector<Condition> conditions;  // of each measurement that is not held out, in their order, with its library
  std::vector<double> middle;         // of the uncertain keys, in MILL.toml
  std::size_t seeds = 6;              // runs of each experiment and model, to prove it
};

// Throws InputError where the data do not allow any diagnosis. `progress`: share of the proof's simulations.
Diagnosis find_out(const DiagnosisRequest& request, const MillWith& mill_with, const Progress& progress = {});

}  // namespace tumble::diagnose
