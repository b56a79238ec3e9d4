#pragma once
#include <vector>

#include "core/mill_shape.h"

namespace tumble::render {

// Distances to the inside of the shell in its own frame, > 0 where balls may be, over angle (columns, from 0 round) and
// radius (rows, from `begin` to `end`), in shell radii. Nearer to the axis than `begin` all is free up to the tips.
struct OutlineTable {
  int columns = 0, rows = 0;
  double begin = 0, end = 0, tip = 1;
  std::vector<float> distance;
};

OutlineTable make_outline_table(const MillShape& shape);

}  // namespace tumble::render
