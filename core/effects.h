#pragma once
#include <span>
#include <string>
#include <vector>

#include "core/config.h"

// The registry of effects: what a model may have beside the 1992 paper's contacts. A row serves the reading of
// MILL.toml, the simulator, `tumble effects` and the diagnosis (a suspect is a row). The physics of each row is
// sim/effects/<name>.h, or the shell's for those that change its shape.
namespace tumble {

struct EffectParameter {
  const char* name;
  const char* unit;  // "" for a pure number
  double least, most;
  double otherwise;  // value where it is not given; NaN for a strength, of which one must be given
  const char* meaning;
  double typical;        // for examples and as "full strength" of a diagnosis; NaN where there is none
  bool strength = true;  // an effect whose strengths are all 0 (or empty lists) is absent
  // Several numbers: whole ones are lifters (0 at mill angle 0, counter-clockwise), others a column of a table, of
  // which the one that is no strength ascends.
  bool list = false;
  bool whole = false;  // a whole number

  bool is_column() const { return list && !whole; }
};

struct Effect {
  const char* name;
  const char* acts_on;  // "contact", "ball", "shell", "drive"
  const char* summary;
  const char* formula;
  const char* source;
  std::span<const EffectParameter> parameters;
};

std::span<const Effect> all_effects();
const Effect* find_effect(const std::string& name);  // nullptr where there is none
const EffectParameter* find_parameter(const Effect& effect, const std::string& name);

// Is the effect in the config with a strength other than 0?
bool has_effect(const Config& config, const std::string& name);

// Value of a parameter that is in force; 0 for a strength that was not given. The effect and the parameter exist.
double effect_value(const Config& config, const std::string& name, const std::string& parameter);
// What contact.friction_drop_at_critical leaves of every friction at this mill's speed.
double friction_share(const Config& config);
// Share of the Hertz law, by contact.law or effects.hertz_contact.
double hertz_share(const Config& config);
// Of a list of lifter numbers; empty where not given.
std::vector<int> effect_list(const Config& config, const std::string& name, const std::string& parameter);
// Of a column of a table; likewise.
std::vector<double> effect_column(const Config& config, const std::string& name, const std::string& parameter);

inline constexpr std::size_t kMostRows = 32;  // of a table
// What a list may look like: two lifters; a column that falls from its typical value to 0.6 of it.
std::vector<double> typical_list(const EffectParameter& parameter);

}  // namespace tumble
