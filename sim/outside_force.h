#pragma once
#include <functional>

// What acts on every ball, once a step, and is no part of the model: given by the caller of simulate(), so that whoever
// makes blind trials (docs/trials.md) can put into a mill what no MILL.toml can say and no diagnosis can look up.
namespace tumble::sim {

struct BallState {        // in the lab frame
  double time = 0;        // since the mill began to turn [s]
  double mill_angle = 0;  // [rad]
  double mill_speed = 0;  // counter-clockwise > 0 [rad/s]
  double x = 0, y = 0;    // [m]
  double vx = 0, vy = 0;  // at the positions' own time, as the last step foresees them [m/s]
  double spin = 0;        // likewise [rad/s]
  double radius = 0;      // [m]
  double mass = 0;        // [kg]
};

struct OutsidePush {
  double fx = 0, fy = 0;        // [N]
  double couple = 0;            // [N m]
  bool reacts_on_mill = false;  // its moment about the axis is the drive's to bring; else it comes from outside
};

// Called by several threads at once: it may hang on the ball alone. Its work is booked under no cause of dissipation.
using OutsideForce = std::function<OutsidePush(const BallState&)>;

}  // namespace tumble::sim
