#pragma once
#include "sim/laws/table.h"

// Restitution by a table of points (normal speed at the first touch, e), as a measurement gives it: linear between
// them, constant outside. The table takes the place of contact.restitution or contact.wall.restitution;
// impact_restitution lowers it as it lowers those. A contact keeps its value until it parts.
namespace tumble::sim {

inline Table make_tabulated_restitution(const Config& config, bool at_wall) {
  return make_table(config, "tabulated_restitution", at_wall ? "wall_restitution" : "restitution");
}

}  // namespace tumble::sim
