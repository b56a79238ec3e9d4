#include "io/run_journal.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/fingerprint.h"
#include "core/version.h"
#include "io/config_file.h"

namespace tumble::io {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

Json header() { return {{"journal_of_runs", 1}, {"tumble", kVersion}}; }

Json number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }
Json pair(const Estimate& e) { return {number(e.value), number(e.se)}; }
double number(const Json& j) { return j.is_null() ? kNotGiven : j.get<double>(); }
Estimate estimate(const Json& j) { return {number(j.at(0)), number(j.at(1))}; }

Json json_of(std::uint64_t key, const RunOutcome& run) {
  if (!run.error.empty()) return {{"run", key}, {"error", run.error}};
  Json motion;
  for (const Estimate& e : run.motion) motion.push_back(pair(e));
  return {{"run", key},
          {"motion", motion},
          {"power", pair(run.power)},
          {"slices", number(run.slices)},
          {"energy_error", number(run.energy_error)},
          {"locked_balls", number(run.locked_balls)},
          {"spin_up_revolutions", number(run.spin_up_revolutions)},
          {"steady", run.steady}};
}

RunOutcome outcome_of(const Json& j) {
  RunOutcome run;
  if (j.contains("error")) {
    run.error = j.at("error").get<std::string>();
    return run;
  }
  const Json& motion = j.at("motion");
  for (std::size_t i = 0; i < run.motion.size(); ++i) run.motion[i] = estimate(motion.at(i));
  run.power = estimate(j.at("power"));
  run.slices = number(j.at("slices"));
  run.energy_error = number(j.at("energy_error"));
  run.locked_balls = number(j.at("locked_balls"));
  run.spin_up_revolutions = number(j.at("spin_up_revolutions"));
  run.steady = j.at("steady").get<bool>();
  return run;
}

std::string text_of(const Json& j) { return j.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n"; }

// The finished runs of a journal that begin at `from`, which becomes where its whole lines end. One of another version
// holds none.
void read_runs(const fs::path& path, std::uintmax_t& from,
               const std::function<void(std::uint64_t key, const RunOutcome& run)>& use) {
  std::ifstream file(path, std::ios::binary);
  std::string line;
  if (from == 0) {
    if (!std::getline(file, line) || file.eof() || line + "\n" != text_of(header())) return;
    from = line.size() + 1;
  }
  file.seekg(static_cast<std::streamoff>(from));
  while (std::getline(file, line) && !file.eof()) {
    try {
      const Json j = Json::parse(line);
      use(j.at("run").get<std::uint64_t>(), outcome_of(j));
    } catch (const nlohmann::json::exception&) {
      return;
    }
    from += line.size() + 1;
  }
}

}  // namespace

RunJournal::RunJournal(fs::path path, bool resume) : path_(std::move(path)) {
  std::uintmax_t whole = 0;
  if (resume) read_runs(path_, whole, [&](std::uint64_t key, const RunOutcome& run) { known_[key] = run; });
  file_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (file_ < 0 || ftruncate(file_, static_cast<off_t>(whole)) != 0)
    throw WorkError(path_.string(), std::string("cannot be written: ") + std::strerror(errno));
  if (whole == 0) append(text_of(header()));
}

RunJournal::~RunJournal() {
  if (file_ >= 0) close(file_);
}

std::uint64_t RunJournal::key_of(const Config& config) { return fingerprint(to_toml(config)); }

void RunJournal::take(const fs::path& other, std::uintmax_t& from) {
  read_runs(other, from, [&](std::uint64_t key, const RunOutcome& run) {
    if (!has(key)) add(key, run);
  });
}

bool RunJournal::find(const Config& config, RunOutcome& outcome) const {
  const auto it = known_.find(key_of(config));
  if (it == known_.end()) return false;
  outcome = it->second;
  return true;
}

void RunJournal::add(const Config& config, const RunOutcome& outcome) { add(key_of(config), outcome); }

void RunJournal::add(std::uint64_t key, const RunOutcome& outcome) {
  append(text_of(json_of(key, outcome)));
  known_[key] = outcome;
}

void RunJournal::append(const std::string& line) {
  // One call for the line: a process that is killed leaves it whole or not there. A full disk may leave part of it.
  const ssize_t written = write(file_, line.data(), line.size());
  if (written == static_cast<ssize_t>(line.size())) return;
  const int why = written < 0 ? errno : ENOSPC;
  throw WorkError(path_.string(), std::string("cannot be written: ") + std::strerror(why));
}

void RunJournal::remove() {
  std::error_code ignored;
  fs::remove(path_, ignored);
}

}  // namespace tumble::io
