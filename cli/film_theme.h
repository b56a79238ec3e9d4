#pragma once
#include <cstdint>
#include <filesystem>

#include "cli/steps.h"

namespace tumble::cli {

// Renders a run as a camera in a laboratory would film it: nothing but mill and charge, in the light and with the
// faults that a film has. `output` as in render_run. Returns the number of pictures.
std::size_t render_filmed_run(const io::RunReader& run, const FilmPlan& plan, std::uint64_t look_seed,
                              const fs::path& output, const CommonOptions& options);

}  // namespace tumble::cli
