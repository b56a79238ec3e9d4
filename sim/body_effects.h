#pragma once
#include "sim/effects/end_wall_friction.h"
#include "sim/effects/fluid_drag.h"
#include "sim/effects/slurry_pool.h"

// What acts on every ball by itself, once a step, beside gravity.
namespace tumble::sim {

struct BodyEffects {
  FluidDrag drag;
  SlurryPool pool;
  EndWallFriction ends;

  bool on() const { return drag.on() || pool.on() || ends.on(); }
};

}  // namespace tumble::sim
