#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

#include "sim/packing.h"
#include "tests/support/balls.h"
#include "tests/support/shells.h"

namespace tumble::sim {
namespace {

double energy(const RunningMill& mill) {
  const Energies e = energies_of(mill);
  return e.kinetic + e.potential + e.elastic;
}

// What a run of some balls in a mill went through.
struct Course {
  double nearest = INFINITY;     // of any centre to a wall, in radii
  double longest_pinned = 0;     // a ball deeper in a wall than a twentieth of its radius, without a break [s]
  double work = 0, balance = 0;  // of the drive; what of it is missing in the energies and losses [J]
  bool outside = false;
};

Course run(const Config& config, double seconds) {
  const MillModel model = make_mill_model(config);
  RunningMill mill = start_mill(model, place_loosely(config, model, draw_balls(config)));
  const double before = energy(mill);
  Course course;
  std::vector<double> pinned(mill.charge.size(), 0.0);
  for (double time = 0; time < seconds; time += model.time_step) {
    advance(mill);
    const double angle = mill_angle(model, mill.step);
    const ShellPose pose = pose_of(angle);
    std::vector<std::uint8_t> deep(mill.charge.size(), 0);
    std::vector<Contact> at_wall = contacts_of(mill, Kind::kPlate);
    for (const Contact& c : contacts_of(mill, Kind::kLifters)) at_wall.push_back(c);
    for (const Contact& contact : at_wall) {
      const auto i = static_cast<std::size_t>(contact.i);
      const double clear = nearest_on_wall(model.shell, pose, contact.j, mill.charge.x[i], mill.charge.y[i]).distance /
                           mill.charge.radius[i];
      course.nearest = std::min(course.nearest, clear);
      deep[i] |= clear < 0.95;
    }
    for (std::size_t i = 0; i < deep.size(); ++i) {
      pinned[i] = deep[i] ? pinned[i] + model.time_step : 0;
      course.longest_pinned = std::max(course.longest_pinned, pinned[i]);
    }
    if (mill.step % 64 != 0) continue;
    for (std::size_t i = 0; i < mill.charge.size(); ++i) {
      const double x = mill.charge.x[i], y = mill.charge.y[i], c = std::cos(angle), s = std::sin(angle);
      course.outside = course.outside || std::hypot(x, y) >= model.shell.radius ||
                       lifter_around(model.shell, c * x + s * y, c * y - s * x) >= 0;
    }
  }
  const double lost = std::accumulate(mill.ledger.dissipated.begin(), mill.ledger.dissipated.end(), 0.0);
  course.work = mill.ledger.drive_work;
  course.balance = course.work - (energy(mill) - before) - lost;
  return course;
}

Config with_balls(Config config, int count, std::vector<BallClass> balls) {
  config.charge.count = count;
  config.charge.balls = std::move(balls);
  return config;
}

BallClass steel(double radius) { return {radius, 7800 * 4.0 / 3 * kPi * radius * radius * radius, 1}; }

// In every profile, at speeds up to 1.6 of critical, for single balls and for a few of sizes up to 1:8: no centre ever
// comes near the steel, no ball stays pinned, and what the drive puts in is in the balls or in the losses.
TEST(Leak, NoBallPassesOrSticksInAWall) {
  std::uint64_t seed = 1;
  double work = 0;
  for (const NamedMill& mill : mills_of_every_profile()) {
    double deepest = 1;
    for (const double speed : {0.2, 0.7, 1.0, 1.3, 1.6}) {
      for (Config config : {with_balls(mill.config, 1, {steel(0.012)}),
                            with_balls(mill.config, 10, {steel(0.003), steel(0.008), steel(0.024)})}) {
        config.mill.speed = speed;
        config.run.seed = ++seed;
        const Course course = run(config, 0.4);
        const std::string where = mill.name + " at " + std::to_string(speed) + ", seed " + std::to_string(seed);
        EXPECT_FALSE(course.outside) << where;
        EXPECT_GT(course.nearest, 0.5) << where << ": centre to wall, in radii";
        EXPECT_LT(course.longest_pinned, 0.01) << where;
        EXPECT_LT(std::abs(course.balance), 2e-3 * std::max(std::abs(course.work), 0.1))
            << where << ", work " << course.work;
        deepest = std::min(deepest, course.nearest);
        work += course.work;
      }
    }
    EXPECT_LT(deepest, 0.99) << mill.name << ": nothing hit a wall";
  }
  EXPECT_GT(work, 1);
}

}  // namespace
}  // namespace tumble::sim
