#pragma once
#include "core/config.h"

// Mills that several tests share.
namespace tumble {

// The 1992 paper's mill, Table 3: 0.545 m, 18 square lifters of 20 mm, 79 + 24 + 9 balls, 0.7 of critical.
inline Config paper_mill() {
  Config c;
  c.mill.diameter = 0.545;
  c.mill.speed = 0.7;
  c.mill.lifters.count = 18;
  c.mill.lifters.profile = LifterProfile::kRectangle;
  c.mill.lifters.height = 0.02;
  c.mill.lifters.width = 0.02;
  c.charge.count = 112;
  c.charge.balls = {{0.012, 0.060, 0.7033}, {0.018, 0.195, 0.2164}, {0.025, 0.525, 0.0803}};
  c.contact.friction = 0.1;
  c.contact.wall.restitution = 0.4;
  return c;
}

}  // namespace tumble
