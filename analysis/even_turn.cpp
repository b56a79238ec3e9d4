#include "analysis/even_turn.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/quantile.h"

namespace tumble::analysis {
namespace {

constexpr std::size_t kBlock = 10;        // pictures over which a speed is taken
constexpr std::size_t kFewestBlocks = 5;  // to tell
constexpr double kShare = 0.7;            // of the changes from block to block: a camera may change its rate once
constexpr double kUneven = 0.1;           // of the speed: a change that motors and falling charges do not make
constexpr double kNoise = 4;              // times by which a change must exceed what misread angles make of it

// Median of the slopes between all pairs: a single angle that is misread hardly changes it.
double speed_of(std::span<const double> angles) {
  std::vector<double> slopes;
  for (std::size_t i = 0; i < angles.size(); ++i)
    for (std::size_t j = i + 1; j < angles.size(); ++j)
      if (!std::isnan(angles[i]) && !std::isnan(angles[j]))
        slopes.push_back((angles[j] - angles[i]) / static_cast<double>(j - i));
  return slopes.size() < kBlock ? std::nan("") : median_of(std::move(slopes));
}

// As if no picture were repeated or missing: steps that clearly are none, two or more of the usual ones count as one.
std::vector<double> without_gaps(std::span<const double> angles) {
  constexpr double kClearly = 0.15, kMost = 4;  // usual steps
  std::vector<double> steps, even(angles.begin(), angles.end());
  for (std::size_t i = 1; i < angles.size(); ++i)
    if (const double step = angles[i] - angles[i - 1]; !std::isnan(step)) steps.push_back(step);
  if (steps.empty()) return even;
  const double usual = median_of(steps);
  double off = 0;
  for (std::size_t i = 1; i < angles.size(); ++i) {
    const double times = (angles[i] - angles[i - 1]) / usual, whole = std::round(times);
    if (whole >= 0 && whole <= kMost && std::abs(times - whole) < kClearly) off += (whole - 1) * usual;
    even[i] -= off;
  }
  return even;
}

}  // namespace

Evenness evenness_of(std::span<const double> read) {
  const std::vector<double> even_ones = without_gaps(read);
  const std::span<const double> angles = even_ones;
  std::vector<double> speeds, changes, sizes, seconds;
  for (std::size_t from = 0; from + kBlock <= angles.size(); from += kBlock) {
    const double speed = speed_of(angles.subspan(from, kBlock));
    if (!std::isnan(speed)) speeds.push_back(speed);
  }
  if (speeds.size() < kFewestBlocks) return {};
  for (std::size_t i = 1; i < speeds.size(); ++i) changes.push_back(std::abs(speeds[i] - speeds[i - 1]));
  for (std::size_t i = 2; i < angles.size(); ++i)
    if (const double d = angles[i] - 2 * angles[i - 1] + angles[i - 2]; !std::isnan(d)) seconds.push_back(std::abs(d));
  if (seconds.empty()) return {};
  const double sigma = 1.4826 * median_of(std::move(seconds)) / std::sqrt(6.0);
  // Of the difference of two slopes over a block each, of angles that err independently.
  const double n = static_cast<double>(kBlock), by_noise = sigma * std::sqrt(24 / (n * n * n));
  const double speed = median_of(speeds);
  const bool even = quantile_of(std::move(changes), kShare) < kUneven * std::abs(speed) + kNoise * by_noise;
  for (double& s : speeds) s = std::abs(s - speed);
  return {even, 1.4826 * median_of(std::move(speeds))};
}

}  // namespace tumble::analysis
