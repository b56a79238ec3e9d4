#pragma once
#include <vector>

#include "core/statistics.h"

namespace tumble {

// Where a crowd of values has its sharp side: members are at the edge or beyond it (`tail` > 0: above, < 0: below) by
// chance, exponentially; all are blurred alike, on an even ground. Maximum likelihood on a histogram. NaN where fewer
// than 100 values lie in [from, to] or no crowd stands out.
Estimate sharp_edge(const std::vector<double>& values, double from, double to, int tail);

}  // namespace tumble
