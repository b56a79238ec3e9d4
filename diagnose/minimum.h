#pragma once
#include <functional>
#include <vector>

namespace tumble::diagnose {

struct Box {  // of parameters: low[k] < high[k]
  std::vector<double> low, high;
};

// A local minimum of `f` within the box near `start`, without derivatives (Subplex: Rowan 1990, as NLopt has it).
// Deterministic.
std::vector<double> minimum_near(const std::function<double(const std::vector<double>&)>& f, std::vector<double> start,
                                 const Box& box, double tolerance, int most_calls);

}  // namespace tumble::diagnose
