#pragma once
#include <vector>

#include "sim/charge.h"

namespace tumble::sim {

// Square cells over the charge, for finding near pairs without comparing all. Keeps its memory between uses.
class CellGrid {
 public:
  // Sorts the balls into cells of at least `cell` [m].
  void fill(const Charge& charge, double cell);

  // Balls j > i with |x_j - x_i| < r_i + r_j + skin, ascending, into `out` (cleared first).
  // The cell must have been at least 2 r_max + skin. All of them are found only where no ball has moved since fill().
  void partners_of(const Charge& charge, int i, double skin, std::vector<int>& out) const;

 private:
  int column(double x) const;
  int row(double y) const;

  double left_ = 0, bottom_ = 0, per_metre_ = 1;
  int columns_ = 0, rows_ = 0;
  std::vector<int> start_;  // of each cell in balls_
  std::vector<int> balls_;  // by cell, ascending within
};

}  // namespace tumble::sim
