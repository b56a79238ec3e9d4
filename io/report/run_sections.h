#pragma once
#include <vector>

#include "io/plot_page.h"
#include "io/report_file.h"

// The parts of a run's report that come from the simulation alone.
namespace tumble::io::report {

// Where the power goes, impacts and falls, fluid, whether the averages can be trusted, from one slice to the mill, and
// the effects that are on; what a run does not have is left out. `cut_deg`: direction, on a multiple of 30 degrees, at
// which plots round the shell are cut open.
std::vector<PageSection> run_sections(const RunReport& report, int cut_deg);

}  // namespace tumble::io::report
