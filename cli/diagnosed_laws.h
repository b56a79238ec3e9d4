#pragma once
#include <vector>

#include "core/config.h"
#include "core/diagnosis.h"
#include "diagnose/measurement.h"

namespace tumble::cli {

// Laws as the balls show them, contact by contact: Diagnosis::laws. Where something is behind
// the gap that is on no list, also what the model's own laws lack: Diagnosis::found_laws, and model_tabulated_toml
// where tables can say it. Takes mill_toml, finding, keys and experiments of the diagnosis.
void add_laws(Diagnosis& diagnosis, const std::vector<diagnose::Measurement>& measurements);

}  // namespace tumble::cli
