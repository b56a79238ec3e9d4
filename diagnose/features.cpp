#include "diagnose/features.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace tumble::diagnose {
namespace {

constexpr int kFolds = 10;
constexpr double kCopyWeight = 0.15;     // of a run that is seen wrongly, against one that is seen right
constexpr double kMostlyThere = 0.8;     // of the runs must show anything at all of a number: rare ones are not normal
constexpr Eigen::Index kPrincipal = 30;  // leading components of all numbers, for what no key and no suspect explains
constexpr double kTorqueError = 1;       // strength of the torque's offset in the copies

// Of the mean square of a number, added for every number: how much less is believed of what moves little.
constexpr std::array kRidges{0.003, 0.01, 0.03, 0.1, 0.3, 1.0, 3.0};

struct Row {
  std::size_t run;
  double weight;
  Eigen::VectorXd numbers, targets;
};

// Sums for weighted least squares, of one fold of runs.
struct Sums {
  Eigen::MatrixXd square, cross;  // of numbers; numbers x targets
  Eigen::VectorXd numbers, targets;
  double weight = 0;

  Sums(Eigen::Index m, Eigen::Index q)
      : square(Eigen::MatrixXd::Zero(m, m)),
        cross(Eigen::MatrixXd::Zero(m, q)),
        numbers(Eigen::VectorXd::Zero(m)),
        targets(Eigen::VectorXd::Zero(q)) {}
  void add(const Sums& s, double sign) {
    square += sign * s.square;
    cross += sign * s.cross;
    numbers += sign * s.numbers;
    targets += sign * s.targets;
    weight += sign * s.weight;
  }
};

struct Filter {
  Eigen::MatrixXd weights;
  Eigen::VectorXd offset;
};

// A ridge for each target.
Filter solve(const Sums& s, const Eigen::VectorXd& noise2, const std::vector<double>& ridges) {
  const Eigen::MatrixXd covariance = s.square / s.weight - s.numbers * s.numbers.transpose() / (s.weight * s.weight);
  const Eigen::MatrixXd cross = s.cross / s.weight - s.numbers * s.targets.transpose() / (s.weight * s.weight);
  Filter f;
  f.weights.resize(cross.rows(), cross.cols());
  for (const double ridge : kRidges) {
    bool used = false;
    for (const double r : ridges) used = used || r == ridge;
    if (!used) continue;
    Eigen::MatrixXd system = covariance;
    system.diagonal() += noise2 + Eigen::VectorXd::Constant(noise2.size(), ridge);
    const Eigen::LLT<Eigen::MatrixXd> factor(system);
    for (Eigen::Index t = 0; t < cross.cols(); ++t)
      if (ridges[static_cast<std::size_t>(t)] == ridge) f.weights.col(t) = factor.solve(cross.col(t));
  }
  f.offset = s.targets / s.weight - f.weights.transpose() * s.numbers / s.weight;
  return f;
}

}  // namespace

// A cubic in the span's logarithm through what the four spans show.
std::vector<double> observed_at(const Sight& sight, double span) {
  static_assert(kSpans.size() == 4 && kSpans[1] == 2 * kSpans[0] && kSpans[3] == 2 * kSpans[2]);
  const double x = std::isnan(span) ? 0 : std::clamp(std::log2(span / kSpans.front()), 0.0, 3.0);
  const std::array shares{-(x - 1) * (x - 2) * (x - 3) / 6, x * (x - 2) * (x - 3) / 2, -x * (x - 1) * (x - 3) / 2,
                          x * (x - 1) * (x - 2) / 6};
  std::vector<double> seen(sight.by_span.front().value.size(), 0);
  for (std::size_t k = 0; k < shares.size(); ++k)
    for (std::size_t i = 0; i < seen.size(); ++i) seen[i] += shares[k] * sight.by_span[k].value[i];
  return seen;
}

