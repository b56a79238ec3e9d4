#include <gtest/gtest.h>

#include "sim/packing.h"
#include "tests/support/balls.h"
#include "tests/support/effects.h"
#include "tests/support/mills.h"

namespace tumble::sim {
namespace {

Charge some_charge(const MillModel& model) {
  Config config = paper_mill();
  config.charge.count = 40;
  return place_loosely(config, model, draw_balls(config));
}

// x -> -x and the other sense of rotation give the mirrored motion. Only rounding differs (the lifters' cosines), and
// impacts multiply it: 2,000 steps are early enough.
void expect_mirrored_motion(const MillModel& model) {
  Charge charge = some_charge(model);
  Charge mirrored = charge;
  for (double& x : mirrored.x) x = -x;
  MillModel backwards = model;
  backwards.speed = -model.speed;
  backwards.ripple.phase = -model.ripple.phase;

  RunningMill a = start_mill(model, charge), b = start_mill(backwards, mirrored);
  for (int k = 0; k < 2000; ++k) {
    advance(a);
    advance(b);
  }
  EXPECT_GT(a.ledger.dissipated[2], 0) << "nothing has touched the wall";
  for (std::size_t i = 0; i < a.charge.size(); ++i) {
    EXPECT_NEAR(a.charge.x[i], -b.charge.x[i], 1e-9);
    EXPECT_NEAR(a.charge.y[i], b.charge.y[i], 1e-9);
    EXPECT_NEAR(a.charge.spin[i], -b.charge.spin[i], 1e-5);
  }
  EXPECT_NEAR(a.ledger.torque, -b.ledger.torque, 1e-6 * std::abs(a.ledger.torque));
}

TEST(Symmetry, MirroredMillGivesMirroredMotion) { expect_mirrored_motion(make_mill_model(paper_mill())); }

// Of all effects only the lifters that are named by number break the mirror.
TEST(Symmetry, EveryEffectIsMirrored) {
  Config config = paper_mill();
  config.effects = every_effect();
  config.effects.erase("missing_lifters");
  config.effects["speed_ripple"]["phase_deg"] = {35};
  expect_mirrored_motion(make_mill_model(config));
}

// Without gravity no direction is special: turned by two lifters, the same motion turned.
TEST(Symmetry, TurnedChargeGivesTurnedMotion) {
  MillModel model = make_mill_model(paper_mill());
  model.gravity = 0;
  Charge charge = some_charge(model);
  for (std::size_t i = 0; i < charge.size(); ++i) {
    charge.vx[i] = 2;
    charge.vy[i] = -1;
  }
  const double angle = 4 * kPi / 18, c = std::cos(angle), s = std::sin(angle);
  const auto turn = [&](std::vector<double>& x, std::vector<double>& y) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double u = x[i], v = y[i];
      x[i] = c * u - s * v;
      y[i] = s * u + c * v;
    }
  };
  Charge turned = charge;
  turn(turned.x, turned.y);
  turn(turned.vx, turned.vy);
  RunningMill a = start_mill(model, charge), b = start_mill(model, turned);
  for (int k = 0; k < 2000; ++k) {
    advance(a);
    advance(b);
  }
  turn(a.charge.x, a.charge.y);
  EXPECT_GT(a.ledger.dissipated[2], 0) << "nothing has touched the wall";
  for (std::size_t i = 0; i < a.charge.size(); ++i) {
    EXPECT_NEAR(a.charge.x[i], b.charge.x[i], 1e-9);
    EXPECT_NEAR(a.charge.y[i], b.charge.y[i], 1e-9);
  }
}

}  // namespace
}  // namespace tumble::sim
