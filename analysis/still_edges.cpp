#include "analysis/still_edges.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/angle.h"
#include "core/quantile.h"
#include "core/random.h"

namespace tumble::analysis {
namespace {

constexpr int kReplicates = 200;     // 5 % error of the standard error itself
constexpr double kSomeCharge = 0.1;  // of the plateau: from here on there might be more, or less
constexpr int kLeastPatches = 5;     // of charge, to tell how uneven it is
constexpr std::size_t kBins = 360;

// As many as lie within a standard deviation; a bed that falls apart in one replicate of ten must not have all the say.
double within_which_most_lie(std::vector<double>& misses) {
  std::erase_if(misses, [](double m) { return std::isnan(m); });
  if (misses.size() < kReplicates / 2) return kNotGiven;
  return quantile_of(misses, 0.683);
}

}  // namespace

EdgeEstimates edges_of_still(const RingProfile& profile, int width, double ball) {
  EdgeEstimates result;
  result.occupancy = profile;
  const RingProfile smoothed = smooth(profile, width);
  const ChargeEdges edges = find_edges(smoothed);
  for (std::size_t l = 0; l < kEdgeShare.size(); ++l) {
    result.toe[l].value = edges.toe[l];
    result.shoulder[l].value = edges.shoulder[l];
  }
  // Patches of one ball: how far each lies from their mean, where the charge is whole.
  const auto patch = static_cast<std::size_t>(std::clamp(std::lround(ball), 1L, 60L));
  std::vector<double> deviations;
  for (std::size_t first = 0; first + patch <= kBins; first += patch) {
    double sum = 0;
    bool whole = true;
    for (std::size_t i = first; i < first + patch; ++i) {
      sum += profile[i];
      whole = whole && smoothed[i] > kEdgeShare[kHalf] * edges.plateau;  // not so where hidden
    }
    if (whole) deviations.push_back(sum / static_cast<double>(patch));
  }
  if (static_cast<int>(deviations.size()) < kLeastPatches) return result;
  const double mean =
      std::accumulate(deviations.begin(), deviations.end(), 0.0) / static_cast<double>(deviations.size());
  for (double& d : deviations) d -= mean;

  Random random(1);
  std::array<std::vector<double>, 3> toe, shoulder;  // how far replicates lie off
  for (int k = 0; k < kReplicates; ++k) {
    RingProfile other = profile;
    const std::size_t phase = random.below(patch);
    double deviation = 0;
    for (std::size_t i = 0; i < kBins; ++i) {
      if ((i + phase) % patch == 0 || i == 0) deviation = deviations[random.below(deviations.size())];
      if (smoothed[i] > kSomeCharge * edges.plateau) other[i] = std::max(0.0, other[i] + deviation);
    }
    const ChargeEdges e = find_edges(smooth(other, width));
    for (std::size_t l = 0; l < kEdgeShare.size(); ++l) {
      toe[l].push_back(std::abs(wrap_180(e.toe[l] - edges.toe[l])));
      shoulder[l].push_back(std::abs(wrap_180(e.shoulder[l] - edges.shoulder[l])));
    }
  }
  for (std::size_t l = 0; l < kEdgeShare.size(); ++l) {
    result.toe[l].se = within_which_most_lie(toe[l]);
    result.shoulder[l].se = within_which_most_lie(shoulder[l]);
  }
  return result;
}

}  // namespace tumble::analysis
