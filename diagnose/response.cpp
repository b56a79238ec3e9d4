#include "diagnose/response.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace tumble::diagnose {
namespace {

// How far a linear term may move a number, before any run speaks [standard deviations of one run].
constexpr double kLinear = 100;
constexpr std::array kBends{0.01, 0.03, 0.1, 0.3, 1.0};  // curvature, as a share of what is linear
constexpr double kLeastSize = 0.2;
constexpr double kMostOwnShare = 0.95;
constexpr double kHeaviestTail = 5;  // degrees of freedom

struct Fit {
  Eigen::MatrixXd coefficients, information;
  Eigen::VectorXd left_out;  // mean square of each number in runs that had no part in the fit
  Eigen::VectorXd sd;        // of each number about the fit
  double used = 0;           // degrees of freedom
};

Fit fit_ridge(const Eigen::MatrixXd& design, const Eigen::MatrixXd& seen, const Eigen::VectorXd& precision) {
  const auto n = double(design.rows());
  Fit fit;
  Eigen::MatrixXd system = design.transpose() * design;
  system.diagonal() += precision;
  fit.information = system.ldlt().solve(Eigen::MatrixXd::Identity(system.rows(), system.cols()));
  fit.coefficients = fit.information * (design.transpose() * seen);
  const Eigen::VectorXd own = (design * fit.information).cwiseProduct(design).rowwise().sum();
  const Eigen::MatrixXd rest = seen - design * fit.coefficients;
  const Eigen::VectorXd weight = (1 - own.array().min(kMostOwnShare)).inverse();
  fit.left_out = (weight.asDiagonal() * rest).colwise().squaredNorm() / n;
  fit.used = own.sum();
  fit.sd = (rest.colwise().squaredNorm() / std::max(1.0, n - fit.used)).cwiseSqrt();
  return fit;
}

}  // namespace

Response::Response(const std::vector<const SignatureRun*>& runs, const std::vector<Suspect>& suspects,
                   const std::vector<std::size_t>& chosen, const std::vector<double>& noise, double span,
                   double torque_unit)
    : features_(runs, suspects, chosen, noise, span, torque_unit), uncertain_(runs.front()->uncertain.size()) {
  const std::size_t d = uncertain_;
  simulated_terms_ = 1 + d + d * (d + 1) / 2;
  terms_of_.resize(suspects.size());
  for (std::size_t s = 0; s < suspects.size(); ++s)
    if (suspects[s].is_simulated()) terms_of_[s] = simulated_terms_, simulated_terms_ += 2 + d;
  terms_ = simulated_terms_;
  for (std::size_t s = 0; s < suspects.size(); ++s)
    if (!suspects[s].is_simulated()) terms_of_[s] = terms_, terms_ += 2 + d;

  Eigen::MatrixXd seen(static_cast<Eigen::Index>(runs.size()), features_.count());
  for (std::size_t r = 0; r < runs.size(); ++r) {
    seen.row(static_cast<Eigen::Index>(r)) = features_.of_run(r, observed_at(runs[r]->seen, span));
    revolutions_ += runs[r]->revolutions / double(runs.size());
  }
  coefficients_ = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(terms_), seen.cols());
  fit(runs, seen);
  fit_observers(runs, seen, suspects, span, torque_unit);

  Eigen::MatrixXd rest = seen;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Eigen::VectorXd b = basis(places_of(*runs[r])),
                          simulated = b.head(static_cast<Eigen::Index>(simulated_terms_));
    // The fit bends towards each run, the more the fewer there are like it.
    const double own_share = std::min(simulated.dot(information_ * simulated), kMostOwnShare);
    rest.row(static_cast<Eigen::Index>(r)) -= (b.transpose() * coefficients_).eval();
    rest.row(static_cast<Eigen::Index>(r)) /= std::sqrt(1 - own_share);
  }
  whiten(rest);
}

Eigen::VectorXd Response::places_of(const SignatureRun& run) const {
  const auto d = static_cast<Eigen::Index>(uncertain_);
  Eigen::VectorXd places = Eigen::VectorXd::Zero(d + static_cast<Eigen::Index>(terms_of_.size()));
  for (Eigen::Index k = 0; k < d; ++k) places[k] = run.uncertain[static_cast<std::size_t>(k)];
  if (run.suspect >= 0) places[d + run.suspect] = run.strength;
  return places;
}

