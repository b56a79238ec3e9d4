#include "trials/conditions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/error.h"
#include "io/config_file.h"
#include "io/config_keys.h"

namespace tumble::trials {
namespace {

double value_of(const TrialKey& key, const char* name) {
  for (const Hidden& h : key.hidden)
    if (h.name == name) return h.value;
  return 0;
}

std::vector<std::string> as_sets(const Condition& condition) {
  std::vector<std::string> sets;
  for (const auto& [key, value] : condition.sets) sets.push_back(key + "=" + value);
  return sets;
}

Condition condition(const Config& mill, const std::string& name, double speed, double filling, bool hold_out) {
  const double as_is = io::number_at(mill, "charge.filling");
  Condition c{name, {{"mill.speed", fmt::format("{:g}", speed)}}, hold_out};
  if (mill.charge.count)
    c.sets.emplace_back("charge.count", fmt::format("{:.0f}", io::number_at(mill, "charge.count") * filling / as_is));
  else
    c.sets.emplace_back("charge.filling", fmt::format("{:g}", filling));
  check_complete(stated_config(mill, c));
  return c;
}

}  // namespace

std::vector<Condition> conditions_of(const Config& mill, const ConditionPlan& plan) {
  const double filling = io::number_at(mill, "charge.filling"), speed = speed_fraction(mill.mill);
  std::vector<Condition> list;
  for (const double s : plan.speeds) list.push_back(condition(mill, fmt::format("speed {:g}", s), s, filling, false));
  for (const double s : plan.hold_out_speeds)
    list.push_back(condition(mill, fmt::format("speed {:g}", s), s, filling, true));
  for (const double j : plan.hold_out_fillings)
    list.push_back(condition(mill, fmt::format("filling {:g}", j), speed, j, true));
  for (std::size_t i = 0; i < list.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (list[i].sets == list[k].sets)
        throw InputError("--speeds", list[i].name + " and " + list[k].name + " are the same mill; leave out one");
  if (plan.speeds.empty()) throw InputError("--speeds", "is empty; give at least one speed that is not held out");
  return list;
}

Config stated_config(const Config& mill, const Condition& condition) { return io::with_sets(mill, as_sets(condition)); }

Config true_config(const Config& mill, const Condition& condition, const TrialKey& key) {
  std::vector<std::string> sets = as_sets(condition);
  for (const auto& [name, value] : key.uncertain) sets.push_back(fmt::format("{}={}", name, value));
  for (const Hidden& h : key.hidden) sets.insert(sets.end(), h.sets.begin(), h.sets.end());
  Config config = io::with_sets(mill, sets);
  config.mill.speed *= 1 + value_of(key, "speed_error");
  const double filling = 1 + value_of(key, "filling_error");
  if (config.charge.count)
    config.charge.count = static_cast<int>(std::lround(*config.charge.count * filling));
  else
    config.charge.filling *= filling;
  check_complete(config);
  return config;
}

Errors errors_of(const TrialKey& key) {
  return {{value_of(key, "camera_scale"), radians(value_of(key, "camera_rotation")), value_of(key, "frame_clock")},
          value_of(key, "torque_offset")};
}

}  // namespace tumble::trials
