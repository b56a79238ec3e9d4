#include <gtest/gtest.h>

#include <bit>
#include <numeric>

#include "sim/simulator.h"
#include "tests/support/effects.h"
#include "tests/support/mills.h"

namespace tumble::sim {
namespace {

double energy(const Observables& o) { return o.kinetic + o.potential + o.elastic; }
double lost(const Observables& o) { return std::accumulate(o.dissipation.begin(), o.dissipation.end(), 0.0); }

Config open_mill() {
  Config config = paper_mill();
  config.mill.lifters.count = 12;  // these hold no balls in their pockets
  return config;
}

std::vector<Observables> run(const Config& config) {
  std::vector<Observables> seen;
  RunSink sink;
  sink.frame = [&](const Frame& f) { seen.push_back(f.observed); };
  simulate(config, sink);
  return seen;
}

// Share of the drive's work that the accounts cannot find.
double leak(const std::vector<Observables>& seen) {
  const Observables &first = seen.front(), &last = seen.back();
  const double work = last.drive_work - first.drive_work;
  return (work - (energy(last) - energy(first)) - (lost(last) - lost(first))) / work;
}

// All effects at their typical size: every joule is accounted for, and torque and the moments of fluid and pool carry
// the weight.
TEST(Effects, AllTogetherKeepTheBalances) {
  Config config = open_mill();
  config.effects = every_effect();
  config.run.spin_up = 3;
  config.run.revolutions = 4;
  const auto seen = run(config);
  EXPECT_LT(std::abs(leak(seen)), 2e-3);
  double torque = 0, external = 0, closure = 0;
  for (const Observables& o : seen) {
    torque += o.torque;
    external += o.torque_external;
    closure += o.torque_closure;
  }
  EXPECT_NEAR((torque + external) / closure, 1, 0.02);
  EXPECT_GT(std::abs(external), 0.002 * torque) << "the fluids play no part";
}

TEST(Effects, AnyOfThemKeepTheEnergy) {
  Random random(20);
  for (int trial = 0; trial < 8; ++trial) {
    Config config = open_mill();
    config.charge.count = 70;
    config.effects = some_effects(random);
    config.run.spin_up = 0.5;
    config.run.revolutions = 1;
    EXPECT_LT(std::abs(leak(run(config))), 2e-3) << names_of(config.effects);
  }
}

// Every number that a run hands out, bit by bit.
std::uint64_t bits_of(const Config& config) {
  std::uint64_t h = 14695981039346656037ull;
  const auto mix = [&](double value) { h = (h ^ std::bit_cast<std::uint64_t>(value)) * 1099511628211ull; };
  RunSink sink;
  sink.setup = [&](const RunSetup& s) {
    mix(s.time_step);
    mix(double(s.dissipation_causes.size()));
  };
  sink.frame = [&](const Frame& f) {
    for (const auto* v : {&f.x, &f.y, &f.vx, &f.vy, &f.angle, &f.spin, &f.observed.dissipation})
      for (const double value : *v) mix(value);
    const Observables& o = f.observed;
    for (const double value : {f.time, f.mill_angle, o.torque, o.torque_shear, o.torque_closure, o.torque_external,
                               o.power, o.kinetic, o.potential, o.elastic, o.drive_work, o.locked_balls})
      mix(value);
  };
  const RunResult result = simulate(config, sink);
  for (const double rate : result.spectrum.ball_wall) mix(rate);
  return h;
}

// Strength 0 is no effect, whatever the other parameters say: not a bit differs. At strength 1 many do.
TEST(Effects, OfNoStrengthLeaveEveryBit) {
  Config plain = open_mill();
  plain.charge.count = 25;
  plain.run.spin_up = 0.05;
  plain.run.revolutions = 0.3;
  const std::uint64_t without = bits_of(plain);
  Config all = plain;
  for (const Effect& effect : all_effects()) {
    Config one = plain;
    all.effects[effect.name] = one.effects[effect.name] = settings_of(effect, 0);
    EXPECT_EQ(bits_of(one), without) << effect.name;
    one.effects[effect.name] = settings_of(effect, 1);
    EXPECT_NE(bits_of(one), without) << effect.name << " does nothing";
  }
  EXPECT_EQ(bits_of(all), without);
}

}  // namespace
}  // namespace tumble::sim
