#include "sim/frame_forces.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "core/units.h"
#include "sim/simulator.h"
#include "tests/support/mills.h"
#include "tests/support/small_mill.h"

namespace tumble::sim {
namespace {

constexpr double kStiffness = 4e5;

// Balls of 12, 18 and 25 mm at rest; those not placed lie apart from everything.
struct Scene {
  RunSetup setup;
  Frame frame;
  explicit Scene(const Config& config) {
    setup.config = config;
    setup.balls.radius = {0.012, 0.018, 0.025};
    setup.balls.mass = {0.060, 0.195, 0.525};
    frame.x = {-0.08, 0, 0.08};
    frame.y = frame.vx = frame.vy = {0, 0, 0};
  }
  std::vector<ContactForce> forces() const { return FrameForces(setup).at(frame); }
};

TEST(FrameForces, OfTwoBallsAtRestAreTheSpringsAlone) {
  const double overlap = 2.5e-4;
  Scene scene(paper_mill());
  EXPECT_TRUE(scene.forces().empty());
  const double d = 0.012 + 0.018 - overlap;
  scene.frame.x[0] = -0.6 * d;
  scene.frame.y[0] = 0.8 * d;
  const auto contacts = scene.forces();
  ASSERT_EQ(contacts.size(), 1u);
  EXPECT_EQ(contacts[0].i, 0);
  EXPECT_EQ(contacts[0].j, 1);
  EXPECT_NEAR(contacts[0].normal, kStiffness * overlap, 1e-9);
  // Where they touch: in the middle of the overlap.
  EXPECT_NEAR(std::hypot(contacts[0].x, contacts[0].y), 0.018 - overlap / 2, 1e-15);
  EXPECT_EQ(largest_forces(contacts, 3), (std::vector<double>{contacts[0].normal, contacts[0].normal, 0}));
}

// F = k d + C v with C of eq. 13, less the 2 % by which the law allows for the time step.
TEST(FrameForces, HaveTheDashpotOfTheirVelocities) {
  const double overlap = 2.5e-4, closing = 0.3, e = 0.8;
  Scene scene(paper_mill());
  scene.frame.x[0] = -(0.012 + 0.018 - overlap);
  scene.frame.vx[0] = closing;
  const double mass = 0.060 * 0.195 / (0.060 + 0.195), l = std::log(e);
  const double dashpot = -2 * l * std::sqrt(mass * kStiffness) / std::sqrt(l * l + kPi * kPi) * closing;
  ASSERT_EQ(scene.forces().size(), 1u);
  EXPECT_NEAR(scene.forces()[0].normal - kStiffness * overlap, dashpot, 0.03 * dashpot);
  scene.frame.vx[0] = -closing;
  EXPECT_NEAR(scene.forces()[0].normal - kStiffness * overlap, -dashpot, 0.03 * dashpot);
}

// Without friction and losses the springs hold F^2 / 2 k each, and the simulation says what they hold in all: every
// contact with ball, plate and lifter is found, and none twice.
TEST(FrameForces, HoldTheEnergyThatTheSimulationHas) {
  Config config = small_mill();
  config.contact.tangential_stiffness = 0;
  config.contact.friction = 0;
  config.contact.restitution = config.contact.wall.restitution = 1;
  config.run.spin_up = 0.3;
  config.run.revolutions = 0.4;
  RunSetup setup;
  double energy = 0, most_walls = 0;
  int frames = 0;
  std::optional<FrameForces> forces;
  RunSink sink;
  sink.setup = [&](const RunSetup& of) {
    setup = of;
    forces.emplace(setup);
  };
  sink.frame = [&](const Frame& frame) {
    double held = 0, walls = 0;
    for (const ContactForce& c : forces->at(frame)) {
      held += c.normal * c.normal / (2 * config.contact.normal_stiffness);
      walls += c.j < 0;
    }
    EXPECT_NEAR(held, frame.observed.elastic, 1e-6 * frame.observed.elastic + 1e-12);
    energy += held;
    most_walls = std::max(most_walls, walls);
    ++frames;
  };
  simulate(config, sink);
  EXPECT_GT(frames, 10);
  EXPECT_GT(energy, 0);
  EXPECT_GT(most_walls, 3);
}

}  // namespace
}  // namespace tumble::sim
