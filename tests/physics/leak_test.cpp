#include <gtest/gtest.h>

#include "sim/packing.h"
#include "tests/support/balls.h"
#include "tests/support/mills.h"

namespace tumble::sim {
namespace {

// At 1.6 of critical, with every profile: no centre ever inside shell or lifter, at any step.
TEST(Leak, NoBallPassesAWall) {
  for (const LifterProfile profile : {LifterProfile::kRectangle, LifterProfile::kTriangle, LifterProfile::kTrapezoid}) {
    Config config = paper_mill();
    config.mill.speed = 1.6;
    config.mill.lifters.profile = profile;
    if (profile == LifterProfile::kTrapezoid) config.mill.lifters.leading_angle_deg = 20;
    const MillModel model = make_mill_model(config);
    RunningMill mill = start_mill(model, place_loosely(config, model, draw_balls(config)));
    double nearest = INFINITY;
    for (int k = 0; k < 15'000; ++k) {
      advance(mill);
      const ShellPose pose = pose_of(mill_angle(model, mill.step));
      for (const Contact& contact : mill.wall_contacts.contacts) {
        const double x = mill.charge.x[contact.i], y = mill.charge.y[contact.i], r = mill.charge.radius[contact.i];
        if (contact.j == 0) {
          nearest = std::min(nearest, (model.shell.radius - std::hypot(x, y)) / r);
        } else {
          const Direction l = lifter_direction(model.shell, pose, contact.j - 1);
          nearest = std::min(nearest,
                             nearest_on_lifter(model.shell, x * l.cos + y * l.sin, y * l.cos - x * l.sin).distance / r);
        }
      }
    }
    EXPECT_GT(nearest, 0.5) << name_of(profile) << ": centre to wall, in radii";
    EXPECT_LT(nearest, 0.99) << name_of(profile) << ": nothing hit a wall";
  }
}

}  // namespace
}  // namespace tumble::sim
