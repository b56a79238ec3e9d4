#pragma once
#include <cmath>

#include "core/units.h"

// Angles as docs/conventions.md has them: counter-clockwise from 3 o'clock, as the camera sees the mill.
namespace tumble {

inline constexpr double degrees(double rad) { return rad * 180.0 / kPi; }
inline constexpr double radians(double deg) { return deg * kPi / 180.0; }

// The same direction in [0, 360).
inline double wrap_360(double deg) {
  const double r = std::fmod(deg, 360.0);
  return r < 0 ? (r + 360.0 == 360.0 ? 0.0 : r + 360.0) : r;
}

// The same turn in [-180, 180): for differences of directions.
inline double wrap_180(double deg) { return wrap_360(deg + 180.0) - 180.0; }

}  // namespace tumble
