#pragma once
#include <cstddef>
#include <vector>

#include "core/random.h"

namespace tumble::diagnose {

// `n` points in the unit cube of `d` dimensions, one in each of n slices along every axis (McKay et al. 1979), the one
// of several drawings whose nearest two points are farthest apart.
std::vector<std::vector<double>> latin_hypercube(std::size_t n, std::size_t d, Random& random);

}  // namespace tumble::diagnose
