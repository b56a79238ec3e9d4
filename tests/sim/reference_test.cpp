#include "sim/reference.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <numeric>

#include "sim/ball_order.h"
#include "sim/packing.h"
#include "sim/running_mill.h"
#include "tests/support/effects.h"
#include "tests/support/mills.h"
#include "tests/support/shells.h"

namespace tumble::sim {
namespace {

std::uint64_t hash_of(const Charge& c, const Ledger& l) {
  std::uint64_t h = 14695981039346656037ull;  // FNV-1a over the bits
  const auto mix = [&](double value) { h = (h ^ std::bit_cast<std::uint64_t>(value)) * 1099511628211ull; };
  for (const auto* v : {&c.x, &c.y, &c.angle, &c.vx, &c.vy, &c.spin, &c.ax, &c.ay, &c.alpha, &c.end_x, &c.end_y})
    for (const double value : *v) mix(value);
  for (const double d : l.dissipated) mix(d);
  const Impacts& n = l.impacts;
  for (const Spectrum* spectrum : {&n.ball_ball, &n.ball_wall})
    for (const auto* bins : {&spectrum->total, &spectrum->normal, &spectrum->tangential})
      for (const double d : *bins) mix(d);
  for (const auto* bins : {&n.wall_number, &n.wall_energy})
    for (const double d : *bins) mix(d);
  for (const double d : n.falls) mix(d);
  for (const double d : {l.drive_work, l.torque, l.torque_shear, l.torque_external, l.mass_moment}) mix(d);
  return h;
}

// What the fast way does otherwise than the plain one and may not change a bit: near pairs and their tiers, cells,
// lifters looked up by angle; lanes of each kind; work cut into patches and shared by threads; balls that are stored in
// another order.
struct Way {
  const Kernels* kernels;
  int threads, balls_per_patch, searches_per_sort;
};
std::vector<Way> ways() {
  std::vector<Way> all;
  for (const Kernels* kernels : all_kernels()) all.push_back({kernels, 1, kBallsPerPatch, 0});
  all.push_back({&best_kernels(), 3, 8, 0});
  all.push_back({&best_kernels(), 2, 8, 1});
  return all;
}

void expect_same_bits(const Config& config, int steps) {
  const MillModel model = make_mill_model(config);
  const Charge start = place_loosely(config, model, draw_balls(config));
  ReferenceMill plain = make_reference_mill(model, start);
  for (int k = 0; k < steps; ++k) advance(plain);
  EXPECT_GT(plain.ledger.dissipated[1], 0) << "nothing has slid";
  EXPECT_GT(plain.ledger.dissipated[2], 0) << "nothing has touched the wall";
  for (const Way& way : ways()) {
    RunningMill fast = start_mill(model, start, way.threads, way.balls_per_patch);
    fast.kernels = way.kernels;
    fast.searches_per_sort = way.searches_per_sort;
    for (int k = 0; k < steps; ++k) advance(fast);
    sort_by_number(fast);
    EXPECT_EQ(hash_of(fast.charge, fast.ledger), hash_of(plain.charge, plain.ledger))
        << name_of(config.mill.lifters.profile) << ", effects " << names_of(config.effects) << "; " << way.kernels->name
        << ", " << way.threads << " threads, " << way.balls_per_patch
        << " balls a patch, sorted with every search number " << way.searches_per_sort;
  }
}

TEST(Reference, GivesTheSameBits) {
  for (const LifterProfile profile : {LifterProfile::kRectangle, LifterProfile::kTriangle, LifterProfile::kNone}) {
    Config config = paper_mill();
    config.charge.count = 60;
    config.mill.lifters.profile = profile;
    config.contact.friction = 0.3;
    expect_same_bits(config, 5000);
  }
}

// Lifters of which the balls see several runs, long ones, or different ones.
TEST(Reference, GivesTheSameBitsOnEveryShell) {
  for (NamedMill mill : mills_of_every_profile()) {
    SCOPED_TRACE(mill.name);
    mill.config.charge.count = 25;
    mill.config.contact.friction = 0.3;
    expect_same_bits(mill.config, 1500);
  }
}

TEST(Reference, GivesTheSameBitsWithEffects) {
  Random random(7);
  for (int trial = 0; trial < 6; ++trial) {
    Config config = paper_mill();
    config.charge.count = 40;
    config.effects = trial == 0 ? every_effect() : some_effects(random);
    expect_same_bits(config, 2000);
  }
}

// Of many patches most are drifted, worked out and kicked while others still wait.
TEST(Patches, GiveTheSameBits) {
  Config config = paper_mill();
  config.mill.diameter = 2.5;
  config.charge.count = 3000;
  const MillModel model = make_mill_model(config);
  const Charge start = place_loosely(config, model, draw_balls(config));
  const auto run = [&](int threads, int balls_per_patch, int searches_per_sort) {
    RunningMill mill = start_mill(model, start, threads, balls_per_patch);
    mill.searches_per_sort = searches_per_sort;
    mill.ledger.counting_impacts = true;
    for (int k = 0; k < 3000; ++k) advance(mill);
    EXPECT_GT(std::accumulate(mill.ledger.impacts.falls.begin(), mill.ledger.impacts.falls.end(), 0.0), 100);
    if (balls_per_patch < 3000) {
      const auto apart =
          std::count_if(mill.patches.begin(), mill.patches.end(), [](const Patch& p) { return p.apart; });
      EXPECT_GT(apart, static_cast<long>(mill.patches.size()) / 2);
      EXPECT_EQ(apart<static_cast<long>(mill.patches.size()), threads> 1) << "where threads meet";
    }
    sort_by_number(mill);
    return hash_of(mill.charge, mill.ledger);
  };
  const std::uint64_t whole = run(1, 3000, 0);
  EXPECT_EQ(run(1, 96, 4), whole);
  EXPECT_EQ(run(2, 96, 4), whole);
  EXPECT_EQ(run(3, 200, 40), whole);
}

}  // namespace
}  // namespace tumble::sim
