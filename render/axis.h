#pragma once
#include <string>
#include <vector>

namespace tumble::render {

// The largest of 1, 2, 5 x 10^k that is not above `value` (> 0).
double round_number_below(double value);

struct Tick {
  double value = 0;
  std::string label;  // all labels of an axis have the same number of decimals
};

// About `count` ticks at multiples of a round step inside [low, high].
std::vector<Tick> ticks(double low, double high, int count);

}  // namespace tumble::render
