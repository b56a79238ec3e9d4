#include "diagnose/emulator.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diagnose/minimum.h"

namespace tumble::diagnose {
namespace {

// What is expected before the runs speak; spreads are one standard deviation of the logarithm. No response is quite a
// polynomial, and a dozen scattered runs cannot show by how much: without the amplitude's expectation they would claim
// that it is one, all with the same sign, and the error bars would be too small.
constexpr double kUsualAmplitude = 0.05, kAmplitudeSpread = 0.7;  // of the deviation [of the values' half range]
constexpr double kUsualWidth = 0.6, kWidthSpread = 0.7;           // of the deviation [of the box]
constexpr double kHintSpread = 0.4;  // of the runs' scatter from packing to packing about their own standard error
constexpr double kJitter = 1e-10;    // keeps the matrix invertible where runs have no scatter
constexpr int kMostCalls = 400;

double square(double x) { return x * x; }

std::size_t quadratic_terms(std::size_t d) { return (d + 1) * (d + 2) / 2; }

double log_determinant(const Eigen::LLT<Eigen::MatrixXd>& factor) {
  return 2 * factor.matrixLLT().diagonal().array().log().sum();
}

}  // namespace

Emulator::Emulator(std::vector<std::vector<double>> at, const std::vector<double>& values, double typical_se)
    : at_(std::move(at)) {
  const auto n = static_cast<Eigen::Index>(at_.size());
  const std::size_t d = at_.front().size();
  // Few points cannot bear all the products; the deviation takes up the curvature then.
  quadratic_ = at_.size() >= 2 * quadratic_terms(d);
  values_ = Eigen::Map<const Eigen::VectorXd>(values.data(), n);
  offset_ = values_.mean();
  values_.array() -= offset_;
  scale_ = std::max((values_.maxCoeff() - values_.minCoeff()) / 2, 1e-12 * std::max(1.0, std::abs(offset_)));
  values_ /= scale_;
  basis_.resize(n, basis(at_.front()).size());
  for (Eigen::Index i = 0; i < n; ++i) basis_.row(i) = basis(at_[static_cast<std::size_t>(i)]).transpose();

  const double log_hint = typical_se > 0 ? std::log(typical_se / scale_) : kNotGiven;
  // ln of amplitude, scatter, widths.
  Box box{{std::log(1e-3), std::log(1e-5)}, {std::log(10.0), std::log(3.0)}};
  if (!std::isnan(log_hint)) box.high[1] = std::max(box.high[1], log_hint + 1);
  box.low.resize(d + 2, std::log(0.1));
  box.high.resize(d + 2, std::log(5.0));
  std::vector<double> best;
  double least = std::numeric_limits<double>::infinity();
  for (const double amplitude : {0.02, 0.5}) {  // a polynomial with scatter, or more than that
    std::vector<double> start(d + 2, std::log(kUsualWidth));
    start[0] = std::log(amplitude);
    start[1] = std::clamp(std::isnan(log_hint) ? std::log(0.2) : log_hint, box.low[1], box.high[1]);
    start =
        minimum_near([&](const std::vector<double>& p) { return misfit(p, log_hint); }, start, box, 1e-3, kMostCalls);
    if (const double value = misfit(start, log_hint); best.empty() || value < least) best = start, least = value;
  }
  factorise(best);
  scatter_ = std::sqrt(noise2_) * scale_;
}

Eigen::VectorXd Emulator::basis(const std::vector<double>& at) const {
  const std::size_t d = at.size();
  Eigen::VectorXd h(static_cast<Eigen::Index>(quadratic_ ? quadratic_terms(d) : d + 1));
  Eigen::Index i = 0;
  h[i++] = 1;
  for (std::size_t k = 0; k < d; ++k) h[i++] = at[k] - 0.5;
  for (std::size_t k = 0; quadratic_ && k < d; ++k)
    for (std::size_t l = 0; l <= k; ++l) h[i++] = (at[k] - 0.5) * (at[l] - 0.5);
  return h;
}

double Emulator::correlation(const std::vector<double>& a, const std::vector<double>& b) const {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += square((a[k] - b[k]) / widths_[k]);
  const double r = std::sqrt(5 * sum);
  return (1 + r + r * r / 3) * std::exp(-r);
}

// With these logarithms of amplitude, scatter and widths; false where the matrix cannot be factorised.
bool Emulator::factorise(const std::vector<double>& logs) {
  amplitude2_ = std::exp(2 * logs[0]);
  noise2_ = std::exp(2 * logs[1]);
  widths_.assign(logs.size() - 2, 0);
  for (std::size_t k = 0; k < widths_.size(); ++k) widths_[k] = std::exp(logs[k + 2]);
  const auto n = values_.size();
  Eigen::MatrixXd k(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    for (Eigen::Index j = 0; j < i; ++j)
      k(i, j) = k(j, i) = amplitude2_ * correlation(at_[static_cast<std::size_t>(i)], at_[static_cast<std::size_t>(j)]);
    k(i, i) = amplitude2_ + noise2_ + kJitter;
  }
  covariance_.compute(k);
  if (covariance_.info() != Eigen::Success) return false;
  solved_basis_ = covariance_.solve(basis_);
  trend_information_.compute(basis_.transpose() * solved_basis_);
  if (trend_information_.info() != Eigen::Success) return false;
  trend_ = trend_information_.solve(solved_basis_.transpose() * values_);
  weights_ = covariance_.solve(values_ - basis_ * trend_);
  return true;
}

// -2 ln of the restricted likelihood, and of what is known beforehand.
double Emulator::misfit(const std::vector<double>& logs, double log_hint) {
  if (!factorise(logs)) return kNotGiven;
  double sum = log_determinant(covariance_) + log_determinant(trend_information_) + values_.dot(weights_);
  for (std::size_t k = 2; k < logs.size(); ++k) sum += square((logs[k] - std::log(kUsualWidth)) / kWidthSpread);
  sum += square((logs[0] - std::log(kUsualAmplitude)) / kAmplitudeSpread);
  if (!std::isnan(log_hint)) sum += square((logs[1] - log_hint) / kHintSpread);
  return sum;
}

// With the runs.
Eigen::VectorXd Emulator::covariances(const std::vector<double>& at) const {
  Eigen::VectorXd k(values_.size());
  for (Eigen::Index i = 0; i < k.size(); ++i) k[i] = amplitude2_ * correlation(at, at_[static_cast<std::size_t>(i)]);
  return k;
}

Estimate Emulator::mean(const std::vector<double>& at) const {
  const Eigen::VectorXd k = covariances(at), h = basis(at), half = covariance_.matrixL().solve(k);
  const Eigen::VectorXd u = h - solved_basis_.transpose() * k;
  const double variance = amplitude2_ - half.squaredNorm() + u.dot(trend_information_.solve(u));
  return {offset_ + scale_ * (h.dot(trend_) + k.dot(weights_)), scale_ * std::sqrt(std::max(variance, 0.0))};
}

double Emulator::error_covariance(const std::vector<double>& a, const std::vector<double>& b) const {
  const Eigen::VectorXd ka = covariances(a), kb = covariances(b);
  const Eigen::VectorXd ua = basis(a) - solved_basis_.transpose() * ka, ub = basis(b) - solved_basis_.transpose() * kb;
  const double covariance =
      amplitude2_ * correlation(a, b) - ka.dot(covariance_.solve(kb)) + ua.dot(trend_information_.solve(ub));
  return scale_ * scale_ * covariance;
}

}  // namespace tumble::diagnose
