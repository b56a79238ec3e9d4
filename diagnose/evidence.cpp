#include "diagnose/evidence.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/config.h"

namespace tumble::diagnose {
namespace {

constexpr double kUsualStrength = 0.7;  // of one who is guilty: standard deviation of the strength
// Of observers that nobody suspects: no measurement is exact.
constexpr double kUsualError = 0.05;  // [full strengths]: 0.1 % of scale and clock, 0.1 degrees, 0.2 % of torque
constexpr double kFarthest = 3;       // standard deviations of what is uncertain; the library goes to 2.3
constexpr double kClueFreedom = 10;   // of Student's t: no check is so exact that it may overrule all others
constexpr int kMostSteps = 40;

struct Problem {
  std::span<const Measured> measured;
  std::span<const Clue> clues;
  Eigen::Index keys = 0;
  std::vector<int> free;
  Eigen::VectorXd prior_sd, low, high;  // of the free ones
  Eigen::Index size = 0;                // of all places
  std::vector<std::pair<int, double>> fixed;

  Eigen::VectorXd all(const Eigen::VectorXd& x) const {
    Eigen::VectorXd p = Eigen::VectorXd::Zero(size);
    for (const auto& [place, value] : fixed) p[place] = value;
    for (std::size_t i = 0; i < free.size(); ++i) p[free[i]] = x[static_cast<Eigen::Index>(i)];
    return p;
  }
};

struct State {
  double misfit = 0;  // -2 ln of likelihood and prior, but for constants
  double chi2 = 0;
  std::vector<double> chi2_of;
  Eigen::MatrixXd information;
  Eigen::VectorXd gradient;  // of misfit / 2
};

struct Rest {  // of one condition's numbers, beside what is expected
  Response::Expected expected;
  Eigen::VectorXd value;
  double variance = 0, chi2 = 0, weight = 0;
  double misfit = 0;  // -2 ln of the likelihood, but for constants
};

Rest rest_of(const Measured& m, const Eigen::VectorXd& places) {
  Rest r{m.response->at(places), {}};
  const bool shown = m.shift.size() > 0;
  r.variance = m.scatter * m.response->revolutions() / m.revolutions + (shown ? m.shift_variance : r.expected.guess);
  r.value = m.seen - r.expected.mean;
  if (shown) r.value -= m.shift;
  r.chi2 = r.value.squaredNorm() / r.variance;
  // A multivariate Student's t with the scatter's covariance; for many degrees of freedom the normal distribution.
  const double freedom = m.response->tail_freedom(), numbers = double(m.response->numbers());
  r.misfit = (freedom + numbers) * std::log1p(r.chi2 / (freedom - 2)) + numbers * std::log(r.variance);
  r.weight = (freedom + numbers) / (freedom - 2 + r.chi2) / r.variance;
  return r;
}

State look(const Problem& problem, const Eigen::VectorXd& x) {
  State s;
  const auto n = x.size();
  s.information = problem.prior_sd.cwiseAbs2().cwiseInverse().asDiagonal();
  s.gradient = s.information * x;
  s.misfit = x.dot(s.gradient);
  const Eigen::VectorXd places = problem.all(x);
  for (const Measured& m : problem.measured) {
    const Rest r = rest_of(m, places);
    Eigen::MatrixXd slope(r.value.size(), n);
    for (Eigen::Index i = 0; i < n; ++i) slope.col(i) = r.expected.slope.col(problem.free[static_cast<std::size_t>(i)]);
    s.chi2 += r.chi2;
    s.chi2_of.push_back(r.chi2);
    s.misfit += r.misfit;
    s.information += r.weight * slope.transpose() * slope;
    s.gradient -= r.weight * slope.transpose() * r.value;
  }
  for (const Clue& clue : problem.clues) {
    double rest = clue.value / clue.se;
    Eigen::VectorXd slope = Eigen::VectorXd::Zero(n);
    for (const auto& [suspect, along] : clue.slopes) {
      const auto place = static_cast<int>(problem.keys) + suspect;
      rest -= along * places[place] / clue.se;
      for (Eigen::Index i = 0; i < n; ++i)
        if (problem.free[static_cast<std::size_t>(i)] == place) slope[i] = along / clue.se;
    }
    s.misfit += (kClueFreedom + 1) * std::log1p(rest * rest / kClueFreedom);
    const double weight = (kClueFreedom + 1) / (kClueFreedom + rest * rest);
    s.information += weight * slope * slope.transpose();
    s.gradient -= weight * slope * rest;
  }
  return s;
}

// Levenberg and Marquardt within the box.
State descend(const Problem& problem, Eigen::VectorXd& x) {
  State here = look(problem, x);
  double damping = 1e-3;
  for (int step = 0; step < kMostSteps; ++step) {
    Eigen::MatrixXd system = here.information;
    system.diagonal() *= 1 + damping;
    const Eigen::VectorXd next = (x - system.ldlt().solve(here.gradient)).cwiseMax(problem.low).cwiseMin(problem.high);
    State there = look(problem, next);
    if (there.misfit < here.misfit) {
      const bool done = here.misfit - there.misfit < 1e-6;
      x = next;
      here = std::move(there);
      damping = std::max(1e-9, damping / 5);
      if (done) break;
    } else {
      damping *= 6;
      if (damping > 1e8) break;
    }
  }
  return here;
}

double normal_share_below(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

// A drum holds whole balls: of a strength that adds some, Laplace's integral over `at` +- `se` is a sum over their
// numbers, none excepted.
double log_share_of_whole(const Suspect& suspect, double at, double se) {
  for (const Suspect::Set& set : suspect.sets) {
    if (!set.whole) continue;
    const double step = 1 / std::abs(set.full - set.none);
    double sum = 0;
    for (double n = std::ceil(suspect.low / step); n * step <= suspect.high; ++n) {
      const double z = (n * step - at) / se;
      if (n != 0) sum += step / se * std::exp(-0.5 * z * z) / std::sqrt(2 * M_PI);
    }
    return std::log(sum + 1e-300);
  }
  return 0;
}

}  // namespace

double Explanation::se(int place) const {
  for (std::size_t i = 0; i < free.size(); ++i)
    if (free[i] == place) return std::sqrt(covariance(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(i)));
  return kNotGiven;
}

double log_likelihood(std::span<const Measured> measured, const Eigen::VectorXd& places) {
  double sum = 0;
  for (const Measured& m : measured) sum -= 0.5 * rest_of(m, places).misfit;
  return sum;
}

Explanation explain(std::span<const Measured> measured, std::span<const Suspect> suspects, std::vector<int> guilty,
                    std::span<const Clue> clues) {
  const int keys = static_cast<int>(measured.front().response->uncertain());
  Problem problem{measured, clues, keys, {}, {}, {}, {}, keys + static_cast<Eigen::Index>(suspects.size()), {}};
  std::vector<double> sd, low, high;
  const auto add = [&](int place, double prior, double least, double most) {
    problem.free.push_back(place);
    sd.push_back(prior);
    low.push_back(least);
    high.push_back(most);
  };
  for (int k = 0; k < keys; ++k) add(k, 1, -kFarthest, kFarthest);
  std::vector<std::size_t> accused;  // where the guilty stand among the free
  for (int s = 0; s < static_cast<int>(suspects.size()); ++s) {
    const bool is_guilty = std::find(guilty.begin(), guilty.end(), s) != guilty.end();
    const Suspect& suspect = suspects[static_cast<std::size_t>(s)];
    if (is_guilty && suspect.low < suspect.high) accused.push_back(problem.free.size());
    if (is_guilty && suspect.low == suspect.high)
      problem.fixed.emplace_back(keys + s, suspect.low);
    else if (is_guilty)
      add(keys + s, kUsualStrength, suspect.low, suspect.high);
    else if (!suspect.is_simulated())
      add(keys + s, kUsualError, -4 * kUsualError, 4 * kUsualError);
  }
  const auto vector_of = [](const std::vector<double>& v) {
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(v.data(), static_cast<Eigen::Index>(v.size())));
  };
  problem.prior_sd = vector_of(sd);
  problem.low = vector_of(low);
  problem.high = vector_of(high);

