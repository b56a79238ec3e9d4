#include "cli/diagnosis_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <set>
#include <string>

#include "cli/diagnosis_film.h"
#include "cli/simulation.h"
#include "core/angle.h"
#include "core/error.h"
#include "core/units.h"
#include "diagnose/lifter_passage.h"
#include "io/config_file.h"
#include "io/experiments_file.h"
#include "io/output.h"
#include "io/run_file.h"

namespace tumble::cli {
namespace fs = std::filesystem;
namespace {

using diagnose::Measurement;
using diagnose::SeenFrame;

constexpr double kRevolutions = 3;        // as many as a film shows
constexpr double kFramesPerSecond = 100;  // at least
constexpr double kFramesPerPassage = 12;  // of a lifter: places of a torque curve

fs::path part_of(const fs::path& folder) { return folder / "runs.part"; }

// A name of an experiment as one of a file.
std::string file_name(const std::string& experiment, const std::set<std::string>& taken) {
  std::string name;
  for (const char c : experiment)
    name += std::isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '-' || c == '_' ? c : '_';
  if (name.starts_with('.')) name.front() = '_';
  std::string own = name;
  for (int n = 2; taken.contains(own); ++n) own = fmt::format("{}-{}", name, n);
  return own;
}

Config shown(Config config) {
  config.run.revolutions = kRevolutions;
  const double turns_per_second = speed_rpm(config.mill) / 60;
  config.run.frames_per_second =
      std::max(kFramesPerSecond, std::ceil(kFramesPerPassage * config.mill.lifters.count * turns_per_second));
  return config;
}

// The mill's angle at a moment between two frames [degrees]; NaN outside.
double angle_at(const std::vector<SeenFrame>& frames, double time) {
  const auto after =
      std::lower_bound(frames.begin(), frames.end(), time, [](const SeenFrame& f, double t) { return f.time < t; });
  if (after == frames.end()) return kNotGiven;
  if (after->time == time) return degrees(after->mill_angle);
  if (after == frames.begin()) return kNotGiven;
  const SeenFrame& before = *(after - 1);
  const double share = (time - before.time) / (after->time - before.time);
  return degrees(before.mill_angle + share * (after->mill_angle - before.mill_angle));
}

// What torque_over_passage() needs of each.
ChargeMotion turning(const Measurement& m, double clock) {
  ChargeMotion motion;
  motion.lifter_count = m.config.mill.lifters.count;
  for (const diagnose::TorqueSample& sample : m.torque_series) {
    motion.profile.push_back({.time = sample.time, .mill_angle_deg = angle_at(m.frames, clock * sample.time)});
    motion.torque_series.push_back({.time = sample.time, .torque = sample.torque});
  }
  return motion;
}

ChargeMotion turning(const fs::path& file) {
  const io::RunReader run(file);
  ChargeMotion motion;
  motion.lifter_count = run.setup().config.mill.lifters.count;
  for (std::size_t i = 0; i < run.frame_count(); ++i) {
    motion.profile.push_back({.time = run.time()[i], .mill_angle_deg = degrees(run.frame(i).mill_angle)});
    motion.torque_series.push_back({.time = run.time()[i], .torque = run.torque()[i]});
  }
  return motion;
}

}  // namespace

void DiagnosisRuns::check(const fs::path& folder, bool force) {
  std::error_code error;
  const fs::path runs = folder / "runs";
  if (!fs::exists(fs::symlink_status(runs, error))) return;
  if (!fs::is_directory(runs, error)) throw InputError(runs.string(), "is no folder; remove it");
  if (!force) throw InputError(runs.string(), "exists; remove it or add --force to replace what is in it");
}

DiagnosisRuns::DiagnosisRuns(const fs::path& folder, const Diagnosis& d, const std::vector<Measurement>& measurements,
                             const CommonOptions& options)
    : folder_(folder), options_(options), pairs_(measurements.size()) {
  const bool has_table = !d.model_tabulated_toml.empty(), has_after = has_table || d.model_toml != d.mill_toml;
  const std::string& model_toml = has_table ? d.model_tabulated_toml : d.model_toml;
  const fs::path part = part_of(folder);
  struct Run {
    Config config;
    fs::path* file;
  };
  std::vector<Run> runs;
  std::set<std::string> names;
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const Measurement& m = measurements[i];
    const std::string name = *names.insert(file_name(m.experiment.name, names)).first;
    Pair& pair = pairs_[i];
    pair.measurement = &m;
    pair.before = part / (name + "-before.h5");
    runs.push_back({shown(io::with_sets(m.config, d.experiments[i].before)), &pair.before});
    if (has_after) {
      pair.after = part / (name + "-after.h5");
      const Config after = io::config_of(io::parse_config(model_toml, "model.toml"), m.experiment);
      const MeasurementErrors &now = after.measurement, &was = m.config.measurement;
      pair.torque_offset = (or_nothing(now.torque_offset_N_m) - or_nothing(was.torque_offset_N_m)) / slice_count(after);
      pair.clock = (1 + or_nothing(now.frame_clock)) / (1 + or_nothing(was.frame_clock));
      runs.push_back({shown(after), &pair.after});
    }
  }
  std::error_code error;
  fs::remove_all(part, error);
  io::make_output_folder(part);
  ProgressLine line(options, "runs before and after", "the library is kept; the same command goes on from it");
  const Progress progress = line.callback();
  for (std::size_t i = 0; i < runs.size(); ++i) try {
      write_run(runs[i].config, *runs[i].file, false,
                [&](double share) { progress((double(i) + share) / double(runs.size())); });
    } catch (const Interrupted&) {
      fs::remove_all(part, error);
      throw;
    } catch (const Error& e) {  // the verdict does not hang on it
      say(options, "note: " + runs[i].file->filename().string() + " is left out: " + e.what());
      runs[i].file->clear();
    }
}

