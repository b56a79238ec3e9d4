#pragma once
#include <string>
#include <vector>

#include "cli/console.h"
#include "core/config.h"
#include "core/experiments.h"

namespace tumble::cli {

// Fills in the numbers that an experiment brings in files: toe and shoulder from its film or motion file, the mean
// torque from its torque series. A number that is given as such stands. `notes` takes what is not used. Throws
// InputError where the experiment then holds no number.
void fill_from_files(Experiment& experiment, const Config& mill, const CommonOptions& options,
                     std::vector<std::string>& notes);

}  // namespace tumble::cli
