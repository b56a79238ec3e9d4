#pragma once
#include <numbers>

namespace tumble {

inline constexpr double kPi = std::numbers::pi;
inline constexpr double kGravity = 9.81;           // g [m/s2], the value of the 1992 paper's critical speed
inline constexpr double kSettledAreaShare = 0.82;  // area of discs / area of a settled plane charge, voids included

inline constexpr double rpm_from_rad_s(double rad_s) { return rad_s * 30.0 / kPi; }
inline constexpr double rad_s_from_rpm(double rpm) { return rpm * kPi / 30.0; }

}  // namespace tumble
