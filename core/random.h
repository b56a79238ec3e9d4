#pragma once
#include <cmath>
#include <cstdint>

#include "core/units.h"

namespace tumble {

// SplitMix64 (Steele, Lea & Flood 2014): the same numbers on every machine and library, which std::
// distributions do not promise. Good enough to shuffle and jitter a charge.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ull);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }  // [0, 1)
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  std::uint64_t below(std::uint64_t n) { return next() % n; }  // [0, n); the bias is below n / 2^64

 private:
  std::uint64_t state_;
};

// Mean 0, variance 1 (Box & Muller 1958).
inline double gaussian(Random& random) {
  return std::sqrt(-2 * std::log(1 - random.uniform())) * std::cos(2 * kPi * random.uniform());
}

}  // namespace tumble
