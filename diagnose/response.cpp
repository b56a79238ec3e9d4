#include "diagnose/response.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace tumble::diagnose {
namespace {

// How far the terms of the polynomial may move a number, before any run speaks [standard deviations of one run]: what
// is linear almost freely, curvature by less.
constexpr double kLinear = 30, kCurved = 3;
constexpr double kHalf = 0.5;  // strength of the library's observers
constexpr int kFolds = 4;
constexpr double kMostOwnShare = 0.95;

// Of a chance covariance from few runs: so much of the correlation is dropped.
constexpr std::array kShrinkage{0.02, 0.05, 0.1, 0.2, 0.35, 0.5, 0.7};

Eigen::MatrixXd shrunk(const Eigen::MatrixXd& correlation, double share) {
  Eigen::MatrixXd c = (1 - share) * correlation;
  c.diagonal().setOnes();
  return c;
}

// That with which residuals left out are likeliest.
double best_shrinkage(const Eigen::MatrixXd& residuals) {
  double best = kShrinkage.back(), most = -INFINITY;
  const auto n = residuals.rows();
  for (const double share : kShrinkage) {
    double sum = 0;
    for (int fold = 0; fold < kFolds; ++fold) {
      std::vector<Eigen::Index> in, out;
      for (Eigen::Index i = 0; i < n; ++i) (i % kFolds == fold ? out : in).push_back(i);
      const Eigen::MatrixXd a = residuals(in, Eigen::all), b = residuals(out, Eigen::all);
      const Eigen::LLT<Eigen::MatrixXd> factor(shrunk(a.transpose() * a / double(in.size()), share));
      if (factor.info() != Eigen::Success) {
        sum = -INFINITY;
        break;
      }
      sum -= factor.matrixL().solve(b.transpose()).squaredNorm() / 2 +
             double(out.size()) * factor.matrixLLT().diagonal().array().log().sum();
    }
    if (sum > most) most = sum, best = share;
  }
  return best;
}

}  // namespace

std::vector<double> observed_at(const Sight& sight, double span) {
  std::size_t next = 1;
  while (next + 1 < kSpans.size() && kSpans[next] < span) ++next;
  const double share = std::clamp((span - kSpans[next - 1]) / (kSpans[next] - kSpans[next - 1]), 0.0, 1.0);
  std::vector<double> seen = sight.by_span[next - 1].value;
  for (std::size_t i = 0; i < seen.size(); ++i) seen[i] += share * (sight.by_span[next].value[i] - seen[i]);
  return seen;
}

Response::Response(const std::vector<const SignatureRun*>& runs, const std::vector<Suspect>& suspects,
                   std::vector<std::size_t> chosen, const std::vector<double>& noise, double span)
    : chosen_(std::move(chosen)), uncertain_(runs.front()->uncertain.size()) {
  const std::size_t d = uncertain_;
  simulated_terms_ = 1 + d + d * (d + 1) / 2;
  terms_of_.resize(suspects.size());
  for (std::size_t s = 0; s < suspects.size(); ++s)
    if (suspects[s].is_simulated()) terms_of_[s] = simulated_terms_, simulated_terms_ += 2 + d;
  terms_ = simulated_terms_;
  for (std::size_t s = 0; s < suspects.size(); ++s)
    if (!suspects[s].is_simulated()) terms_of_[s] = terms_, terms_ += 2 + d;

  Eigen::MatrixXd seen(static_cast<Eigen::Index>(runs.size()), static_cast<Eigen::Index>(chosen_.size()));
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const std::vector<double> all = observed_at(runs[r]->seen, span);
    for (std::size_t i = 0; i < chosen_.size(); ++i)
      seen(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(i)) = all[chosen_[i]];
    revolutions_ += runs[r]->revolutions / double(runs.size());
  }
  coefficients_ = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(terms_), seen.cols());
  fit(runs, seen);
  fit_observers(runs, seen, suspects, span);

  Eigen::MatrixXd rest = seen;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const Eigen::VectorXd b = basis(places_of(*runs[r])),
                          simulated = b.head(static_cast<Eigen::Index>(simulated_terms_));
    // The fit bends towards each run, the more the fewer there are like it.
    const double own_share = std::min(simulated.dot(information_ * simulated), kMostOwnShare);
    rest.row(static_cast<Eigen::Index>(r)) -= (b.transpose() * coefficients_).eval();
    rest.row(static_cast<Eigen::Index>(r)) /= std::sqrt(1 - own_share);
  }
  whiten(rest, noise);
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

