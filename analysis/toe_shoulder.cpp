#include "analysis/toe_shoulder.h"

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/random.h"
#include "core/statistics.h"

namespace tumble::analysis {
namespace {

constexpr std::size_t kBins = 360;
constexpr int kReplicates = 400;  // bootstrap: 3.5 % error of the standard error itself
constexpr std::size_t kMostBlocks = 256;
constexpr std::size_t kBatches = 16;  // as many as the fields have

std::size_t bin(long i) { return static_cast<std::size_t>(((i % 360) + 360) % 360); }

double percentile_90(const RingProfile& p) {
  std::vector<double> seen;
  for (double v : p)
    if (!std::isnan(v)) seen.push_back(v);
  if (seen.empty()) return kNotGiven;
  std::sort(seen.begin(), seen.end());
  const double at = 0.9 * static_cast<double>(seen.size() - 1);
  const auto low = static_cast<std::size_t>(at);
  const std::size_t high = std::min(low + 1, seen.size() - 1);
  return seen[low] + (at - static_cast<double>(low)) * (seen[high] - seen[low]);
}

// First fall below `level` from `start` in direction `step`; degrees, not wrapped.
double first_fall(const RingProfile& p, long start, int step, double level) {
  double last = kNotGiven;
  for (long k = 0; k < 360; ++k) {
    const long i = start + step * k;
    const double v = p[bin(i)];
    if (std::isnan(v)) {
      last = kNotGiven;
      continue;
    }
    if (v < level) {
      if (k == 0 || std::isnan(last)) return kNotGiven;  // hidden, or the middle itself is empty
      return static_cast<double>(i) + 0.5 - step * (level - v) / (last - v);
    }
    last = v;
  }
  return kNotGiven;
}

RingProfile mean_profile(const std::vector<double>& sums) {
  RingProfile mean;
  for (std::size_t i = 0; i < kBins; ++i) mean[i] = sums[kBins + i] > 0 ? sums[i] / sums[kBins + i] : kNotGiven;
  return mean;
}

// Standard errors of the mean profile: batch means, ratio estimator (Cochran 1977, section 6.3).
RingProfile profile_errors(const BlockSums& sums, const RingProfile& mean) {
  RingProfile se;
  se.fill(kNotGiven);
  const auto batches = sums.batches(kBatches);
  if (batches.size() < 4) return se;
  const double spread = static_cast<double>(batches.size()) / static_cast<double>(batches.size() - 1);
  for (std::size_t i = 0; i < kBins; ++i) {
    double squares = 0, seen = 0;
    for (const auto& b : batches) {
      const double d = b[i] - mean[i] * b[kBins + i];
      squares += d * d;
      seen += b[kBins + i];
    }
    if (seen > 0) se[i] = std::sqrt(squares * spread) / seen;
  }
  return se;
}

// Occupancy per block, averaged over the two degrees round an edge: the series whose correlation sets the block length.
std::vector<double> edge_series(const BlockSums& sums, double angle) {
  std::vector<double> series;
  for (std::size_t b = 0; b < sums.count(); ++b) {
    double occupancy = 0, seen = 0;
    for (long i = static_cast<long>(std::floor(angle)) - 1; i <= static_cast<long>(std::floor(angle)) + 1; ++i) {
      occupancy += sums.block(b)[bin(i)];
      seen += sums.block(b)[kBins + bin(i)];
    }
    if (seen > 0) series.push_back(occupancy / seen);
  }
  return series;
}

// Integrated autocorrelation time in blocks: squared ratio of the true error of the mean to that of free samples.
double correlation_blocks(const std::vector<double>& series) {
  const Estimate mean = mean_of_series(series);
  if (std::isnan(mean.se)) return 1.0;
  double sum = 0;
  for (double v : series) sum += (v - mean.value) * (v - mean.value);
  const double n = static_cast<double>(series.size());
  const double free = sum / (n * (n - 1.0));
  return free > 0 ? std::max(1.0, mean.se * mean.se / free) : 1.0;
}

struct Spread {  // of replicates about the estimate, degrees
  double sum = 0, squares = 0;
  int n = 0;
  void add(double replicate, double estimate) {
    if (std::isnan(replicate) || std::isnan(estimate)) return;
    const double d = wrap_180(replicate - estimate);
    sum += d;
    squares += d * d;
    ++n;
  }
  double deviation() const {
    return n < kReplicates / 2 ? kNotGiven : std::sqrt(std::max(0.0, (squares - sum * sum / n) / (n - 1)));
  }
};

}  // namespace

RingProfile smooth(const RingProfile& profile, int width) {
  RingProfile result;
  const int half = width / 2;
  for (long i = 0; i < 360; ++i) {
    double sum = 0;
    int n = 0;
    for (long k = i - half; k <= i + half; ++k) {
      const double v = profile[bin(k)];
      if (std::isnan(v)) continue;
      sum += v;
      ++n;
    }
    result[bin(i)] = std::isnan(profile[bin(i)]) ? kNotGiven : sum / n;
  }
  return result;
}

ChargeEdges find_edges(const RingProfile& smoothed) {
  ChargeEdges edges;
  edges.plateau = percentile_90(smoothed);
  if (!(edges.plateau > 0)) return edges;
  double c = 0, s = 0;
  for (std::size_t i = 0; i < kBins; ++i) {
    if (!(smoothed[i] > 0.5 * edges.plateau)) continue;
    const double a = radians(static_cast<double>(i) + 0.5);
    c += std::cos(a);
    s += std::sin(a);
  }
  edges.middle = wrap_360(degrees(std::atan2(s, c)));
  const long start = static_cast<long>(std::floor(edges.middle));
  for (std::size_t level = 0; level < kEdgeShare.size(); ++level) {
    const double toe = first_fall(smoothed, start, -1, kEdgeShare[level] * edges.plateau);
    const double shoulder = first_fall(smoothed, start, +1, kEdgeShare[level] * edges.plateau);
    edges.toe[level] = std::isnan(toe) ? toe : wrap_360(toe);
    edges.shoulder[level] = std::isnan(shoulder) ? shoulder : wrap_360(shoulder);
  }
  return edges;
}

void RingMean::add(const RingProfile& profile, const std::vector<bool>& hidden) {
  for (std::size_t i = 0; i < kBins; ++i) {
    if (i < hidden.size() && hidden[i]) continue;
    sum_[i] += profile[i];
    ++seen_[i];
  }
}

RingProfile RingMean::mean() const {
  RingProfile mean;
  for (std::size_t i = 0; i < kBins; ++i) mean[i] = seen_[i] > 0 ? sum_[i] / seen_[i] : kNotGiven;
  return mean;
}

EdgeStatistics::EdgeStatistics(double passage_frames)
    : half_window_(static_cast<std::size_t>(std::max(0.0, std::round((passage_frames - 1.0) / 2.0)))),
      sums_(2 * kBins, kMostBlocks) {}

void EdgeStatistics::add(const RingProfile& profile) {
  std::vector<double> row(2 * kBins);
  for (std::size_t i = 0; i < kBins; ++i) {
    const bool seen = !std::isnan(profile[i]);
    row[i] = seen ? profile[i] : 0.0;
    row[kBins + i] = seen ? 1.0 : 0.0;
  }
  sums_.add(row);
  window_.push_back(profile);
  if (window_.size() > 2 * half_window_ + 1) window_.pop_front();
  ++added_;
  if (added_ > half_window_) per_frame_.push_back(edges_at(added_ - 1 - half_window_));
}

ChargeEdges EdgeStatistics::edges_at(std::size_t frame) const {
  const std::size_t oldest = added_ - window_.size();
  const std::size_t from = frame > half_window_ ? frame - half_window_ : 0;
  const std::size_t to = std::min(frame + half_window_, added_ - 1);
  std::vector<double> sums(2 * kBins, 0.0);
  for (std::size_t f = std::max(from, oldest); f <= to; ++f) {
    const RingProfile& p = window_[f - oldest];
    for (std::size_t i = 0; i < kBins; ++i) {
      if (std::isnan(p[i])) continue;
      sums[i] += p[i];
      sums[kBins + i] += 1.0;
    }
  }
  return find_edges(smooth(mean_profile(sums), 5));
}

std::vector<ChargeEdges> EdgeStatistics::finish_frames() {
  while (per_frame_.size() < added_) per_frame_.push_back(edges_at(per_frame_.size()));
  return per_frame_;
}

EdgeEstimates EdgeStatistics::estimate() const {
  EdgeEstimates result;
  result.occupancy = mean_profile(sums_.total());
  result.occupancy_se = profile_errors(sums_, result.occupancy);
  const ChargeEdges edges = find_edges(smooth(result.occupancy, kMeanBox));
  for (std::size_t l = 0; l < kEdgeShare.size(); ++l) {
    result.toe[l].value = edges.toe[l];
    result.shoulder[l].value = edges.shoulder[l];
  }
  const std::size_t n = sums_.count();
  if (n < 8) return result;

  double correlation = 1.0;
  for (std::size_t l = 0; l < kEdgeShare.size(); ++l)
    for (double angle : {edges.toe[l], edges.shoulder[l]})
      if (!std::isnan(angle)) correlation = std::max(correlation, correlation_blocks(edge_series(sums_, angle)));
  // Blocks twice as long as the correlation keep most of it; what they cut is put back as the factor for an
  // exponential correlation of integrated time T in blocks of length L, 1 - T / (2 L) of the variance.
  const auto length =
      static_cast<std::size_t>(std::clamp(std::ceil(2.0 * correlation), 1.0, std::floor(static_cast<double>(n) / 4.0)));
  const double kept = correlation > 1.0 ? std::max(0.5, 1.0 - correlation / (2.0 * static_cast<double>(length))) : 1.0;

  Random random(1);
  std::array<Spread, 3> toe, shoulder;
  for (int r = 0; r < kReplicates; ++r) {
    std::vector<double> total(2 * kBins, 0.0);
    for (std::size_t taken = 0; taken < n;) {
      const std::size_t start = random.below(n);
      for (std::size_t k = 0; k < length && taken < n; ++k, ++taken) {
        const auto block = sums_.block((start + k) % n);
        for (std::size_t i = 0; i < total.size(); ++i) total[i] += block[i];
      }
    }
    const ChargeEdges e = find_edges(smooth(mean_profile(total), kMeanBox));
    for (std::size_t l = 0; l < kEdgeShare.size(); ++l) {
      toe[l].add(e.toe[l], edges.toe[l]);
      shoulder[l].add(e.shoulder[l], edges.shoulder[l]);
    }
  }
  for (std::size_t l = 0; l < kEdgeShare.size(); ++l) {
    result.toe[l].se = toe[l].deviation() / std::sqrt(kept);
    result.shoulder[l].se = shoulder[l].deviation() / std::sqrt(kept);
  }
  return result;
}

}  // namespace tumble::analysis
