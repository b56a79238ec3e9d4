#include <gtest/gtest.h>

#include "core/angle.h"
#include "tests/support/lifted_ball.h"
#include "tests/support/mills.h"

// Powell, "The effect of liner design on the motion of the outer grinding elements in a rotary mill", Int. J. Miner.
// Process. 31 (1991) 163: a ball that a lifter carries up stays at rest on it until, along the lifter's face, gravity
// beats the centrifugal force and friction. With the ball's centre p, the face's unit vectors s (outwards along it) and
// n (into the ball) in the lifter's frame, g(theta) = g (sin theta, cos theta) against them, and q = s - mu n,
//
//   W^2 p.q = g |q| sin(theta + psi),  psi the angle of q
//
// which for a radial face is his sin(theta - phi_f) g = W^2 (p_x cos phi_f - p_y sin phi_f), tan phi_f = mu.
namespace tumble::sim {
namespace {

MillModel mill_with(LifterProfile profile, double leading_angle_deg, double speed, double friction, double rolling) {
  Config config = paper_mill();
  config.mill.speed = speed;
  config.mill.lifters.count = 6;
  config.mill.lifters.profile = profile;
  if (profile == LifterProfile::kTrapezoid) config.mill.lifters.leading_angle_deg = leading_angle_deg;
  config.contact.friction = friction;
  config.effects["rolling_resistance"] = {{"coefficient", {rolling}}};
  MillModel model = make_mill_model(config);
  model.time_step = 2e-5;
  return model;
}

double closed_form_deg(const MillModel& m, const Ball& ball, double mu) {
  const WallPoint face = nearest_lifter(m.shell, ball.x, ball.y);
  const double nx = -face.nx, ny = -face.ny, qx = ny - mu * nx, qy = -nx - mu * ny;
  const double pull = m.speed * m.speed * (ball.x * qx + ball.y * qy) / (m.gravity * std::hypot(qx, qy));
  return degrees(std::asin(pull) - std::atan2(qy, qx));
}

// Mill angle from which on the ball neither touches the shell nor has friction left on the lifter, until it is 1 mm on
// its way inwards.
double simulated_deg(const MillModel& m, const Ball& ball, double mu) {
  RunningMill mill = start_mill(m, charge_of({ball}));
  double held = NAN;
  while (std::hypot(mill.charge.x[0], mill.charge.y[0]) > std::hypot(ball.x, ball.y) - 1e-3) {
    advance(mill);
    const std::optional<ContactState> lifter = wall_touch(mill, true);
    const double grip = lifter ? m.wall.springs.tangential_stiffness * std::abs(lifter->spring) : 0;
    const double most = lifter ? mu * m.wall.springs.normal_stiffness * lifter->overlap : 0;
    if (wall_touch(mill, false) || grip < 0.98 * most) held = degrees(mill_angle(m, mill.step));
    if (mill.step > 200'000) return NAN;
  }
  return held;
}

// A ball that cannot roll slides off as Powell's does.
TEST(Powell, BallSlidesOffTheLifter) {
  for (const double speed : {0.6, 0.75})
    for (const double mu : {0.1, 0.3}) {
      const MillModel radial = mill_with(LifterProfile::kRectangle, 0, speed, mu, 1);
      const Ball ball = ball_in_the_corner(radial, 0.012, 0.06);
      EXPECT_NEAR(simulated_deg(radial, ball, mu), closed_form_deg(radial, ball, mu), 0.4) << speed << ", mu " << mu;
      const MillModel slanted = mill_with(LifterProfile::kTrapezoid, 10, speed, mu, 1);
      const Ball other = ball_in_the_corner(slanted, 0.012, 0.06);
      EXPECT_NEAR(simulated_deg(slanted, other, mu), closed_form_deg(slanted, other, mu), 0.3)
          << speed << ", mu " << mu;
      EXPECT_GT(closed_form_deg(radial, ball, mu) - closed_form_deg(slanted, other, mu), 5) << "the face counts";
    }
}

// A sphere that may roll has no use for friction once one contact is left: it rolls off where Powell's ball without
// friction slides off, be mu what it may.
TEST(Powell, SphereRollsOffAsIfThereWereNoFriction) {
  for (const double mu : {0.1, 0.5}) {
    const MillModel model = mill_with(LifterProfile::kRectangle, 0, 0.7, mu, 0);
    const Ball ball = ball_in_the_corner(model, 0.012, 0.06);
    EXPECT_NEAR(simulated_deg(model, ball, 0), closed_form_deg(model, ball, 0), 0.4) << "mu " << mu;
  }
}

}  // namespace
}  // namespace tumble::sim
