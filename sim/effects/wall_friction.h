#pragma once
#include "core/effects.h"

// Another friction at shell and lifters than the model's: mu_wall -> mu_wall (1 + increase). A model: a factor on
// Coulomb's coefficient. Liners of rubber, cast iron, polished or scored steel differ (Peng et al., Tribol. Trans.
// 2020, doi:10.1080/10402004.2020.1831120, measured it in a mill).
namespace tumble::sim {

inline double friction_at_wall(const Config& config, double friction) {
  return friction * (1 + effect_value(config, "wall_friction", "increase"));
}

}  // namespace tumble::sim
