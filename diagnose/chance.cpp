#include "diagnose/chance.h"

#include <algorithm>
#include <cmath>

namespace tumble::diagnose {

double batch_freedom(int frames) { return std::clamp(frames - 1.0, 1.0, kBatchFreedom); }

double welch_freedom(double se_a, double se_b, const Freedoms& freedoms) {
  const double a = se_a * se_a, b = se_b * se_b;
  const double least = std::min(freedoms.a, freedoms.b);
  return a + b > 0 ? (a + b) * (a + b) / (a * a / freedoms.a + b * b / freedoms.b) : least;
}

double normal_z(double t, double freedom) {
  const double u = (8 * freedom + 1) / (8 * freedom + 3) * std::sqrt(freedom * std::log1p(t * t / freedom));
  return std::copysign(u, t);
}

double two_sided_chance(double normal_z) { return std::erfc(std::abs(normal_z) / std::sqrt(2.0)); }

std::vector<char> beyond_chance(std::span<const double> chances, double rate) {
  std::vector<double> sorted;
  for (const double p : chances)
    if (!std::isnan(p)) sorted.push_back(p);
  std::sort(sorted.begin(), sorted.end());
  double limit = -1;
  for (std::size_t i = 0; i < sorted.size(); ++i)
    if (sorted[i] <= rate * static_cast<double>(i + 1) / static_cast<double>(sorted.size())) limit = sorted[i];
  std::vector<char> named;
  for (const double p : chances) named.push_back(p <= limit);
  return named;
}

}  // namespace tumble::diagnose
