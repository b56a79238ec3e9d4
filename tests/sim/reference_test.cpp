#include "sim/reference.h"

#include <gtest/gtest.h>

#include <bit>

#include "sim/packing.h"
#include "sim/running_mill.h"
#include "tests/support/effects.h"
#include "tests/support/mills.h"

namespace tumble::sim {
namespace {

std::uint64_t hash_of(const Charge& c, const Ledger& l) {
  std::uint64_t h = 14695981039346656037ull;  // FNV-1a over the bits
  const auto mix = [&](double value) { h = (h ^ std::bit_cast<std::uint64_t>(value)) * 1099511628211ull; };
  for (const auto* v : {&c.x, &c.y, &c.angle, &c.vx, &c.vy, &c.spin, &c.ax, &c.ay, &c.alpha, &c.end_x, &c.end_y})
    for (const double value : *v) mix(value);
  for (const double d : l.dissipated) mix(d);
  for (const double d : {l.drive_work, l.torque, l.torque_shear, l.torque_external, l.mass_moment}) mix(d);
  return h;
}

// Near lists, cells, memory carried over, lifters looked up by angle: none of it may change a bit of what all pairs
// give.
TEST(Reference, GivesTheSameBits) {
  for (const LifterProfile profile : {LifterProfile::kRectangle, LifterProfile::kTriangle, LifterProfile::kNone}) {
    Config config = paper_mill();
    config.charge.count = 60;
    config.mill.lifters.profile = profile;
    config.contact.friction = 0.3;
    const MillModel model = make_mill_model(config);
    const Charge start = place_loosely(config, model, draw_balls(config));
    RunningMill fast = start_mill(model, start);
    ReferenceMill plain = make_reference_mill(model, start);
    for (int k = 0; k < 6000; ++k) {
      advance(fast);
      advance(plain);
    }
    EXPECT_GT(fast.ledger.dissipated[1], 0) << "nothing has slid";
    EXPECT_GT(fast.ledger.dissipated[2], 0) << "nothing has touched the wall";
    EXPECT_EQ(hash_of(fast.charge, fast.ledger), hash_of(plain.charge, plain.ledger)) << name_of(profile);
  }
}

// Nor with effects, any of them together.
TEST(Reference, GivesTheSameBitsWithEffects) {
  Random random(7);
  for (int trial = 0; trial < 6; ++trial) {
    Config config = paper_mill();
    config.charge.count = 40;
    config.effects = trial == 0 ? every_effect() : some_effects(random);
    const MillModel model = make_mill_model(config);
    const Charge start = place_loosely(config, model, draw_balls(config));
    RunningMill fast = start_mill(model, start);
    ReferenceMill plain = make_reference_mill(model, start);
    for (int k = 0; k < 2000; ++k) {
      advance(fast);
      advance(plain);
    }
    EXPECT_GT(fast.ledger.dissipated[2], 0) << "nothing has touched the wall";
    EXPECT_EQ(hash_of(fast.charge, fast.ledger), hash_of(plain.charge, plain.ledger)) << names_of(config.effects);
  }
}

}  // namespace
}  // namespace tumble::sim