Features::Features(const std::vector<const SignatureRun*>& runs, const std::vector<Suspect>& suspects,
                   const std::vector<std::size_t>& chosen, const std::vector<double>& noise, double span,
                   double torque_unit) {
  std::vector<std::vector<double>> seen;
  for (const SignatureRun* run : runs) seen.push_back(observed_at(run->seen, span));
  std::vector<double> middle, scale, noise_of;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    double sum = 0, square = 0, there = 0, told = 0;
    for (const auto& s : seen) {
      if (std::isnan(s[chosen[i]])) continue;
      told += 1;
      sum += s[chosen[i]];
      square += s[chosen[i]] * s[chosen[i]];
      there += std::abs(s[chosen[i]]) > 1e-12;
    }
    const double mean = sum / told, variance = square / told - mean * mean;
    if (!(there >= kMostlyThere * double(runs.size())) || !(variance > 1e-18 * std::max(1.0, mean * mean))) continue;
    chosen_.push_back(chosen[i]);
    middle.push_back(mean);
    scale.push_back(std::sqrt(variance));
    noise_of.push_back(noise[i] / scale.back());
  }
  const auto m = static_cast<Eigen::Index>(chosen_.size());
  middle_ = Eigen::Map<Eigen::VectorXd>(middle.data(), m);
  scale_ = Eigen::Map<Eigen::VectorXd>(scale.data(), m);
  const Eigen::VectorXd noise2 = Eigen::Map<Eigen::VectorXd>(noise_of.data(), m).cwiseAbs2();

  const auto keys = static_cast<Eigen::Index>(runs.front()->uncertain.size());
  const Eigen::Index q = keys + static_cast<Eigen::Index>(suspects.size());
  std::vector<Sums> folds(kFolds, Sums(m, q));
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const SignatureRun& run = *runs[r];
    Eigen::VectorXd target = Eigen::VectorXd::Zero(q);
    for (Eigen::Index k = 0; k < keys; ++k) target[k] = run.uncertain[static_cast<std::size_t>(k)];
    if (run.suspect >= 0) target[keys + run.suspect] = run.strength;
    std::vector<Eigen::VectorXd> numbers{scaled(seen[r])}, targets{target};
    std::size_t observer = 0;
    for (std::size_t s = 0; s < suspects.size(); ++s) {
      if (suspects[s].is_simulated()) continue;
      for (const int side : {0, 1}) {
        Eigen::VectorXd wrong = target;
        const double sign = side == 0 ? -1 : 1;
        if (suspects[s].torque_offset != 0) {
          std::vector<double> shifted = seen[r];
          const double offset = sign * kTorqueError * suspects[s].torque_offset * torque_unit;
          shifted[0] += offset;
          shifted[1] += offset;
          wrong[keys + static_cast<Eigen::Index>(s)] += sign * kTorqueError;
          numbers.push_back(scaled(shifted));
        } else {
          wrong[keys + static_cast<Eigen::Index>(s)] += sign * kObserved;
          numbers.push_back(scaled(observed_at(run.misseen[2 * observer + static_cast<std::size_t>(side)], span)));
        }
        targets.push_back(wrong);
      }
      if (suspects[s].torque_offset == 0) ++observer;
    }
    const auto rows = static_cast<Eigen::Index>(numbers.size());
    Eigen::MatrixXd y(m, rows), t(q, rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const double root = i == 0 ? 1 : std::sqrt(kCopyWeight);
      y.col(i) = root * numbers[static_cast<std::size_t>(i)];
      t.col(i) = root * targets[static_cast<std::size_t>(i)];
    }
    Sums& fold = folds[r % kFolds];
    fold.square.selfadjointView<Eigen::Lower>().rankUpdate(y);
    fold.cross += y * t.transpose();
    for (Eigen::Index i = 0; i < rows; ++i) {
      const double weight = i == 0 ? 1 : kCopyWeight, root = std::sqrt(weight);
      fold.numbers += y.col(i) * root;
      fold.targets += t.col(i) * root;
      fold.weight += weight;
    }
  }
  Sums all(m, q);
  for (Sums& fold : folds) {
    fold.square = fold.square.selfadjointView<Eigen::Lower>();
    all.add(fold, 1);
  }

  // How much to believe of small numbers: so that runs left out are told best.
  std::vector<double> best(static_cast<std::size_t>(q), kRidges.back()), least(static_cast<std::size_t>(q), INFINITY);
  for (const double ridge : kRidges) {
    Eigen::VectorXd misfit = Eigen::VectorXd::Zero(q);
    for (int f = 0; f < kFolds; ++f) {
      Sums rest = all;
      rest.add(folds[static_cast<std::size_t>(f)], -1);
      const Filter filter = solve(rest, noise2, std::vector<double>(static_cast<std::size_t>(q), ridge));
      // Sum over the fold of (t - b - w y)^2, from its sums.
      const Sums& out = folds[static_cast<std::size_t>(f)];
      for (Eigen::Index t = 0; t < q; ++t) {
        const Eigen::VectorXd& w = filter.weights.col(t);
        const double b = filter.offset[t];
        misfit[t] += w.dot(out.square * w) + b * b * out.weight + 2 * b * w.dot(out.numbers) -
                     2 * w.dot(out.cross.col(t)) - 2 * b * out.targets[t];
      }
    }
    for (Eigen::Index t = 0; t < q; ++t)
      if (misfit[t] < least[static_cast<std::size_t>(t)])
        least[static_cast<std::size_t>(t)] = misfit[t], best[static_cast<std::size_t>(t)] = ridge;
  }
  const Filter filter = solve(all, noise2, best);
  filters_ = filter.weights;
  offset_ = filter.offset;
  for (int f = 0; f < kFolds; ++f) {
    Sums rest = all;
    rest.add(folds[static_cast<std::size_t>(f)], -1);
    Filter own = solve(rest, noise2, best);
    fold_filters_.push_back(std::move(own.weights));
    fold_offset_.push_back(std::move(own.offset));
  }
  append_principal(all.square / all.weight - all.numbers * all.numbers.transpose() / (all.weight * all.weight));
  noise_ = filters_.transpose() * noise2.asDiagonal() * filters_;
}