// 1, the keys, their products; of each suspect its strength, its square, its products with the keys.
Eigen::VectorXd Response::basis(const Eigen::VectorXd& p) const {
  Eigen::VectorXd b = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(terms_));
  const auto d = static_cast<Eigen::Index>(uncertain_);
  Eigen::Index i = 0;
  b[i++] = 1;
  for (Eigen::Index k = 0; k < d; ++k) b[i++] = p[k];
  for (Eigen::Index k = 0; k < d; ++k)
    for (Eigen::Index l = 0; l <= k; ++l) b[i++] = p[k] * p[l];
  for (std::size_t s = 0; s < terms_of_.size(); ++s) {
    const double strength = p[d + static_cast<Eigen::Index>(s)];
    if (strength == 0) continue;
    i = static_cast<Eigen::Index>(terms_of_[s]);
    b[i++] = strength;
    b[i++] = strength * strength;
    for (Eigen::Index k = 0; k < d; ++k) b[i++] = strength * p[k];
  }
  return b;
}

Eigen::MatrixXd Response::basis_slope(const Eigen::VectorXd& p) const {
  const auto d = static_cast<Eigen::Index>(uncertain_);
  Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(terms_), p.size());
  Eigen::Index i = 1;
  for (Eigen::Index k = 0; k < d; ++k) slope(i++, k) = 1;
  for (Eigen::Index k = 0; k < d; ++k)
    for (Eigen::Index l = 0; l <= k; ++l, ++i) {
      slope(i, k) += p[l];
      slope(i, l) += p[k];
    }
  for (std::size_t s = 0; s < terms_of_.size(); ++s) {
    const Eigen::Index at = d + static_cast<Eigen::Index>(s);
    i = static_cast<Eigen::Index>(terms_of_[s]);
    slope(i++, at) = 1;
    slope(i++, at) = 2 * p[at];
    for (Eigen::Index k = 0; k < d; ++k, ++i) {
      slope(i, at) = p[k];
      slope(i, k) = p[at];
    }
  }
  return slope;
}

// Curvature is believed in proportion to what is linear in the same places: what hardly moves a number hardly bends it.
// By how much, the runs themselves say, left out one by one.
void Response::fit(const std::vector<const SignatureRun*>& runs, const Eigen::MatrixXd& seen) {
  const auto n = static_cast<Eigen::Index>(runs.size()), t = static_cast<Eigen::Index>(simulated_terms_),
             d = static_cast<Eigen::Index>(uncertain_);
  Eigen::MatrixXd design(n, t);
  for (Eigen::Index r = 0; r < n; ++r) design.row(r) = basis(places_of(*runs[static_cast<std::size_t>(r)])).head(t);

  const std::vector<Eigen::Index> linear = linear_terms();
  Eigen::MatrixXd straight(n, static_cast<Eigen::Index>(linear.size()));
  for (std::size_t i = 0; i < linear.size(); ++i) straight.col(static_cast<Eigen::Index>(i)) = design.col(linear[i]);
  const Eigen::VectorXd loose = Eigen::VectorXd::Constant(straight.cols(), 1 / (kLinear * kLinear));
  const Fit first = fit_ridge(straight, seen, loose);
  const Eigen::MatrixXd moved = first.coefficients * first.sd.cwiseInverse().asDiagonal();
  Eigen::VectorXd size = Eigen::VectorXd::Zero(t);  // of each term, by the linear ones that it is made of
  for (std::size_t i = 0; i < linear.size(); ++i)
    size[linear[i]] =
        std::max(kLeastSize, moved.row(static_cast<Eigen::Index>(i)).norm() / std::sqrt(double(seen.cols())));
  Eigen::Index at = 1 + d;
  for (Eigen::Index k = 0; k < d; ++k)
    for (Eigen::Index l = 0; l <= k; ++l) size[at++] = std::sqrt(size[1 + k] * size[1 + l]);
  for (const std::size_t term : terms_of_) {
    if (term >= simulated_terms_) continue;
    const auto of = static_cast<Eigen::Index>(term);
    size[of + 1] = size[of];
    for (Eigen::Index k = 0; k < d; ++k) size[of + 2 + k] = std::sqrt(size[of] * size[1 + k]);
  }

  double least = INFINITY;
  for (const double bend : kBends) {
    Eigen::VectorXd precision = (bend * size).cwiseAbs2().cwiseInverse();
    for (const Eigen::Index term : linear) precision[term] = 1 / (kLinear * kLinear);
    precision[0] = 0;
    const Fit fit = fit_ridge(design, seen, precision);
    const double misfit = fit.left_out.array().log().sum();
    if (!(misfit < least)) continue;
    least = misfit;
    information_ = fit.information;
    coefficients_.topRows(t) = fit.coefficients;
    freedom_ = double(n) - fit.used;
  }
}

std::vector<Eigen::Index> Response::linear_terms() const {
  std::vector<Eigen::Index> linear;
  for (std::size_t k = 0; k <= uncertain_; ++k) linear.push_back(static_cast<Eigen::Index>(k));
  for (const std::size_t term : terms_of_)
    if (term < simulated_terms_) linear.push_back(static_cast<Eigen::Index>(term));
  return linear;
}

