#pragma once
#include <functional>
#include <string>
#include <vector>

#include "core/run_outcome.h"

// What a table of many runs has in its columns: one list for SWEEP.h5, the CSVs and the pages.
namespace tumble::io {

struct RunQuantity {
  std::string name;  // with its unit: "torque_N_m"
  std::string unit;  // "N m"
  bool is_direction = false;
  std::function<Estimate(const RunOutcome&)> of;

  std::string se_name() const;  // "torque_se_N_m"
};
// Torque and power of the slice, toe, shoulder and what else summary.json has, then torque and power of the mill.
const std::vector<RunQuantity>& run_quantities();
const RunQuantity& run_quantity(const std::string& name);  // one that is there

struct RunColumn {
  std::string name, unit;
  std::function<double(const RunOutcome&)> of;  // NaN where it cannot be had
};
// torque_N_m, torque_se_N_m, power_W, toe_deg, shoulder_deg ... slices, mill_power_W, the other standard errors, and
// what tells whether a run is to be believed.
const std::vector<RunColumn>& run_columns();

// The columns' names, and one run's numbers, each after a comma; at the end `error`, in quotes where there is one.
std::string csv_header();
std::string csv_cells(const RunOutcome& run);

}  // namespace tumble::io
