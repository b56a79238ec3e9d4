#pragma once
#include <optional>

#include "tests/support/balls.h"

// A ball in the corner of shell and lifter, which carries it up: for the tests of departure and centrifuging.
namespace tumble::sim {

// Nearest lifter to (x, y) at mill angle 0, any of its features.
inline WallPoint nearest_lifter(const Shell& shell, double x, double y) {
  WallPoint nearest{.distance = INFINITY};
  for (int feature = 1; feature < feature_count(shell); ++feature) {
    const WallPoint point = nearest_on_wall(shell, pose_of(0), feature, x, y);
    if (point.distance < nearest.distance) nearest = point;
  }
  return nearest;
}

// On the shell and on the leading face of the lifter at 3 o'clock, going round with the mill.
inline Ball ball_in_the_corner(const MillModel& m, double radius, double mass) {
  const double path = m.shell.radius - radius;
  double touching = 0, apart = kPi / m.shell.lifter_count;
  for (int k = 0; k < 60; ++k) {
    const double angle = (touching + apart) / 2;
    const bool near = nearest_lifter(m.shell, path * std::cos(angle), path * std::sin(angle)).distance < radius;
    (near ? touching : apart) = angle;
  }
  Ball b{.radius = radius, .mass = mass, .x = path * std::cos(apart), .y = path * std::sin(apart)};
  b.vx = -m.speed * b.y;
  b.vy = m.speed * b.x;
  b.spin = m.speed;
  return b;
}

// Memory of the ball's contact with the shell's circle, or with a lifter; nothing while it does not touch.
inline std::optional<ContactState> wall_touch(const RunningMill& mill, bool lifter) {
  const std::vector<Contact> contacts = contacts_of(mill, lifter ? Kind::kLifters : Kind::kPlate);
  if (contacts.empty()) return std::nullopt;
  return contacts[0].state;
}

}  // namespace tumble::sim
