#include "diagnose/rivals.h"

#include <algorithm>

namespace tumble::diagnose {
namespace {
constexpr double kThreeDeviations = 4.5;  // ln of the likelihood
}

double separation(std::span<const Measured> measured, std::span<const Suspect> suspects, const Eigen::VectorXd& places,
                  const std::vector<int>& by) {
  std::vector<Measured> would_be(measured.begin(), measured.end());
  for (Measured& m : would_be) {
    m.seen = m.response->at(places).mean;
    m.shift.resize(0);
  }
  return 0.5 * explain(would_be, suspects, by).chi2;
}

std::vector<std::vector<std::string>> alike(std::span<const Measured> measured, std::span<const Suspect> suspects) {
  const auto keys = static_cast<Eigen::Index>(measured.front().response->uncertain());
  const auto n = static_cast<int>(suspects.size());
  std::vector<std::vector<std::string>> pairs;
  const auto far_apart = [&](int guilty, int by) {
    Eigen::VectorXd places = Eigen::VectorXd::Zero(keys + n);
    places[keys + guilty] = std::min(1.0, suspects[static_cast<std::size_t>(guilty)].high);
    return separation(measured, suspects, places, {by}) > kThreeDeviations;
  };
  for (int a = 0; a < n; ++a)
    for (int b = a + 1; b < n; ++b) {
      const Suspect &one = suspects[static_cast<std::size_t>(a)], &two = suspects[static_cast<std::size_t>(b)];
      if (one.name == two.name || one.turns_with_drum || two.turns_with_drum) continue;
      if (!far_apart(a, b) || !far_apart(b, a)) pairs.push_back({one.name, two.name});
    }
  return pairs;
}

}  // namespace tumble::diagnose
