#pragma once
#include <string>
#include <vector>

#include "core/statistics.h"

namespace tumble {

struct Difference {  // one quantity in two sources
  std::string name;  // as in summary.json
  std::string unit;
  Estimate a, b;
  double difference = kNotGiven;  // b - a; directions in [-180, 180)
  double se = kNotGiven;          // of the difference; NaN where one of the two has none
  double z = kNotGiven;           // difference / se
};

struct Deviation {   // what `compare` finds between two charge motions
  std::string a, b;  // their origins
  std::vector<Difference> differences;
};

}  // namespace tumble