DiagnosisRuns::~DiagnosisRuns() {
  std::error_code ignored;
  fs::remove_all(part_of(folder_), ignored);
}

std::vector<TorqueCurve> DiagnosisRuns::torque() const {
  std::vector<TorqueCurve> curves;
  for (const Pair& pair : pairs_) {
    const Measurement& m = *pair.measurement;
    if (pair.before.empty() || m.torque_series.empty() || m.frames.empty() || std::isnan(m.frames.front().mill_angle))
      continue;
    std::vector<ChargeMotion> motions{turning(m, pair.clock), turning(pair.before)};
    if (!pair.after.empty()) motions.push_back(turning(pair.after));
    std::vector<const ChargeMotion*> compared;
    for (const ChargeMotion& motion : motions) compared.push_back(&motion);
    const diagnose::OverPassage over = diagnose::torque_over_passage(compared);
    if (over.past_deg.empty()) continue;
    TorqueCurve curve{
        .experiment = m.experiment.name, .x_name = "a lifter’s angle past 3 o’clock", .x_unit = "degrees"};
    curve.x = over.past_deg;
    const auto fill = [&](std::size_t which, double offset, std::vector<double>& values, std::vector<double>& errors) {
      for (const Estimate& e : over.torque[which]) values.push_back(e.value + offset), errors.push_back(e.se);
    };
    fill(0, 0, curve.measured, curve.measured_se);
    fill(1, 0, curve.before, curve.before_se);
    if (motions.size() > 2) fill(2, pair.torque_offset, curve.after, curve.after_se);
    curves.push_back(std::move(curve));
  }
  return curves;
}

std::vector<io::DiagnosisFilm> DiagnosisRuns::film(const fs::path& file) const {
  for (const Pair& pair : pairs_) {
    const Measurement& m = *pair.measurement;
    if (pair.before.empty() || m.experiment.hold_out || !m.is_film) continue;
    const io::RunReader before(pair.before);
    std::optional<io::RunReader> after;
    if (!pair.after.empty()) after.emplace(pair.after);
    const DiagnosisFilmFile film =
        make_diagnosis_film(m.experiment.film, m.motion, before, after ? &*after : nullptr, file, options_);
    if (film.file.empty()) continue;
    return {{film.file, m.experiment.name + ". " + film.caption}};
  }
  return {};
}

void DiagnosisRuns::keep() {
  const fs::path runs = folder_ / "runs";
  io::make_output_folder(runs);
  std::vector<fs::path> old;  // of a diagnosis that this one replaces
  for (const auto& file : fs::directory_iterator(runs)) {
    const std::string stem = file.path().stem().string();
    if (stem.ends_with("-before") || stem.ends_with("-after")) old.push_back(file.path());
  }
  for (const fs::path& file : old) fs::remove(file);
  for (const auto& file : fs::directory_iterator(part_of(folder_)))
    if (file.path().extension() != ".part") fs::rename(file.path(), runs / file.path().filename());
}

}  // namespace tumble::cli
