#include "core/spool.h"

#include <gtest/gtest.h>

#include <numeric>

namespace tumble {
namespace {

// Twelve million bytes: more than stays in memory.
TEST(Spool, GivesBackEveryRowInOrderBeyondWhatStaysInMemory) {
  constexpr std::size_t kRows = 1'500'000;
  Spool<double> spool;
  std::vector<double> rows(1000);
  for (std::size_t first = 0; first < kRows; first += rows.size()) {
    std::iota(rows.begin(), rows.end(), static_cast<double>(first));
    spool.append(rows);
  }
  spool.change([](double& v) { v = -v; });
  ASSERT_EQ(spool.size(), kRows);
  std::size_t next = 0;
  for (const double v : spool) ASSERT_EQ(v, -static_cast<double>(next++));
  EXPECT_EQ(next, kRows);
  EXPECT_EQ(spool[kRows - 1], -static_cast<double>(kRows - 1));
  const Spool<double> copy = spool;
  EXPECT_EQ(copy[12345], -12345.0);
}

TEST(FrameSpool, KeepsFramesApart) {
  FrameSpool<int> frames;
  frames.append(std::vector{1, 2});
  frames.append(std::vector<int>{});
  frames.append(std::vector{3});
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_EQ(frames[0], (std::vector{1, 2}));
  EXPECT_TRUE(frames[1].empty());
  EXPECT_EQ(frames[2], std::vector{3});
}

}  // namespace
}  // namespace tumble
