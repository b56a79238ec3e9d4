#include "diagnose/impacts.h"

#include <cmath>

#include "diagnose/sampled.h"

namespace tumble::diagnose {
namespace {

// Impacts come in bursts: variance of a count over that of independent ones, 1.0 to 2.4 between seeds of mills that do
// not drift.
constexpr double kBursts = 2;
constexpr double kLeastCount = 5;  // in a bin of each run: fewer have no error that could be told from them

SampledDifference compare_rates(const char* name, const std::vector<double>& edges, const std::vector<double>& a,
                                double seconds_a, const std::vector<double>& b, double seconds_b) {
  SampledDifference d{.name = name, .unit = "1/s", .x_name = "energy lost in an impact", .x_unit = "J"};
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    if (!(a[i] > 0) && !(b[i] > 0)) continue;
    const bool enough = a[i] * seconds_a >= kLeastCount && b[i] * seconds_b >= kLeastCount;
    d.x.push_back(std::sqrt(edges[i] * edges[i + 1]));
    d.a.push_back(a[i]);
    d.b.push_back(b[i]);
    d.a_se.push_back(enough ? std::sqrt(kBursts * a[i] / seconds_a) : kNotGiven);
    d.b_se.push_back(enough ? std::sqrt(kBursts * b[i] / seconds_b) : kNotGiven);
  }
  judge(d, {}, true);
  return d;
}

}  // namespace

std::vector<SampledDifference> compare_impacts(const ImpactSpectrum& a, double seconds_a, const ImpactSpectrum& b,
                                               double seconds_b) {
  const std::size_t bins = a.edges_J.empty() ? 0 : a.edges_J.size() - 1;
  if (bins == 0 || a.edges_J != b.edges_J || !(seconds_a > 0) || !(seconds_b > 0)) return {};
  for (const auto* rates : {&a.ball_ball, &a.ball_wall, &b.ball_ball, &b.ball_wall})
    if (rates->size() != bins) return {};
  return {compare_rates("impacts_ball_ball", a.edges_J, a.ball_ball, seconds_a, b.ball_ball, seconds_b),
          compare_rates("impacts_ball_wall", a.edges_J, a.ball_wall, seconds_a, b.ball_wall, seconds_b)};
}

}  // namespace tumble::diagnose
