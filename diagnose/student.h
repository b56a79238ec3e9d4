#pragma once
#include <cmath>

#include "core/config.h"

namespace tumble::diagnose {

// Student's t that 95 % of the estimates with `freedom` degrees stay within; NaN where there are none. Exact for one
// and two, else Fisher's expansion about the normal one (Abramowitz & Stegun 26.7.5): 0.7 % low at three, better above.
inline double student_95(double freedom) {
  if (!(freedom >= 1)) return kNotGiven;
  if (freedom < 2) return 12.7062;
  if (freedom < 3) return 4.30265;
  const double z = 1.959964, z2 = z * z;
  const double first = z * (z2 + 1) / 4, second = z * ((5 * z2 + 16) * z2 + 3) / 96;
  const double third = z * (((3 * z2 + 19) * z2 + 17) * z2 - 15) / 384;
  return z + (first + (second + third / freedom) / freedom) / freedom;
}

}  // namespace tumble::diagnose
