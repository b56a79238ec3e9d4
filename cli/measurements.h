#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "cli/console.h"
#include "core/config.h"
#include "core/experiments.h"
#include "diagnose/measurement.h"

namespace tumble::cli {

// Reads all that the experiments brought, in their order, and checks that it fits together and fits the mill.
// Experiment::power, toe_deg ... are filled in from the files that tell them; what is given as a number stands. A film
// is analysed once and kept in the folder `films`, which is made where it is needed: an interrupted work does not look
// at it again. An empty name: nothing is kept. `notes` takes what is not used or is lost. Throws InputError:
// docs/measurements.md lists for what.
std::vector<diagnose::Measurement> read_measurements(const Experiments& experiments, const Config& mill,
                                                     const std::filesystem::path& films, const CommonOptions& options,
                                                     std::vector<std::string>& notes);

}  // namespace tumble::cli
