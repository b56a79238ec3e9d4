#include "cli/experiment_data.h"

#include <algorithm>
#include <cmath>

#include "cli/steps.h"
#include "core/error.h"
#include "io/csv_file.h"
#include "io/motion_file.h"

namespace tumble::cli {
namespace {

void take(Estimate& into, const Estimate& found) {
  if (std::isnan(into.value)) into = found;
}

Estimate mean_torque(const fs::path& path) {
  const io::CsvTable table = io::read_csv(path);
  table.check_columns(std::vector<std::string>{"time_s", "torque_N_m", "power_W"});
  const auto time = table.numbers("time_s");
  for (std::size_t i = 1; i < time.size(); ++i)
    if (!(time[i] > time[i - 1])) throw InputError(table.place(i, "time_s"), "is not after the row before");
  return mean_of_series(table.numbers("torque_N_m"));
}

void fill(Experiment& e, const Config& mill, const CommonOptions& options, std::vector<std::string>& notes) {
  if (!e.torque_series.empty()) {
    if (!std::isnan(e.power.value) || !std::isnan(e.torque.value))
      notes.push_back(e.name + ": torque_series is not used, for power_W or torque_N_m is given");
    else
      e.torque = mean_torque(e.torque_series);
  }
  if (!e.film.empty() || !e.motion.empty()) {
    ChargeMotion motion;
    if (e.film.empty()) {
      motion = io::read_motion(e.motion);
    } else {
      analysis::TracksOptions film;
      film.mill = &mill;
      motion = measure(e.film, film, options);
    }
    take(e.toe_deg, motion.toe_deg);
    take(e.shoulder_deg, motion.shoulder_deg);
  }
  if (!e.tracks.empty()) notes.push_back(e.name + ": tracks are not used to calibrate");
  if (std::none_of(kScalarData.begin(), kScalarData.end(),
                   [&](const ScalarDatum& d) { return !std::isnan((e.*d.measured).value); }))
    throw InputError(e.place,
                     "brings no number to calibrate by; give power_W, torque_N_m, toe_deg, shoulder_deg, "
                     "torque_series, motion or film");
}

}  // namespace

void fill_from_files(Experiment& e, const Config& mill, const CommonOptions& options, std::vector<std::string>& notes) {
  try {
    fill(e, mill, options, notes);
  } catch (const InputError& error) {  // the file alone would not tell whose it is
    const std::string said = error.what();
    throw InputError(said.starts_with(e.place) ? "" : e.place, said);
  }
}

}  // namespace tumble::cli
