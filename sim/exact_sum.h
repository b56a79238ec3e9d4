#pragma once
#include <cmath>

// Sums that come out the same in whatever order: by whatever threads, lanes and lists the terms are found.
//
// Every term is rounded to a multiple of one step, so small that nobody feels it and so large that all sums stay below
// 2^51 steps; there an addition of doubles has nothing to round. Beyond that a sum is as precise as any other, but
// hangs on the order.
namespace tumble::sim {

struct ExactSum {
  double shift = 0;  // 1.5 x 2^52 steps: adding it leaves no room for a fraction of a step

  template <class Real>
  Real operator()(const Real& term) const {
    return (term + shift) - shift;
  }
};

// For sums up to `largest`, > 0.
inline ExactSum exact_up_to(double largest) {
  int exponent = 0;
  std::frexp(largest, &exponent);
  return {std::ldexp(1.5, exponent + 1)};
}

}  // namespace tumble::sim
