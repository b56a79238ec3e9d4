#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "io/plot_page.h"

namespace tumble::io {

// Plots side by side as a journal prints them: SVG or PDF by the name's end, `width_mm` wide (85 for one column, 170
// for two), letters of 8 points, and marks that tell the series apart in grey too. The legend stands above, a name once
// for all panels; several panels are lettered (a), (b) ... with their titles.
//
// Linear axes, lines and points only, no rules: std::logic_error for others. Throws WorkError where it cannot be
// written.
void write_figure(const std::filesystem::path& path, const std::vector<Plot>& panels, double width_mm);

}  // namespace tumble::io
