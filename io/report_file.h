#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/charge_motion.h"
#include "core/deviation.h"
#include "core/frame.h"
#include "core/run_summary.h"

namespace tumble::io {

// What the report of `tumble run` shows.
struct RunReport {
  const RunSetup* setup = nullptr;
  const RunResult* result = nullptr;
  const RunSummary* summary = nullptr;
  const ChargeMotion* truth = nullptr;   // from the run file
  const ChargeMotion* film = nullptr;    // from the rendered film
  const Deviation* deviation = nullptr;  // truth against film
  std::filesystem::path film_file;       // embedded, so that the report opens from disk and by mail
  std::string config_text;               // MILL.toml as it was run
  std::string version;
  double seconds_simulating = 0, seconds_rendering = 0, seconds_analysing = 0;
};

// One self-contained HTML file: film, profile beside truth, torque trace, table of numbers, what was run.
void write_run_report(const std::filesystem::path& path, const RunReport& report);

}  // namespace tumble::io