// Each run is its own twin: chance has no part in what an observer's error changes.
void Response::fit_observers(const std::vector<const SignatureRun*>& runs, const Eigen::MatrixXd& seen,
                             const std::vector<Suspect>& suspects, double span, double torque_unit) {
  const auto n = static_cast<Eigen::Index>(runs.size()), d = static_cast<Eigen::Index>(uncertain_);
  Eigen::MatrixXd design(n, 1 + d);
  for (Eigen::Index r = 0; r < n; ++r) {
    design(r, 0) = 1;
    for (Eigen::Index k = 0; k < d; ++k)
      design(r, 1 + k) = runs[static_cast<std::size_t>(r)]->uncertain[static_cast<std::size_t>(k)];
  }
  const Eigen::LDLT<Eigen::MatrixXd> normal(design.transpose() * design);
  std::size_t observer = 0;
  for (std::size_t s = 0; s < suspects.size(); ++s) {
    const Suspect& suspect = suspects[s];
    if (suspect.is_simulated()) continue;
    const auto first = static_cast<Eigen::Index>(terms_of_[s]);
    Eigen::MatrixXd slope(seen.rows(), seen.cols()), curve(seen.rows(), seen.cols());
    for (Eigen::Index r = 0; r < n; ++r) {
      const auto run = static_cast<std::size_t>(r);
      Eigen::VectorXd less, more;
      if (suspect.torque_offset != 0) {
        std::vector<double> shifted = observed_at(runs[run]->seen, span);
        const double offset = kObserved * suspect.torque_offset * torque_unit;
        shifted[0] += offset;
        shifted[1] += offset;
        more = features_.of_run(run, shifted);
        less = 2 * seen.row(r).transpose() - more;
      } else {
        less = features_.of_run(run, observed_at(runs[run]->misseen[2 * observer], span));
        more = features_.of_run(run, observed_at(runs[run]->misseen[2 * observer + 1], span));
      }
      const Eigen::VectorXd right = seen.row(r).transpose();
      slope.row(r) = (more - less).transpose() / (2 * kObserved);
      curve.row(r) = (more + less - 2 * right).transpose() / (2 * kObserved * kObserved);
    }
    const Eigen::MatrixXd fitted = normal.solve(design.transpose() * slope);
    coefficients_.row(first) = fitted.row(0);
    coefficients_.row(first + 1) = curve.colwise().mean();
    coefficients_.middleRows(first + 2, d) = fitted.bottomRows(d);
    if (suspect.torque_offset == 0) ++observer;
  }
}

void Response::whiten(const Eigen::MatrixXd& residuals) {
  Eigen::MatrixXd covariance = residuals.transpose() * residuals / double(residuals.rows());
  covariance.diagonal() *= 1 + 1e-6;
  // A feature that nothing moves, of a suspect that no number shows (a torque's offset without a torque), stays 0.
  const double least = 1e-9 * covariance.diagonal().maxCoeff();
  alive_ = static_cast<std::size_t>((covariance.diagonal().array() > least).count());
  covariance.diagonal().array() += least;
  lower_ = (covariance + features_.noise()).llt().matrixL();
  const Eigen::MatrixXd z = lower_.triangularView<Eigen::Lower>().solve(residuals.transpose());
  double sum = 0, square = 0;
  for (Eigen::Index r = 0; r < z.cols(); ++r) {
    const double log_chi2 = std::log(z.col(r).squaredNorm() / double(alive_));
    sum += log_chi2;
    square += log_chi2 * log_chi2;
  }
  const double n = double(z.cols());
  log_misfit_ = {sum / n, std::sqrt(std::max(square / n - sum * sum / (n * n), 1e-6))};
  // The logarithm of chi2 varies by 2 / n for normal numbers, by 2 / n + 2 / freedom for Student's.
  const double beyond = log_misfit_.sd * log_misfit_.sd - 2 / double(alive_);
  tail_freedom_ = std::clamp(beyond > 0 ? 2 / beyond : freedom_, std::min(kHeaviestTail, freedom_), freedom_);
  white_ = lower_.triangularView<Eigen::Lower>().solve(coefficients_.transpose());
}

Response::Expected Response::at(const Eigen::VectorXd& places) const {
  const Eigen::VectorXd b = basis(places), simulated = b.head(static_cast<Eigen::Index>(simulated_terms_));
  return {white_ * b, white_ * basis_slope(places), simulated.dot(information_ * simulated)};
}

Eigen::VectorXd Response::whitened(const std::vector<double>& observation) const {
  return lower_.triangularView<Eigen::Lower>().solve(features_.of(observation));
}

}  // namespace tumble::diagnose
