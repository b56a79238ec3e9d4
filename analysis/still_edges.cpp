#include "analysis/still_edges.h"

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/random.h"

namespace tumble::analysis {
namespace {

constexpr int kReplicates = 200;     // 5 % error of the standard error itself
constexpr double kSomeCharge = 0.1;  // of the plateau: from here on there might be more, or less
constexpr int kLeastPatches = 5;     // of charge, to tell how uneven it is
constexpr std::size_t kBins = 360;

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
  // Patches of one ball: how far each lies from what is about it, where the charge is whole.
  const auto patch = static_cast<std::size_t>(std::clamp(std::lround(ball), 1L, 60L));
  std::vector<double> deviations;
  for (std::size_t first = 0; first + patch <= kBins; first += patch) {
    double sum = 0;
    bool whole = true;
    for (std::size_t i = first; i < first + patch; ++i) {
      sum += profile[i] - smoothed[i];
      whole = whole && smoothed[i] > kEdgeShare[kBulk] * edges.plateau;  // not so where hidden
    }
    if (whole) deviations.push_back(sum / static_cast<double>(patch));
  }
  if (static_cast<int>(deviations.size()) < kLeastPatches) return result;

  Random random(1);
  std::array<double, 3> toe{}, shoulder{};
  std::array<int, 3> toes{}, shoulders{};
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
      const double t = wrap_180(e.toe[l] - edges.toe[l]), s = wrap_180(e.shoulder[l] - edges.shoulder[l]);
      if (!std::isnan(t)) toe[l] += t * t, ++toes[l];
      if (!std::isnan(s)) shoulder[l] += s * s, ++shoulders[l];
    }
  }
  for (std::size_t l = 0; l < kEdgeShare.size(); ++l) {
    if (toes[l] > kReplicates / 2) result.toe[l].se = std::sqrt(toe[l] / toes[l]);
    if (shoulders[l] > kReplicates / 2) result.shoulder[l].se = std::sqrt(shoulder[l] / shoulders[l]);
  }
  return result;
}

}  // namespace tumble::analysis
