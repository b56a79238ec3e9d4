#pragma once
#include <filesystem>

#include "cli/console.h"
#include "core/config.h"

namespace tumble::cli {

// Simulates into `output`; with `resume`, goes on with `output`.part where there is one.
void simulate_to_file(const Config& config, const std::filesystem::path& output, bool resume,
                      const CommonOptions& options);

}  // namespace tumble::cli
