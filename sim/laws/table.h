#pragma once
#include <algorithm>
#include <vector>

#include "core/effects.h"
#include "sim/laws/real.h"

// A law given by points (x, y): linear between them, constant outside. Read without a branch on the value: every
// segment that begins below x is taken, the last one stays.
namespace tumble::sim {

struct Table {
  int rows = 0;
  double x[kMostRows] = {}, y[kMostRows] = {}, slope[kMostRows] = {};

  bool on() const { return rows > 0; }
  template <class Real>
  Real at(const Real& value) const {
    Real found = y[0];
    for (int k = 0; k < rows; ++k) found = select(value > Real(x[k]), y[k] + slope[k] * (value - x[k]), found);
    return found;
  }
  double least() const { return *std::min_element(y, y + rows); }
  double most() const { return *std::max_element(y, y + rows); }
};

// Of an effect's column, times `factor`; off where the column is not given.
inline Table make_table(const Config& config, const char* effect, const char* column, double factor = 1) {
  Table t;
  const std::vector<double> x = effect_column(config, effect, "speed"), y = effect_column(config, effect, column);
  t.rows = static_cast<int>(y.size());
  for (std::size_t k = 0; k < y.size(); ++k) {
    t.x[k] = x[k];
    t.y[k] = factor * y[k];
    if (k > 0) t.slope[k - 1] = (t.y[k] - t.y[k - 1]) / (t.x[k] - t.x[k - 1]);
  }
  return t;
}

}  // namespace tumble::sim
