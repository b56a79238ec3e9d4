#include <gtest/gtest.h>

#include "sim/packing.h"
#include "tests/support/balls.h"
#include "tests/support/mills.h"

namespace tumble::sim {
namespace {

double farthest_move(const Charge& a, const Charge& b) {
  double farthest = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    farthest = std::max(farthest, std::hypot(a.x[i] - b.x[i], a.y[i] - b.y[i]));
  return farthest;
}

// A pyramid of three balls held by friction alone, on the flat: 1e5 steps later nothing has crept, and its motion has
// died away.
TEST(Rest, APyramidStands) {
  const MillModel model = resting(smooth_mill(kFlat, {}, 0.5), 2e-5);
  Ball left = on_floor(model), right = left, top = left;
  left.x = -0.012;
  right.x = 0.012;
  top.y += 0.024 * std::sqrt(0.75);
  RunningMill mill = start_mill(model, charge_of({left, right, top}));
  advance_by(mill, 0.5);
  const Charge settled = mill.charge;
  for (int k = 0; k < 100'000; ++k) advance(mill);
  EXPECT_LT(energies_of(mill).kinetic, 1e-16);
  EXPECT_LT(farthest_move(settled, mill.charge), 1e-8);
  EXPECT_GT(mill.charge.y[2] - mill.charge.y[0], 0.02) << "it has fallen apart";
}

// The paper's charge as a heap in the resting mill. It settles for 2 s; then over 1e5 steps it neither moves by more
// than 1/1000 of a radius nor keeps any of its motion.
TEST(Rest, AHeapStaysAHeap) {
  Config config = paper_mill();
  config.contact.friction = 0.5;
  config.charge.count = 40;
  MillModel model = make_mill_model(config);
  model.speed = 0;
  RunningMill mill = start_mill(model, settle(model, place_loosely(config, model, draw_balls(config)), {}));
  advance_by(mill, 2);
  const Charge settled = mill.charge;
  const double before = energies_of(mill).kinetic;
  for (int k = 0; k < 100'000; ++k) advance(mill);
  EXPECT_LT(farthest_move(settled, mill.charge), 1.2e-5);
  EXPECT_LT(energies_of(mill).kinetic, std::max(1e-12, 1e-2 * before));
}

}  // namespace
}  // namespace tumble::sim
