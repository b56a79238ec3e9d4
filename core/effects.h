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
  bool list = false;     // of lifter numbers, 0 at mill angle 0, counter-clockwise
  bool whole = false;    // a whole number
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
// Share of the Hertz law, by contact.law or effects.hertz_contact.
double hertz_share(const Config& config);
// Of a list of lifter numbers; empty where not given.
std::vector<int> effect_list(const Config& config, const std::string& name, const std::string& parameter);

}  // namespace tumble