  Explanation best;
  double least = INFINITY;
  const std::size_t starts = std::size_t{1} << accused.size();
  for (std::size_t start = 0; start < starts; ++start) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(problem.prior_sd.size());
    for (std::size_t a = 0; a < accused.size(); ++a) {
      const auto i = static_cast<Eigen::Index>(accused[a]);
      const bool other = (start >> a & 1) != 0;
      x[i] = problem.low[i] < 0 ? (other ? -0.5 : 0.5) : (other ? 0.9 : 0.3);
    }
    const State s = descend(problem, x);
    if (!(s.misfit < least)) continue;
    least = s.misfit;
    best.places = problem.all(x);
    best.covariance = s.information.inverse();
    best.chi2 = s.chi2;
    best.chi2_of = s.chi2_of;
    // Laplace: what is known beforehand against what is left open.
    best.log_evidence = -0.5 * s.misfit - s.information.llt().matrixLLT().diagonal().array().log().sum() -
                        problem.prior_sd.array().log().sum();
    for (const std::size_t a : accused) {  // of one-sided strengths half of the prior is not there, of balls halves
      const auto i = static_cast<Eigen::Index>(a);
      const double se = std::sqrt(best.covariance(i, i));
      if (problem.low[i] >= 0) best.log_evidence += std::log(2 * normal_share_below(x[i] / se));
      const Suspect& suspect = suspects[static_cast<std::size_t>(problem.free[a] - keys)];
      best.log_evidence += log_share_of_whole(suspect, x[i], se);
    }
  }
  if (std::isinf(least)) throw std::logic_error("an explanation of numbers that are none");
  best.suspects = std::move(guilty);
  best.free = problem.free;
  for (const Measured& m : measured) best.numbers += double(m.response->numbers());
  return best;
}

}  // namespace tumble::diagnose
