#pragma once
#include <string>
#include <vector>

#include "core/sweep.h"

namespace tumble::cli {

// "mill.speed=0.6:1.0:0.05" (from, to and step; the end belongs to it) or "mill.lifters.profile=rectangle,triangle".
// `notes` takes what a user should know of how it was read. Throws InputError.
VariedKey parse_vary(const std::string& text, std::vector<std::string>& notes);

// Splits "KEY=A:B" of --fit. Throws InputError.
struct FitRange {
  std::string key;
  double low = 0, high = 0;
};
FitRange parse_fit(const std::string& text);

}  // namespace tumble::cli
