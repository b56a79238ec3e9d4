#include "io/run_journal.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <fstream>
#include <iterator>

#include "tests/io/folder.h"

namespace tumble::io {
namespace {

using RunJournalFile = InFolder;

Config mill_with_seed(std::uint64_t seed) {
  Config c;
  c.mill.diameter = 0.5;
  c.run.seed = seed;
  return c;
}

RunOutcome outcome_of(double x) {
  RunOutcome run;
  for (std::size_t i = 0; i < run.motion.size(); ++i) run.motion[i] = {std::sqrt(x + double(i)), 1 / (x + double(i))};
  run.motion[3] = {};  // not to be had
  run.power = {x / 3, x / 7};
  run.slices = x;
  run.energy_error = -x * 1e-9;
  run.locked_balls = 2;
  run.spin_up_revolutions = 0.1 * x;
  run.steady = true;
  return run;
}

bool same(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }
bool same(const Estimate& a, const Estimate& b) { return same(a.value, b.value) && same(a.se, b.se); }
bool same(const RunOutcome& a, const RunOutcome& b) {
  for (std::size_t i = 0; i < a.motion.size(); ++i)
    if (!same(a.motion[i], b.motion[i])) return false;
  return a.error == b.error && same(a.power, b.power) && same(a.slices, b.slices) &&
         same(a.energy_error, b.energy_error) && same(a.locked_balls, b.locked_balls) &&
         same(a.spin_up_revolutions, b.spin_up_revolutions) && a.steady == b.steady;
}

TEST_F(RunJournalFile, GivesOutcomesBackToTheBit) {
  const auto path = folder_ / "runs";
  RunOutcome failed;
  failed.error = "left physics: \"overlap\"\nat step 7";
  {
    RunJournal journal(path, false);
    journal.add(mill_with_seed(1), outcome_of(1.7));
    journal.add(mill_with_seed(2), failed);
  }
  const RunJournal journal(path, true);
  RunOutcome found;
  ASSERT_TRUE(journal.find(mill_with_seed(1), found));
  EXPECT_TRUE(same(found, outcome_of(1.7)));
  ASSERT_TRUE(journal.find(mill_with_seed(2), found));
  EXPECT_EQ(found.error, failed.error);
  EXPECT_FALSE(journal.find(mill_with_seed(3), found));
}

// However many bytes a kill or a full disk left of it, what was whole is kept and writing goes on behind it.
TEST_F(RunJournalFile, SurvivesBeingCutAtAnyByte) {
  const auto path = folder_ / "runs";
  {
    RunJournal journal(path, false);
    journal.add(mill_with_seed(1), outcome_of(1));
    journal.add(mill_with_seed(2), outcome_of(2));
  }
  std::ifstream file(path, std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(file)), {});
  for (std::size_t length = 0; length <= whole.size(); length += length < 100 || length + 20 > whole.size() ? 1 : 97) {
    std::ofstream(path, std::ios::binary) << whole.substr(0, length);
    const auto lines =
        static_cast<std::size_t>(std::count(whole.begin(), whole.begin() + static_cast<long>(length), '\n'));
    {
      RunJournal journal(path, true);
      EXPECT_EQ(journal.size(), lines > 0 ? lines - 1 : 0);
      journal.add(mill_with_seed(3), outcome_of(3));
    }
    RunOutcome found;
    ASSERT_TRUE(RunJournal(path, true).find(mill_with_seed(3), found));
    EXPECT_TRUE(same(found, outcome_of(3)));
  }
}

// Another process appends while it is read: at every moment what is whole comes over, once, and to the bit.
TEST_F(RunJournalFile, TakesWhatAnotherHoldsAsItGrows) {
  const auto theirs = folder_ / "theirs", seen = folder_ / "seen";
  {
    RunJournal journal(theirs, false);
    for (int seed = 1; seed <= 3; ++seed) journal.add(mill_with_seed(std::uint64_t(seed)), outcome_of(seed));
  }
  std::ifstream file(theirs, std::ios::binary);
  const std::string whole((std::istreambuf_iterator<char>(file)), {});
  RunJournal ours(folder_ / "ours", false);
  ours.add(mill_with_seed(2), outcome_of(7));  // is known already and stays
  std::uintmax_t read = 0;
  ours.take(seen, read);  // not there yet
  for (std::size_t length = 0; length < whole.size(); length += 31) {
    std::ofstream(seen, std::ios::binary) << whole.substr(0, length);
    ours.take(seen, read);
    EXPECT_LE(read, length);
  }
  std::ofstream(seen, std::ios::binary) << whole;
  ours.take(seen, read);
  EXPECT_EQ(read, whole.size());
  std::ofstream(seen, std::ios::binary) << "{\"journal_of_runs\":1,\"tumble\":\"another\"}\n" << whole;
  ours.take(seen, read = 0);
  EXPECT_EQ(read, 0u);

  const RunJournal kept(folder_ / "ours", true);
  EXPECT_EQ(kept.size(), 3u);
  for (const auto& [seed, x] : {std::pair{1, 1}, {2, 7}, {3, 3}}) {
    RunOutcome found;
    ASSERT_TRUE(kept.find(mill_with_seed(std::uint64_t(seed)), found));
    EXPECT_TRUE(same(found, outcome_of(x)));
  }
}

}  // namespace
}  // namespace tumble::io
