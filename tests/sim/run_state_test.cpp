#include "sim/run_state.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "core/error.h"
#include "sim/packing.h"
#include "tests/support/checkpoints.h"
#include "tests/support/mills.h"

namespace tumble::sim {
namespace {

RunState started(int balls = 5) {
  Config config = paper_mill();
  config.charge.count = balls;
  const MillModel model = make_mill_model(config);
  RunState run;
  run.mill = start_mill(model, place_loosely(config, model, draw_balls(config)));
  run.history.torque = run.history.closure = run.history.locked = {1, 2, 3};
  return run;
}

// Some words are whole numbers in disguise, and not a number as they stand.
std::vector<std::uint64_t> bits_of(const RunState& run) {
  std::vector<std::uint64_t> bits;
  for (const double word : keep(checkpoint_of(run)).words) bits.push_back(std::bit_cast<std::uint64_t>(word));
  return bits;
}

TEST(RunState, ComesBackAsItWas) {
  RunState run = started();
  for (int k = 0; k < 3000; ++k) advance(run.mill);
  RunState back = started();
  restore(back, stored(keep(checkpoint_of(run))));
  for (int k = 0; k < 1000; ++k) {
    advance(run.mill);
    advance(back.mill);
  }
  EXPECT_EQ(bits_of(back), bits_of(run));
}

// Of many pieces, and with balls that do not lie in the order of their numbers.
TEST(RunState, ComesBackFromPieces) {
  RunState run = started(112);
  run.mill.searches_per_sort = 1;
  run.history.torque = run.history.closure = run.history.locked = std::vector<double>(5000, 1.0);
  for (int k = 0; k < 3000; ++k) advance(run.mill);
  ASSERT_FALSE(std::is_sorted(run.mill.charge.id.begin(), run.mill.charge.id.end()));

  const Checkpoint checkpoint = checkpoint_of(run);
  std::size_t pieces = 0, words = 0;
  checkpoint.tell([&](std::span<const double> piece) {
    ++pieces;
    words += piece.size();
  });
  EXPECT_EQ(words, checkpoint.size);
  EXPECT_LE(checkpoint.size, most_words(112, 5000, 18));
  EXPECT_GT(pieces, 2u);
  RunState back = started(112);
  restore(back, stored(keep(checkpoint)));
  for (int k = 0; k < 1000; ++k) {
    advance(run.mill);
    advance(back.mill);
  }
  const std::vector<std::uint64_t> ours = bits_of(run), theirs = bits_of(back);
  // The columns come first; the contacts behind them have no order.
  EXPECT_TRUE(std::equal(ours.begin(), ours.begin() + 12 * 113, theirs.begin()));
}

// A checkpoint is a file's content: whatever contradicts itself is refused before anything is reached through it.
TEST(RunState, RefusesWordsThatContradictThemselves) {
  const auto refused = [](auto&& damage) {
    RunState run = started();
    damage(run);
    RunState into = started();
    EXPECT_THROW(restore(into, stored(keep(checkpoint_of(run)))), InputError);
  };
  refused([](RunState& r) { r.mill.charge.y.pop_back(); });
  refused([](RunState& r) { r.mill.charge.spin.clear(); });
  refused([](RunState& r) { r.history.closure.pop_back(); });
  refused([](RunState& r) { r.sampled_before = 4; });
  refused([](RunState& r) { r.locked.home = {0.0}; });

  KeptCheckpoint kept = keep(checkpoint_of(started()));
  kept.words.pop_back();
  RunState into = started();
  EXPECT_THROW(restore(into, stored(kept)), InputError);
}

}  // namespace
}  // namespace tumble::sim
