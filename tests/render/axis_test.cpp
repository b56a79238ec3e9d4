#include "render/axis.h"

#include <gtest/gtest.h>

#include <vector>

namespace tumble::render {
namespace {

std::vector<std::string> labels(double low, double high, int count) {
  std::vector<std::string> found;
  for (const Tick& tick : ticks(low, high, count)) found.push_back(tick.label);
  return found;
}

using Labels = std::vector<std::string>;

TEST(Axis, TicksStandAtRoundNumbersWithEvenDecimals) {
  EXPECT_EQ(labels(0, 2.3, 5), (Labels{"0.0", "0.5", "1.0", "1.5", "2.0"}));
  EXPECT_EQ(labels(-80, 80, 4), (Labels{"−50", "0", "50"}));
  EXPECT_EQ(labels(0, 0.3, 3), (Labels{"0.0", "0.1", "0.2", "0.3"}));
  EXPECT_EQ(labels(3.1, 8.9, 5), (Labels{"4", "5", "6", "7", "8"}));
  EXPECT_TRUE(ticks(1, 1, 5).empty());
}

TEST(Axis, RoundNumbersAreNeverAbove) {
  EXPECT_DOUBLE_EQ(round_number_below(0.123), 0.1);
  EXPECT_DOUBLE_EQ(round_number_below(0.5), 0.5);
  EXPECT_DOUBLE_EQ(round_number_below(4.99), 2);
  EXPECT_DOUBLE_EQ(round_number_below(1000), 1000);
}

}  // namespace
}  // namespace tumble::render
