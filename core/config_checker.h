#pragma once
#include <cmath>
#include <cstdio>
#include <string>

#include "core/config.h"
#include "core/error.h"

namespace tumble {

// A number as messages show it.
inline std::string shown(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%.6g", v);
  return text;
}

// The ranges of a config's keys, one line each where they are checked. Throws InputError with the key's place. NaN, not
// given, passes all but `given`.
struct ConfigChecker {
  const Config& config;
  std::string table = "";  // before each key, such as "mill.lifters."

  [[noreturn]] void fail(const std::string& key, const std::string& problem) const {
    throw InputError(place_of(config, table + key), problem);
  }
  void positive(const std::string& key, double v, const char* unit) const {
    if (v <= 0 || std::isinf(v)) fail(key, "is " + shown(v) + ", must be a positive number" + in(unit));
  }
  void not_negative(const std::string& key, double v, const char* unit) const {
    if (v < 0 || std::isinf(v)) fail(key, "is " + shown(v) + ", must be 0 or more" + in(unit));
  }
  void range(const std::string& key, double v, double low, double high, const char* unit) const {
    if (v < low || v > high)
      fail(key, "is " + shown(v) + ", must lie between " + shown(low) + " and " + shown(high) + in(unit));
  }
  void given(const std::string& key, double v, const std::string& what) const {
    if (std::isnan(v)) fail(key, "is missing; give " + what);
  }
  static std::string in(const char* unit) { return *unit ? std::string(" ") + unit : ""; }
};

}  // namespace tumble