void Features::append_principal(const Eigen::MatrixXd& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(covariance);
  const Eigen::Index k = std::min(kPrincipal, covariance.rows());
  const Eigen::MatrixXd leading = eigen.eigenvectors().rightCols(k);
  const auto append = [&](Eigen::MatrixXd& filters, Eigen::VectorXd& offset) {
    filters.conservativeResize(Eigen::NoChange, filters.cols() + k);
    filters.rightCols(k) = leading;
    offset.conservativeResize(offset.size() + k);
    offset.tail(k).setZero();
  };
  append(filters_, offset_);
  for (std::size_t f = 0; f < fold_filters_.size(); ++f) append(fold_filters_[f], fold_offset_[f]);
}

Eigen::VectorXd Features::scaled(const std::vector<double>& observation) const {
  Eigen::VectorXd y(static_cast<Eigen::Index>(chosen_.size()));
  for (std::size_t i = 0; i < chosen_.size(); ++i) y[static_cast<Eigen::Index>(i)] = observation[chosen_[i]];
  // What a run happens not to tell is taken as it mostly is.
  return (y - middle_).cwiseQuotient(scale_).unaryExpr([](double v) { return std::isnan(v) ? 0.0 : v; });
}

Eigen::VectorXd Features::of(const std::vector<double>& observation) const {
  return filters_.transpose() * scaled(observation) + offset_;
}

Eigen::VectorXd Features::of_run(std::size_t run, const std::vector<double>& observation) const {
  const std::size_t fold = run % kFolds;
  return fold_filters_[fold].transpose() * scaled(observation) + fold_offset_[fold];
}

}  // namespace tumble::diagnose
