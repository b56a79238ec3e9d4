#include "io/run_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble::io {
namespace {

std::vector<RunQuantity> make_quantities() {
  std::vector<RunQuantity> list;
  const auto add_motion = [&](const char* name) {
    for (std::size_t i = 0; i < kMotionQuantities.size(); ++i) {
      const MotionQuantity& q = kMotionQuantities[i];
      if (q.name != std::string(name)) continue;
      list.push_back({q.name, q.unit, q.is_direction, [i](const RunOutcome& run) { return run.motion[i]; }});
    }
  };
  const auto scaled = [](const Estimate& e, double by) { return Estimate{e.value * by, e.se * by}; };
  add_motion("torque_N_m");
  list.push_back({"power_W", "W", false, [](const RunOutcome& run) { return run.power; }});
  for (const MotionQuantity& q : kMotionQuantities) {
    const std::string name = q.name;
    if (name != "torque_N_m" && name != "speed_rpm" && name != "speed_fraction" && name != "filling")
      add_motion(q.name);
  }
  list.push_back(
      {"mill_torque_N_m", "N m", false, [=](const RunOutcome& run) { return scaled(torque_of(run), run.slices); }});
  list.push_back({"mill_power_W", "W", false, [=](const RunOutcome& run) { return scaled(run.power, run.slices); }});
  return list;
}

std::vector<RunColumn> make_columns() {
  std::vector<RunColumn> list;
  const auto value = [&](const RunQuantity& q) {
    list.push_back({q.name, q.unit, [of = q.of](const RunOutcome& run) { return of(run).value; }});
  };
  const auto se = [&](const RunQuantity& q) {
    list.push_back({q.se_name(), q.unit, [of = q.of](const RunOutcome& run) { return of(run).se; }});
  };
  for (const RunQuantity& q : run_quantities()) {
    if (q.name == "mill_torque_N_m") list.push_back({"slices", "", [](const RunOutcome& run) { return run.slices; }});
    value(q);
    if (q.name == "torque_N_m") se(q);  // the only error that stands at its value: others rely on this order
  }
  for (const RunQuantity& q : run_quantities())
    if (q.name != "torque_N_m") se(q);
  const auto motion = [&](const char* name, const char* unit, std::size_t i) {
    list.push_back({name, unit, [i](const RunOutcome& run) { return run.motion[i].value; }});
  };
  motion("speed_rpm", "min-1", motion_index("speed_rpm"));
  motion("speed_fraction", "", motion_index("speed_fraction"));
  motion("filling", "", motion_index("filling"));
  list.push_back({"energy_error", "", [](const RunOutcome& run) { return run.energy_error; }});
  list.push_back({"locked_balls", "", [](const RunOutcome& run) { return run.locked_balls; }});
  list.push_back({"spin_up_revolutions", "", [](const RunOutcome& run) { return run.spin_up_revolutions; }});
  list.push_back(
      {"steady", "", [](const RunOutcome& run) { return run.error.empty() ? double(run.steady) : kNotGiven; }});
  return list;
}

}  // namespace

std::string RunQuantity::se_name() const {
  for (const std::string ending : {"_N_m", "_W", "_deg", "_m"})
    if (name.ends_with(ending)) return name.substr(0, name.size() - ending.size()) + "_se" + ending;
  return name + "_se";
}

const std::vector<RunQuantity>& run_quantities() {
  static const std::vector<RunQuantity> list = make_quantities();
  return list;
}

const RunQuantity& run_quantity(const std::string& name) {
  const auto& all = run_quantities();
  const auto it = std::find_if(all.begin(), all.end(), [&](const RunQuantity& q) { return q.name == name; });
  if (it == all.end()) throw std::logic_error("no quantity of a run is named " + name);
  return *it;
}

const std::vector<RunColumn>& run_columns() {
  static const std::vector<RunColumn> list = make_columns();
  return list;
}

std::string csv_header() {
  std::string text;
  for (const RunColumn& c : run_columns()) text += "," + c.name;
  return text + ",error";
}

std::string csv_cells(const RunOutcome& run) {
  std::string text;
  for (const RunColumn& c : run_columns()) {
    const double v = c.of(run);
    text += std::isfinite(v) ? fmt::format(",{:.9g}", v) : ",";
  }
  std::string quoted;
  for (const char c : run.error) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return text + (quoted.empty() ? "," : ",\"" + quoted + "\"");
}

}  // namespace tumble::io