void Response::fit(const std::vector<const SignatureRun*>& runs, const Eigen::MatrixXd& seen) {
  const auto n = static_cast<Eigen::Index>(runs.size()), t = static_cast<Eigen::Index>(simulated_terms_),
             d = static_cast<Eigen::Index>(uncertain_);
  Eigen::MatrixXd design(n, t);
  for (Eigen::Index r = 0; r < n; ++r) {
    design.row(r) = basis(places_of(*runs[static_cast<std::size_t>(r)])).head(t);
  }
  Eigen::VectorXd precision = Eigen::VectorXd::Constant(t, 1 / (kCurved * kCurved));
  precision[0] = 0;
  precision.segment(1, d).setConstant(1 / (kLinear * kLinear));
  for (std::size_t s = 0; s < terms_of_.size(); ++s)
    if (terms_of_[s] < simulated_terms_) precision[static_cast<Eigen::Index>(terms_of_[s])] = 1 / (kLinear * kLinear);
  Eigen::MatrixXd information = design.transpose() * design;
  information.diagonal() += precision;
  information_ = information.ldlt().solve(Eigen::MatrixXd::Identity(t, t));
  coefficients_.topRows(t) = information_ * (design.transpose() * seen);
}

// Each run is its own twin: chance has no part in what an observer's error changes.
void Response::fit_observers(const std::vector<const SignatureRun*>& runs, const Eigen::MatrixXd& seen,
                             const std::vector<Suspect>& suspects, double span) {
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
    if (suspect.torque_offset != 0) {
      const double torque = coefficients_(0, 0);  // at MILL.toml's values
      for (std::size_t i = 0; i < chosen_.size(); ++i)
        if (chosen_[i] < 2) coefficients_(first, static_cast<Eigen::Index>(i)) = suspect.torque_offset * torque;
      continue;
    }
    Eigen::MatrixXd slope(seen.rows(), seen.cols()), curve(seen.rows(), seen.cols());
    for (Eigen::Index r = 0; r < n; ++r) {
      const SignatureRun& run = *runs[static_cast<std::size_t>(r)];
      const std::vector<double> less = observed_at(run.misseen[2 * observer], span),
                                more = observed_at(run.misseen[2 * observer + 1], span);
      for (std::size_t i = 0; i < chosen_.size(); ++i) {
        const auto c = static_cast<Eigen::Index>(i);
        const double up = more[chosen_[i]] - seen(r, c), down = less[chosen_[i]] - seen(r, c);
        slope(r, c) = (up - down) / (2 * kHalf);
        curve(r, c) = (up + down) / (2 * kHalf * kHalf);
      }
    }
    const Eigen::MatrixXd fitted = normal.solve(design.transpose() * slope);
    coefficients_.row(first) = fitted.row(0);
    coefficients_.row(first + 1) = curve.colwise().mean();
    coefficients_.middleRows(first + 2, d) = fitted.bottomRows(d);
    ++observer;
  }
}

void Response::whiten(const Eigen::MatrixXd& residuals, const std::vector<double>& noise) {
  const auto freedom = double(residuals.rows());
  Eigen::VectorXd sd = (residuals.colwise().squaredNorm() / freedom).cwiseSqrt();
  for (Eigen::Index i = 0; i < sd.size(); ++i) sd[i] = std::max(sd[i], 1e-12);
  const Eigen::MatrixXd scaled = residuals * sd.cwiseInverse().asDiagonal();
  const double share = best_shrinkage(scaled);
  Eigen::MatrixXd covariance = sd.asDiagonal() * shrunk(scaled.transpose() * scaled / freedom, share) * sd.asDiagonal();
  for (Eigen::Index i = 0; i < sd.size(); ++i)
    covariance(i, i) += std::pow(noise[static_cast<std::size_t>(i)], 2) + 1e-6 * sd[i] * sd[i];
  lower_ = covariance.llt().matrixL();
  const Eigen::MatrixXd white = lower_.triangularView<Eigen::Lower>().solve(coefficients_.transpose());
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(white);
  const auto rank = std::min(white.rows(), white.cols());
  span_ = qr.householderQ() * Eigen::MatrixXd::Identity(white.rows(), rank);
  within_ = span_.transpose() * white;
}

Response::Expected Response::at(const Eigen::VectorXd& places) const {
  const Eigen::VectorXd b = basis(places), simulated = b.head(static_cast<Eigen::Index>(simulated_terms_));
  return {within_ * b, within_ * basis_slope(places), simulated.dot(information_ * simulated)};
}

Eigen::VectorXd Response::white(const std::vector<double>& observation) const {
  Eigen::VectorXd y(static_cast<Eigen::Index>(chosen_.size()));
  for (std::size_t i = 0; i < chosen_.size(); ++i) y[static_cast<Eigen::Index>(i)] = observation[chosen_[i]];
  return lower_.triangularView<Eigen::Lower>().solve(y);
}

Eigen::VectorXd Response::whitened(const std::vector<double>& observation) const {
  return span_.transpose() * white(observation);
}

double Response::outside(const std::vector<double>& observation) const {
  const Eigen::VectorXd all = white(observation);
  return std::max(0.0, all.squaredNorm() - (span_.transpose() * all).squaredNorm());
}

std::vector<double> Response::mean_observation(const Eigen::VectorXd& places) const {
  const Eigen::VectorXd mean = coefficients_.transpose() * basis(places);
  return {mean.data(), mean.data() + mean.size()};
}

std::vector<double> Response::scatter() const {
  const Eigen::VectorXd sd = lower_.rowwise().norm();
  return {sd.data(), sd.data() + sd.size()};
}

}  // namespace tumble::diagnose
