#pragma once
#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace tumble {

// The value that stands this share of the way up where all are put in order (an order statistic: nothing is
// interpolated). NaN of nothing.
template <class Number>
Number quantile_of(std::vector<Number> values, double share) {
  if (values.empty()) return std::numeric_limits<Number>::quiet_NaN();
  const auto size = static_cast<double>(values.size());
  const auto at = values.begin() +
                  std::min(static_cast<std::ptrdiff_t>(share * size), static_cast<std::ptrdiff_t>(values.size()) - 1);
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

template <class Number>
Number median_of(std::vector<Number> values) {
  return quantile_of(std::move(values), 0.5);
}

}  // namespace tumble
