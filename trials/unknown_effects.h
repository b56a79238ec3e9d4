#pragma once
#include <span>
#include <string>

#include "core/config.h"
#include "sim/outside_force.h"

// Effects that only the maker of blind trials knows: plausible in a mill, not in the registry (core/effects.h), and
// nothing in the registry moves the charge as they do. They act through the simulator's one door for what is no part of
// the model, sim/outside_force.h.
namespace tumble::trials {

struct UnknownEffect {
  const char* name;
  const char* formula;
  const char* source;     // where in a mill it comes from, and who wrote the formula
  const char* parameter;  // its strength
  const char* unit;
  double full;  // of the strength, as core/effects.h has `typical`
};

std::span<const UnknownEffect> unknown_effects();

// In this mill, with `value` of the effect's parameter. Throws std::logic_error for a name that is not in the list.
sim::OutsideForce force_of(const std::string& name, double value, const Config& mill);

}  // namespace tumble::trials
