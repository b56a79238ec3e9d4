#include "sim/run_state.h"

#include <gtest/gtest.h>

#include <bit>

#include "core/error.h"
#include "sim/packing.h"
#include "tests/support/mills.h"

namespace tumble::sim {
namespace {

RunState started() {
  Config config = paper_mill();
  config.charge.count = 5;
  const MillModel model = make_mill_model(config);
  RunState run;
  run.mill = start_mill(model, place_loosely(config, model, draw_balls(config)));
  run.history.torque = run.history.closure = run.history.locked = {1, 2, 3};
  return run;
}

// Some words are whole numbers in disguise, and not a number as they stand.
std::vector<std::uint64_t> bits_of(const RunState& run) {
  std::vector<std::uint64_t> bits;
  for (const double word : words_of(run)) bits.push_back(std::bit_cast<std::uint64_t>(word));
  return bits;
}

TEST(RunState, ComesBackAsItWas) {
  RunState run = started();
  for (int k = 0; k < 3000; ++k) advance(run.mill);
  RunState back = started();
  restore(back, words_of(run));
  for (int k = 0; k < 1000; ++k) {
    advance(run.mill);
    advance(back.mill);
  }
  EXPECT_EQ(bits_of(back), bits_of(run));
}

// A checkpoint is a file's content: whatever contradicts itself is refused before anything is reached through it.
TEST(RunState, RefusesWordsThatContradictThemselves) {
  const auto refused = [](auto&& damage) {
    RunState run = started();
    damage(run);
    RunState into = started();
    EXPECT_THROW(restore(into, words_of(run)), InputError);
  };
  refused([](RunState& r) { r.mill.charge.y.pop_back(); });
  refused([](RunState& r) { r.mill.charge.spin.clear(); });
  refused([](RunState& r) { r.history.closure.pop_back(); });
  refused([](RunState& r) { r.sampled_before = 4; });
  refused([](RunState& r) { r.locked.home = {0.0}; });

  std::vector<double> words = words_of(started());
  words.pop_back();
  RunState into = started();
  EXPECT_THROW(restore(into, words), InputError);
}

}  // namespace
}  // namespace tumble::sim
