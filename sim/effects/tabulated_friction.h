#pragma once
#include "sim/effects/wall_friction.h"
#include "sim/laws/table.h"

// Friction by a table of points (sliding speed, mu), as a measurement gives it: linear between them, constant outside.
// The table takes the place of contact.friction or contact.wall.friction; what changes those (the drop with the mill's
// speed, wall_friction, friction_weakening) changes it in the same way.
namespace tumble::sim {

inline Table make_tabulated_friction(const Config& config, bool at_wall) {
  const double at_this_speed = friction_share(config);
  return at_wall ? make_table(config, "tabulated_friction", "wall_friction", friction_at_wall(config, at_this_speed))
                 : make_table(config, "tabulated_friction", "friction", at_this_speed);
}

}  // namespace tumble::sim
