#pragma once
#include <vector>

#include "core/deviation.h"
#include "core/frame.h"

namespace tumble::diagnose {

// Impacts of two runs by the energy lost in them, ball on ball and ball on wall; `seconds`: what each was averaged
// over. Errors are those of counts, with an allowance for bursts. Nothing where the bins are not the same.
std::vector<SampledDifference> compare_impacts(const ImpactSpectrum& a, double seconds_a, const ImpactSpectrum& b,
                                               double seconds_b);

}  // namespace tumble::diagnose
