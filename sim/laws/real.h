#pragma once
#include <bit>
#include <cmath>
#include <cstdint>

// The laws are written once, for one contact and for several side by side: `Real` is a double or a batch of doubles
// (sim/kernels/lanes.h). They have no branch that depends on a value, and every operation is rounded in the same way in
// both, so a contact feels the same force, to the last bit, whichever way it is worked out.
namespace tumble::sim {

inline double select(bool condition, double yes, double no) { return condition ? yes : no; }

// Whole numbers as they stand in the last bits of a double.
inline constexpr double kWholeNumbers = 6755399441055744;  // 1.5 x 2^52

// 2^n of a whole number n.
template <class Real>
struct PowerOfTwo {
  static Real of(const Real& n) {
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(n + (kWholeNumbers + 1023)) << 52);
  }
};

// exp(-u) for u >= 0, to 3e-16 of it: 2^-n exp(-r), with the Taylor series for |r| <= ln 2 / 2, its even and odd terms
// apart.
template <class Real>
Real decay(const Real& u) {
  constexpr double kLn2High = 6.93147180369123816490e-01, kLn2Low = 1.90821492927058770002e-10;
  const Real within = select(u < Real(700), u, Real(700));
  const Real n = (within * 1.4426950408889634 + kWholeNumbers) - kWholeNumbers;
  const Real r = (within - n * kLn2High) - n * kLn2Low, r2 = r * r;
  Real even = 1.0 / 479001600, odd = 1.0 / 6227020800;  // 12!, 13!
  for (const double c : {1.0 / 3628800, 1.0 / 40320, 1.0 / 720, 1.0 / 24, 1.0 / 2, 1.0}) even = even * r2 + c;
  for (const double c : {1.0 / 39916800, 1.0 / 362880, 1.0 / 5040, 1.0 / 120, 1.0 / 6, 1.0}) odd = odd * r2 + c;
  return (even - odd * r) * PowerOfTwo<Real>::of(-n);
}

}  // namespace tumble::sim
