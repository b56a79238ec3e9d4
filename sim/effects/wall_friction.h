#pragma once
#include "core/effects.h"

// Another friction at shell and lifters than the model's: mu_wall -> mu_wall (1 + increase). Liners of rubber or cast
// iron, polished or scored, differ by factors (Rose & Sullivan 1958) from what a drop on a plate would suggest.
namespace tumble::sim {

inline double friction_at_wall(const Config& config, double friction) {
  return friction * (1 + effect_value(config, "wall_friction", "increase"));
}

}  // namespace tumble::sim
