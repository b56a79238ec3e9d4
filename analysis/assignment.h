#pragma once
#include <utility>
#include <vector>

namespace tumble::analysis {

struct Pairing {  // a row may go with a column at this cost
  int row = 0, column = 0;
  double cost = 0;
};

// One-to-one choice of pairings of least total cost, where leaving a row alone costs `alone`. Solved exactly, piece by
// piece of the graph of pairings (successive shortest paths). Returns (row, column).
std::vector<std::pair<int, int>> assign(const std::vector<Pairing>& pairings, double alone);

}  // namespace tumble::analysis
