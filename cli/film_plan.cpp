#include "cli/film_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/mill_shape.h"
#include "core/units.h"
#include "io/config_file.h"

namespace tumble::cli {
namespace {

double length_of(const Shot& shot) { return shot.run->time().back() - shot.begin; }

// When the run has a lifter at `angle`, first [s]; its beginning where it is too short or has no lifters.
double time_of_lifter_at(const io::RunReader& run, double angle) {
  const double begin = run.time().front();
  const int lifters = make_mill_shape(run.setup().config).lifter_count;
  if (lifters == 0) return begin;
  const double pitch = 2 * kPi / lifters;
  const auto pitches = [&](double mill_angle) { return (mill_angle - angle) / pitch; };
  double before = pitches(run.frame(0).mill_angle);
  if (std::abs(before - std::round(before)) < 1e-9) return begin;
  for (std::size_t i = 1; i < run.frame_count(); ++i) {
    const double now = pitches(run.frame(i).mill_angle);
    const double passed = now > before ? std::floor(now) : std::ceil(now);
    if ((now > before && passed > before) || (now < before && passed < before))
      return std::lerp(run.time()[i - 1], run.time()[i], (passed - before) / (now - before));
    before = now;
  }
  return begin;
}

// MILL.toml's keys in full and their values as text.
std::map<std::string, std::string> values_of(const Config& config) {
  constexpr const char* kKeyLetters = "abcdefghijklmnopqrstuvwxyz_0123456789";  // no row of a list of balls
  std::map<std::string, std::string> values;
  std::string section;
  const std::string text = io::to_toml(config);
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t end = std::min(text.find('\n', from), text.size());
    const std::string line = text.substr(from, end - from);
    from = end + 1;
    if (line.starts_with('[')) {
      section = line.substr(1, line.find(']') - 1) + ".";
    } else if (const std::size_t equals = line.find(" = ");
               equals != std::string::npos && line.find_first_not_of(kKeyLetters) == equals) {
      std::string value = line.substr(equals + 3);
      std::erase(value, '"');
      values[section + line.substr(0, equals)] = value;
    }
  }
  return values;
}

// A key and its value as a label says them.
std::string in_words(const std::string& key, const std::string& value) {
  const std::string number = value.find_first_not_of("0123456789.e+-") == std::string::npos && !value.empty()
                                 ? fmt::format("{:.4g}", std::stod(value))
                                 : value;
  if (key == "mill.speed") return number + " of critical speed";
  if (key == "mill.speed_rpm") return number + " rev/min";
  if (key == "mill.diameter") return "⌀ " + number + " m";
  if (key == "mill.lifters.count") return number + " lifters";
  if (key == "mill.lifters.profile") return value == "none" ? "smooth shell" : value + " lifters";
  if (key == "charge.balls" || key == "mill.critical_speed_rpm") return "";  // too long, and no cause of anything
  if (key == "charge.count") return number + " balls";
  std::string name = key.substr(key.rfind('.') + 1);
  if (key.starts_with("contact.wall.")) name = "wall " + name;
  if (key.starts_with("mill.lifters.")) name = "lifter " + name;
  if (key.starts_with("effects.")) {
    const std::string effect = key.substr(8, key.rfind('.') - 8);
    name = value.empty() ? "no " + effect : effect + " " + name;
  } else if (value.empty()) {
    return "";
  }
  std::replace(name.begin(), name.end(), '_', ' ');
  return value.empty() ? name : name + " " + number;
}

std::vector<std::string> labels_of(const std::vector<io::RunReader>& runs) {
  constexpr std::size_t kMostParts = 3;
  std::vector<std::map<std::string, std::string>> values;
  // What people look for first stands first.
  constexpr std::array kFirst{"mill.speed",    "mill.speed_rpm", "mill.lifters.profile",
                              "mill.diameter", "charge.filling", "charge.count"};
  const auto weightier = [&](const std::string& a, const std::string& b) {
    const auto place = [&](const std::string& key) { return std::find(kFirst.begin(), kFirst.end(), key); };
    return std::pair(place(a), a) < std::pair(place(b), b);
  };
  std::set<std::string, decltype(weightier)> keys(weightier);
  for (const io::RunReader& run : runs) {
    values.push_back(values_of(run.setup().config));
    for (const auto& [key, value] : values.back()) keys.insert(key);
  }
  std::vector<std::string> labels(runs.size());
  std::vector<std::size_t> parts(runs.size(), 0);
  for (const std::string& key : keys) {
    const auto of = [&](std::size_t i) {
      const auto found = values[i].find(key);
      return found == values[i].end() ? std::string() : found->second;
    };
    if (key.starts_with("run.")) continue;  // how it was computed, not what is seen
    bool differs = false;
    for (std::size_t i = 1; i < runs.size(); ++i) differs = differs || of(i) != of(0);
    if (!differs) continue;
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const std::string part = in_words(key, of(i));
      if (part.empty() || labels[i].find(part) != std::string::npos || parts[i] >= kMostParts) continue;
      labels[i] += (labels[i].empty() ? "" : " · ") + part;
      ++parts[i];
    }
  }
  return labels;
}

}  // namespace

Timeline timeline_of(const std::vector<Shot>& shots, const FilmPlan& plan) {
  double length = INFINITY;
  for (const Shot& shot : shots) length = std::min(length, length_of(shot));
  // Within what rounding of the times can do.
  if (plan.from > length + 1e-9)
    throw InputError("--from", fmt::format("is {:g} s, but there are {:.4g} s to show", plan.from, length));
  double span = length - plan.from;
  if (!std::isnan(plan.seconds)) span = std::min(span, plan.seconds);
  if (plan.is_still) {
    if (plan.at > length + 1e-9)
      throw InputError("--at", fmt::format("is {:g} s, but there are {:.4g} s to show", plan.at, length));
    return {std::isnan(plan.at) ? plan.from + span / 2 : plan.at, 0, 1};
  }
  const double rate = double(plan.format.fps_numerator) / plan.format.fps_denominator;
  const double step = std::isnan(plan.every) ? 1 / (rate * plan.style.slow) : plan.every;
  return {plan.from, step, static_cast<std::size_t>(std::floor(span / step + 1e-6)) + 1};
}

std::vector<Shot> shots_side_by_side(const std::vector<io::RunReader>& runs, const std::vector<ChargeMotion>& truths) {
  const std::vector<std::string> labels = labels_of(runs);
  std::vector<Shot> shots;
  const double angle = runs.front().frame(0).mill_angle;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    std::string label = labels[i];
    if (label.empty() || std::count(labels.begin(), labels.end(), label) > 1) {
      const std::string file = std::filesystem::path(truths[i].origin).stem().string();
      label = label.empty() ? file : file + ": " + label;
    }
    shots.push_back({&runs[i], &truths[i], label, time_of_lifter_at(runs[i], angle)});
  }
  return shots;
}

}  // namespace tumble::cli
