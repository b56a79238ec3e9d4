#pragma once
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

namespace tumble::io {

// A number with as many significant digits as mean something, so that text stays short; null where it cannot be had.
inline nlohmann::ordered_json json_number(double value, int digits) {
  if (!std::isfinite(value)) return nullptr;
  return std::strtod(fmt::format("{:.{}g}", value, digits).c_str(), nullptr);  // std::stod throws on the tiniest
}

}  // namespace tumble::io
