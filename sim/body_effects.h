#pragma once
#include "sim/effects/end_wall_friction.h"
#include "sim/effects/fluid_drag.h"
#include "sim/effects/slurry_pool.h"
#include "sim/effects/tabulated_drag.h"

// What acts on every ball by itself, once a step, beside gravity.
namespace tumble::sim {

struct BodyEffects {
  FluidDrag drag;
  SlurryPool pool;
  EndWallFriction ends;
  TabulatedDrag tabulated;

  bool dragged() const { return drag.on() || tabulated.on(); }
  bool in_fluid() const { return dragged() || pool.on(); }
  bool on() const { return in_fluid() || ends.on(); }
};

}  // namespace tumble::sim
