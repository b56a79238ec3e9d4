#pragma once
#include <filesystem>

#include "cli/console.h"
#include "core/config.h"
#include "core/frame.h"
#include "core/progress.h"

namespace tumble::cli {

// Simulates into `output`; with `resume`, goes on with `output`.part where there is one.
RunResult write_run(const Config& config, const std::filesystem::path& output, bool resume, const Progress& progress);

// The same with a line of progress, and with what there is to say of the run.
void simulate_to_file(const Config& config, const std::filesystem::path& output, bool resume,
                      const CommonOptions& options);

}  // namespace tumble::cli
