#pragma once
#include <algorithm>
#include <map>
#include <string>
#include <vector>

#include "core/effects.h"
#include "core/random.h"

// Effects by their rows in the registry, whatever rows there are.
namespace tumble {

// The effect at `strength` times its typical size; lists name lifters 8 and 9 (under the charge of a mill
// with 12 that begins to turn), or none at strength 0.
inline EffectSettings settings_of(const Effect& effect, double strength) {
  EffectSettings settings;
  for (const EffectParameter& p : effect.parameters) {
    if (p.is_column()) {  // the table's last row at `strength` times the way that it typically falls
      settings[p.name] = typical_list(p);
      if (p.strength && strength == 0) settings[p.name].clear();
      if (p.strength && strength > 0) settings[p.name].back() = std::max(p.least, p.typical * (1 - 0.4 * strength));
    } else if (p.list) {
      settings[p.name] = strength > 0 && p.strength ? std::vector<double>{8, 9} : std::vector<double>{};
      if (!p.strength) settings.erase(p.name);
    } else {
      settings[p.name] = {p.strength ? std::min(p.most, strength * p.typical) : p.typical};
    }
  }
  return settings;
}

// Any of the effects, each with even chance, in random strength.
inline std::map<std::string, EffectSettings> some_effects(Random& random) {
  std::map<std::string, EffectSettings> effects;
  for (const Effect& effect : all_effects())
    if (random.uniform() < 0.5) effects[effect.name] = settings_of(effect, random.uniform(0.2, 1.5));
  return effects;
}

inline std::map<std::string, EffectSettings> every_effect() {
  std::map<std::string, EffectSettings> effects;
  for (const Effect& effect : all_effects()) effects[effect.name] = settings_of(effect, 1);
  return effects;
}

inline std::string names_of(const std::map<std::string, EffectSettings>& effects) {
  std::string names;
  for (const auto& [name, settings] : effects) names += name + " ";
  return names;
}

}  // namespace tumble
