#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/config.h"
#include "core/experiments.h"
#include "core/sweep.h"
#include "io/plot_page.h"

// The figures of a sweep: torque, power, toe, shoulder ... against a varied key that has numbers, a line for each
// combination of the others, with what was measured and with Morrell's toe and shoulder.
namespace tumble::io {

inline constexpr std::size_t kMostSweepLines = 12;  // in one plot: more cannot be told apart

// The varied key (its place) whose values are numbers, and most; the first of equals. sweep.varied.size(): none.
std::size_t axis_key(const Sweep& sweep);

// For a page: all quantities against axis_key, which there must be.
std::vector<Plot> sweep_plots(const Sweep& sweep, const Config& mill, const Experiments& measured);

// For a paper: torque, power, and toe beside shoulder against axis_key, and likewise "..._by_charge_filling" against
// each other key with at least three numbers. Each as .svg, .pdf and .csv, which has the figure's numbers in rows.
std::vector<std::filesystem::path> sweep_figure_files(const std::filesystem::path& folder, const Sweep& sweep);
// Those that are not among `keep`. Throws WorkError where one cannot be written.
void write_sweep_figures(const std::filesystem::path& folder, const Sweep& sweep, const Config& mill,
                         const Experiments& measured, const std::vector<std::filesystem::path>& keep = {});

}  // namespace tumble::io
