#include "diagnose/sparse_terms.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "diagnose/chance.h"

namespace tumble::diagnose {
namespace {

constexpr int kDraws = 200;
constexpr double kIncluded = 0.9, kHolds = 0.01;
constexpr int kMostTerms = 3;

struct Fit {
  Eigen::VectorXd coefficients;
  Eigen::MatrixXd inverse;  // of the terms' products
  double left = 0;          // sum of squares
  bool good = true;
};

Fit fit_of(const TermSums& sums, const std::vector<int>& terms) {
  const auto n = static_cast<Eigen::Index>(terms.size()), last = sums.products.rows() - 1;
  Eigen::MatrixXd among(n, n);
  Eigen::VectorXd with(n);
  for (Eigen::Index a = 0; a < n; ++a) {
    with[a] = sums.products(terms[static_cast<std::size_t>(a)], last);
    for (Eigen::Index b = 0; b < n; ++b)
      among(a, b) = sums.products(terms[static_cast<std::size_t>(a)], terms[static_cast<std::size_t>(b)]);
  }
  Fit f;
  f.left = sums.products(last, last);
  if (n == 0) return f;
  const Eigen::LLT<Eigen::MatrixXd> factor(among);
  f.good = factor.info() == Eigen::Success;
  if (!f.good) return f;
  f.coefficients = factor.solve(with);
  f.inverse = factor.solve(Eigen::MatrixXd::Identity(n, n));
  f.left -= f.coefficients.dot(with);
  return f;
}

// By the Bayesian information criterion (Schwarz 1978).
std::vector<int> best_terms(const TermSums& sums) {
  const int count = static_cast<int>(sums.products.rows()) - 1;
  std::vector<int> best;
  double least = INFINITY;
  const auto look_at = [&](const std::vector<int>& terms) {
    const Fit f = fit_of(sums, terms);
    if (!f.good || !(f.left > 0)) return;
    const double cost = sums.rows * std::log(f.left / sums.rows) + double(terms.size()) * std::log(sums.rows);
    if (cost < least) least = cost, best = terms;
  };
  std::vector<int> terms;
  const auto add = [&](const auto& more, int from) -> void {
    look_at(terms);
    if (static_cast<int>(terms.size()) == kMostTerms) return;
    for (int t = from; t < count; ++t) {
      terms.push_back(t);
      more(more, t + 1);
      terms.pop_back();
    }
  };
  add(add, 0);
  return best;
}

bool holds(const std::vector<int>& terms, int term) {
  return std::find(terms.begin(), terms.end(), term) != terms.end();
}

// Chance that `term` would be so far from 0 in parts that had no say in choosing it. One numerator: F is t squared.
double chance_of(const TermSums& chose, const TermSums& tested, int term) {
  const std::vector<int> terms = best_terms(chose);
  if (!holds(terms, term)) return 1;
  const Fit f = fit_of(tested, terms);
  if (!f.good) return 1;
  const auto at = std::find(terms.begin(), terms.end(), term) - terms.begin();
  const double freedom = tested.rows - double(terms.size());
  const double t = f.coefficients[at] / std::sqrt(f.inverse(at, at) * f.left / freedom);
  return two_sided_chance(normal_z(t, freedom));
}

TermSums sum_of(const std::vector<TermSums>& parts, const std::vector<double>& times) {
  TermSums sum(static_cast<int>(parts.front().products.rows()) - 1);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    sum.products += times[p] * parts[p].products;
    sum.rows += times[p] * parts[p].rows;
  }
  return sum;
}

}  // namespace

void TermSums::add(const Eigen::VectorXd& v, double weight) {
  products += weight * v * v.transpose();
  rows += 1;
}

std::vector<SparseTerm> sparse_terms(const std::vector<TermSums>& parts) {
  if (parts.size() < 4) return {};
  const int count = static_cast<int>(parts.front().products.rows()) - 1;
  Random random(1);
  std::vector<TermSums> draws;
  std::vector<double> inclusion(static_cast<std::size_t>(count), 0.0);
  for (int d = 0; d < kDraws; ++d) {
    std::vector<double> times(parts.size(), 0.0);
    for (std::size_t p = 0; p < parts.size(); ++p) times[random.below(parts.size())] += 1;
    draws.push_back(sum_of(parts, times));
    for (const int t : best_terms(draws.back())) inclusion[static_cast<std::size_t>(t)] += 1.0 / kDraws;
  }
  std::vector<int> chosen;
  for (int t = 0; t < count; ++t)
    if (inclusion[static_cast<std::size_t>(t)] >= kIncluded) chosen.push_back(t);

  std::vector<double> even(parts.size()), odd(parts.size()), all(parts.size(), 1.0);
  for (std::size_t p = 0; p < parts.size(); ++p) (p % 2 ? odd : even)[p] = 1;
  const TermSums one = sum_of(parts, even), other = sum_of(parts, odd);
  const Fit whole = fit_of(sum_of(parts, all), chosen);
  if (!whole.good) return {};
  std::vector<SparseTerm> found;
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    SparseTerm s{chosen[k], whole.coefficients[static_cast<Eigen::Index>(k)], 0,
                 inclusion[static_cast<std::size_t>(chosen[k])], 1};
    double squares = 0, n = 0;
    for (const TermSums& d : draws) {
      const Fit f = fit_of(d, chosen);
      if (!f.good) continue;
      squares += std::pow(f.coefficients[static_cast<Eigen::Index>(k)] - s.coefficient, 2);
      n += 1;
    }
    s.se = std::sqrt(squares / n);
    s.p = std::max(chance_of(one, other, s.term), chance_of(other, one, s.term));
    if (s.p <= kHolds) found.push_back(s);
  }
  return found;
}

}  // namespace tumble::diagnose
