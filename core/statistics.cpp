#include "core/statistics.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "core/angle.h"

namespace tumble {
namespace {

double average(std::span<const double> x) { return std::accumulate(x.begin(), x.end(), 0.0) / double(x.size()); }

// Variance of the mean of a correlated series.
double variance_of_mean(std::span<const double> x) {
  const std::size_t n = x.size();
  const double mean = average(x);
  const auto covariance = [&](std::size_t lag) {
    double sum = 0;
    for (std::size_t i = 0; i + lag < n; ++i) sum += (x[i] - mean) * (x[i + lag] - mean);
    return sum / double(n);
  };
  const double c0 = covariance(0);
  if (!(c0 > 0)) return 0;
  // Pairs of neighbouring covariances are positive for a reversible chain; the first that is not is noise. Lags beyond
  // n / 4 rest on too few products to be believed.
  double sum = c0 + 2 * covariance(1);
  double last = sum;
  for (std::size_t lag = 2; lag + 1 < n / 4; lag += 2) {
    const double pair = 2 * (covariance(lag) + covariance(lag + 1));
    if (pair <= 0) break;
    last = std::min(last, pair);  // monotone: a later pair is never larger (Geyer 1992, section 3.3)
    sum += last;
  }
  // c0 about the sample's own mean is too small by the variance of that mean: var = s / (n - s / c0).
  const double time = std::max(sum / c0, 1.0 / double(n));
  return c0 * time / std::max(double(n) - time, 1.0);
}

}  // namespace

Estimate mean_of_series(std::span<const double> series) {
  if (series.empty()) return {};
  Estimate e{average(series), kNotGiven};
  if (series.size() >= 4) e.se = std::sqrt(variance_of_mean(series));
  return e;
}

Estimate mean_direction(std::span<const double> directions_deg) {
  double c = 0, s = 0;
  std::vector<double> seen;
  for (const double d : directions_deg) {
    if (std::isnan(d)) continue;
    seen.push_back(d);
    c += std::cos(radians(d));
    s += std::sin(radians(d));
  }
  if (seen.empty()) return {};
  const double mean = degrees(std::atan2(s, c));
  for (double& d : seen) d = wrap_180(d - mean);
  const Estimate deviation = mean_of_series(seen);
  return {wrap_360(mean), deviation.se};
}

double drift_z(std::span<const double> series) {
  if (series.size() < 16) return 0;
  const std::size_t half = series.size() / 2;
  const Estimate first = mean_of_series(series.first(half));
  const Estimate second = mean_of_series(series.last(half));
  const double se = std::hypot(first.se, second.se);
  const double difference = second.value - first.value;
  if (se > 0) return difference / se;
  return difference == 0 ? 0 : std::copysign(INFINITY, difference);
}

Estimate mean_of_repeats(std::span<const Estimate> repeats, bool are_directions) {
  if (repeats.empty()) return {};
  if (repeats.size() == 1) return repeats.front();
  const double n = double(repeats.size());
  std::vector<double> x;
  for (const Estimate& e : repeats) x.push_back(e.value);
  double origin = 0;
  if (are_directions) {
    double c = 0, s = 0;
    for (const double d : x) c += std::cos(radians(d)), s += std::sin(radians(d));
    origin = degrees(std::atan2(s, c));
    for (double& d : x) d = wrap_180(d - origin);
  }
  const double mean = average(x);
  double sum = 0;
  for (const double d : x) sum += (d - mean) * (d - mean);
  return {are_directions ? wrap_360(origin + mean) : mean, std::sqrt(sum / (n - 1) / n)};
}

double se_within_repeats(std::span<const Estimate> repeats) {
  double sum = 0;
  for (const Estimate& e : repeats) sum += e.se * e.se;
  return repeats.empty() ? kNotGiven : std::sqrt(sum) / double(repeats.size());
}

}  // namespace tumble
