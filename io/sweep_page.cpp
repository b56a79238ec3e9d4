#include "io/sweep_page.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/version.h"
#include "io/report/html.h"
#include "io/sweep_figures.h"
#include "io/sweep_file.h"

namespace tumble::io {
namespace {

constexpr std::size_t kMostRows = 200;  // of the table of points; the CSV has them all

PageTable table_of(const Sweep& sweep) {
  PageTable table;
  table.title = "Points";
  const std::vector<const char*> names{"torque_N_m", "mill_power_W", "toe_deg", "shoulder_deg"};
  for (const VariedKey& v : sweep.varied) table.header.push_back(v.key);
  for (const char* name : names) table.header.emplace_back(name);
  table.header.emplace_back("failed");
  for (std::size_t p = 0; p < std::min(sweep.points(), kMostRows); ++p) {
    std::vector<std::string> row;
    const auto index = sweep.at(p);
    for (std::size_t k = 0; k < index.size(); ++k) row.push_back(sweep.varied[k].values[index[k]]);
    for (const char* name : names) row.push_back(report::with_error(over_repeats(sweep, p, run_quantity(name))));
    std::size_t failed = 0;
    for (std::size_t i = p * sweep.repeats; i < (p + 1) * sweep.repeats; ++i) failed += !sweep.runs[i].error.empty();
    row.push_back(failed ? std::to_string(failed) : "");
    table.rows.push_back(std::move(row));
  }
  table.note = sweep.repeats > 1
                   ? "Mean and standard error over the repeats. torque_N_m is of one slice."
                   : "One run each, with the standard error that the run says of itself. torque_N_m is of one slice.";
  if (sweep.points() > kMostRows) table.note += fmt::format(" The first {} of {} points.", kMostRows, sweep.points());
  return table;
}

}  // namespace

PlotPage sweep_page(const Sweep& sweep, const Config& mill, const Experiments& measured) {
  PlotPage page;
  page.kind = "Sweep";
  page.version = kVersion;
  std::string keys;
  for (const VariedKey& v : sweep.varied) keys += (keys.empty() ? "" : " and ") + v.key;
  page.title = fmt::format("{} runs over {}", sweep.runs.size(), keys);
  page.lead = fmt::format("{} points with {} run{} each. Bands are one standard error.", sweep.points(), sweep.repeats,
                          sweep.repeats == 1 ? "" : "s");
  std::size_t failed = 0, unsteady = 0, locked = 0;
  for (const RunOutcome& run : sweep.runs) {
    failed += !run.error.empty();
    unsteady += run.error.empty() && !run.steady;
    locked += run.locked_balls > 0 && run.motion[motion_index("speed_fraction")].value < 1;
  }
  if (failed) page.caveats.push_back(fmt::format("{} of {} runs failed and do not count.", failed, sweep.runs.size()));
  if (unsteady) page.caveats.push_back(fmt::format("{} runs were not steady over the averaged revolutions.", unsteady));
  if (locked)
    page.caveats.push_back(fmt::format(
        "{} runs end with balls locked between the lifters, which lowers the torque: an artefact of the plane slice.",
        locked));

  const std::size_t axis = axis_key(sweep);
  PageSection figures;
  figures.heading = "Figures";
  if (axis == sweep.varied.size()) {
    figures.paragraphs.push_back("No varied key has numbers for values: the table tells all.");
  } else {
    figures.plots = sweep_plots(sweep, mill, measured);
    if (sweep.points() / sweep.varied[axis].values.size() > kMostSweepLines)
      figures.paragraphs.push_back(
          fmt::format("Only the first {} combinations of the other keys are drawn.", kMostSweepLines));
  }
  page.sections.push_back(std::move(figures));
  PageSection table;
  table.heading = "Numbers";
  table.tables.push_back(table_of(sweep));
  page.sections.push_back(std::move(table));
  PageSection config;
  config.heading = "The mill";
  config.paragraphs.push_back("MILL.toml before anything was varied:");
  config.code = sweep.mill_toml;
  page.sections.push_back(std::move(config));
  return page;
}

}  // namespace tumble::io
