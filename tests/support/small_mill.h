#pragma once
#include "core/config.h"

namespace tumble {

// A mill that turns in a tenth of a second: 40 balls on soft contacts, for tests that need many runs.
inline Config small_mill() {
  Config c;
  c.mill.diameter = 0.3;
  c.mill.speed = 0.6;
  c.mill.lifters.count = 8;
  c.mill.lifters.profile = LifterProfile::kRectangle;
  c.mill.lifters.height = 0.01;
  c.mill.lifters.width = 0.012;
  c.charge.count = 40;
  c.charge.balls = {{0.012, 0.056, 1.0}};
  c.contact.normal_stiffness = 3e4;
  c.contact.tangential_stiffness = 2e4;
  c.contact.wall.restitution = 0.5;
  c.run.spin_up = 1;
  c.run.revolutions = 3;
  c.run.frames_per_second = 50;
  return c;
}

}  // namespace tumble
