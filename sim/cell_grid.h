#pragma once
#include <algorithm>
#include <cstddef>
#include <numeric>
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

  // Balls in the order of their cells, and where they were.
  const std::vector<int>& balls() const { return balls_; }
  // The balls are numbered in this order now.
  void number_afresh() { std::iota(balls_.begin(), balls_.end(), 0); }
  const double* x() const { return x_.data(); }
  const double* y() const { return y_.data(); }
  const double* radius() const { return radius_.data(); }

  // Ranges [first, last) of that order, which together hold every ball that is within `reach` of the ball at `place`,
  // and others: visit(first, last, later), `later` for those behind `place`. Those before it only if `all`.
  template <class Visit>
  void for_ranges(int place, double reach, bool all, const Visit& visit) const {
    const double x = x_[static_cast<std::size_t>(place)], y = y_[static_cast<std::size_t>(place)];
    const int left = std::max(0, column(x - reach)), right = std::min(columns_ - 1, column(x + reach));
    const int own = row(y), top = std::min(rows_ - 1, row(y + reach));
    const auto start = [&](int r, int c) { return start_[static_cast<std::size_t>(r * columns_ + c)]; };
    // Neighbouring cells of a row lie side by side.
    visit(place + 1, start(own, right + 1), true);
    for (int r = own + 1; r <= top; ++r) visit(start(r, left), start(r, right + 1), true);
    if (!all) return;
    visit(start(own, left), place, false);
    for (int r = std::max(0, row(y - reach)); r < own; ++r) visit(start(r, left), start(r, right + 1), false);
  }

 private:
  int column(double x) const;
  int row(double y) const;

  double left_ = 0, bottom_ = 0, per_metre_ = 1;
  int columns_ = 0, rows_ = 0;
  std::vector<int> start_;              // of each cell in balls_
  std::vector<int> balls_;              // by cell, ascending within
  std::vector<int> cell_;               // of each ball
  std::vector<double> x_, y_, radius_;  // of balls_, and some room
};

}  // namespace tumble::sim
