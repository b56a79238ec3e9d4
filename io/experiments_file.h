#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/experiments.h"

namespace tumble::io {

// Reads EXPERIMENTS.toml. Files that it names are looked for beside it and must be there. Throws InputError with file,
// line and the nearest known key; also for an experiment without any data, and for two of one name.
Experiments read_experiments(const std::filesystem::path& path);
// `folder`: that the files are relative to.
Experiments parse_experiments(const std::string& toml, const std::string& name, const std::filesystem::path& folder);

// EXPERIMENTS.toml; or, where the name ends in .csv, a table with the columns of an experiment's data (power_W,
// power_uncertainty_W, toe_deg ...), keys of MILL.toml (mill.speed), name and hold_out: a row is an experiment.
Experiments read_measured(const std::filesystem::path& path);

// The mill with what the experiment sets, then `more` ("key=value"), applied. A setting that does not fit the mill
// throws InputError with the experiment's place.
Config config_of(const Config& mill, const Experiment& experiment, const std::vector<std::string>& more = {});

}  // namespace tumble::io
