#include "diagnose/fit.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/angle.h"
#include "core/error.h"
#include "core/parallel_for.h"
#include "core/random.h"
#include "diagnose/design.h"
#include "diagnose/emulator.h"
#include "diagnose/minimum.h"

namespace tumble::diagnose {
namespace {

constexpr std::array kShares{0.4, 0.3, 0.3};  // of the simulations, round by round
constexpr double kReach = 5;                  // half width of a later round's box [standard errors]
constexpr double kNarrowest = 0.2;            // [of the range]: an emulator needs some slope to see
constexpr std::size_t kLooks = 512;           // places where the misfit is tried before it is followed down
constexpr std::size_t kStarts = 6;
constexpr int kMostCalls = 2000;
constexpr double kSlopeStep = 0.02;      // [of the range]
constexpr double kUndetermined = 0.2;    // standard error [of the range]; a flat guess has 0.29
constexpr double kFlatInformation = 12;  // of a flat distribution over the range: 1 / variance
constexpr double kSignificance = 1.645;  // of a normal deviate, 5 % to one side

using Point = std::vector<double>;  // in shares of the ranges

struct Sample {  // what one run says of one target
  Point at;
  double value, se;
};

double square(double x) { return x * x; }

class Fitter {
 public:
  Fitter(const FitProblem& problem, const Simulate& simulate)
      : problem_(problem), simulate_(simulate), random_(problem.seed), samples_(problem.targets.size()) {}

  Fit run() {
    const std::size_t each = problem_.simulations / problem_.experiments;
    Point low(dimensions(), 0.0), high(dimensions(), 1.0);
    std::size_t done = 0;
    for (std::size_t round = 0; round < kShares.size(); ++round) {
      const bool last = round + 1 == kShares.size();
      const auto share = static_cast<std::size_t>(std::lround(kShares[round] * double(each)));
      const std::size_t points = last ? each - done : std::max(share, round == 0 ? least_points() : 1);
      ask(std::min(points, each - done), low, high);
      done += std::min(points, each - done);
      emulate();
      find_best();
      for (std::size_t k = 0; k < dimensions(); ++k) {
        const double half = std::clamp(kReach * std::sqrt(covariance_(index(k), index(k))), kNarrowest / 2, 0.5);
        low[k] = std::clamp(best_[k] - half, 0.0, 1 - 2 * half);
        high[k] = low[k] + 2 * half;
      }
    }
    return result();
  }

 private:
  static Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }
  std::size_t dimensions() const { return problem_.keys.size(); }
  std::size_t least_points() const { return Emulator::least_points(dimensions()); }

  // Each experiment has points of its own, so that the emulators' errors are independent.
  void ask(std::size_t points, const Point& low, const Point& high) {
    std::vector<Trial> trials;
    std::vector<Point> at;
    for (std::size_t e = 0; e < problem_.experiments; ++e)
      for (Point& p : latin_hypercube(points, dimensions(), random_)) {
        Trial trial{e, {}, 1 + random_.below(1'000'000'000)};
        for (std::size_t k = 0; k < dimensions(); ++k) {
          p[k] = low[k] + (high[k] - low[k]) * p[k];
          trial.at.push_back(value_of(k, p[k]));
        }
        trials.push_back(std::move(trial));
        at.push_back(std::move(p));
      }
    const auto results = simulate_(trials);
    for (std::size_t i = 0; i < trials.size(); ++i) {
      std::size_t of_experiment = 0;
      for (std::size_t t = 0; t < problem_.targets.size(); ++t) {
        const FitTarget& target = problem_.targets[t];
        if (target.experiment != trials[i].experiment) continue;
        const Estimate& e = results[i][of_experiment++];
        if (std::isnan(e.value)) continue;
        const double m = target.measured.value;
        samples_[t].push_back({at[i], target.is_direction ? m + wrap_180(e.value - m) : e.value, e.se});
      }
    }
  }

  double value_of(std::size_t k, double share) const {
    const FitKey& key = problem_.keys[k];
    return key.low + share * (key.high - key.low);
  }

  void emulate() {
    emulators_.clear();
    emulators_.resize(samples_.size());
    parallel_for(samples_.size(), 1, [&](std::size_t t, std::size_t) {
      const auto& samples = samples_[t];
      if (samples.size() < least_points()) return;
      std::vector<Point> at;
      std::vector<double> values;
      double sum = 0, count = 0;
      for (const Sample& s : samples) {
        at.push_back(s.at);
        values.push_back(s.value);
        if (s.se > 0) sum += s.se * s.se, ++count;
      }
      emulators_[t].emplace(std::move(at), values, count > 0 ? std::sqrt(sum / count) : kNotGiven);
    });
    if (std::none_of(emulators_.begin(), emulators_.end(), [](const auto& e) { return e.has_value(); }))
      throw WorkError("calibration", "too few runs gave numbers to fit; see runs.csv for what went wrong");
  }

  // Variance of measured - emulated.
  double variance(std::size_t t, const Estimate& emulated) const {
    const FitTarget& target = problem_.targets[t];
    const double measured = std::isnan(target.measured.se) ? emulators_[t]->scatter() : target.measured.se;
    return square(measured) + square(target.model_sd) + square(emulated.se);
  }

  double prior_deviation(std::size_t k, double share) const {
    const FitKey& key = problem_.keys[k];
    return key.prior_sd > 0 ? (value_of(k, share) - key.prior) / key.prior_sd : 0;
  }

  double chi2(const Point& p) const {
    double sum = 0;
    for (std::size_t t = 0; t < emulators_.size(); ++t) {
      if (!emulators_[t]) continue;
      const Estimate e = emulators_[t]->mean(p);
      sum += square(problem_.targets[t].measured.value - e.value) / variance(t, e);
    }
    for (std::size_t k = 0; k < dimensions(); ++k) sum += square(prior_deviation(k, p[k]));
    return sum;
  }

  // -2 ln of the likelihood: where an emulator is unsure, a small chi2 is worth less.
  double misfit(const Point& p) const {
    double sum = chi2(p);
    for (std::size_t t = 0; t < emulators_.size(); ++t)
      if (emulators_[t]) sum += std::log(variance(t, emulators_[t]->mean(p)));
    return sum;
  }

  void find_best() {
    Random random(problem_.seed);
    std::vector<Point> looks = latin_hypercube(kLooks, dimensions(), random);
    if (!best_.empty()) looks.push_back(best_);
    std::vector<std::pair<double, std::size_t>> order(looks.size());
    parallel_for(looks.size(), 16, [&](std::size_t from, std::size_t to) {
      for (std::size_t i = from; i < to; ++i) order[i] = {misfit(looks[i]), i};
    });
    std::sort(order.begin(), order.end());
    const Box cube{Point(dimensions(), 0.0), Point(dimensions(), 1.0)};
    std::vector<Point> ends(std::min(kStarts, order.size()));
    std::vector<double> found(ends.size());
    parallel_for(ends.size(), 1, [&](std::size_t i, std::size_t) {
      ends[i] = minimum_near([&](const Point& p) { return misfit(p); }, looks[order[i].second], cube, 1e-5, kMostCalls);
      found[i] = misfit(ends[i]);
    });
    best_ = ends[static_cast<std::size_t>(std::min_element(found.begin(), found.end()) - found.begin())];
    find_covariance();
  }

  // Gauss and Newton's: from the slopes of what is emulated. Slopes are known with an error, whose square would count
  // as information and make the standard errors too small where keys trade off against each other: it is taken off.
  // The range itself is knowledge: where the data say nothing, its flat distribution's standard deviation is left.
  void find_covariance() {
    const auto d = index(dimensions());
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(d, d);
    std::vector<Point> below, above;
    for (std::size_t k = 0; k < dimensions(); ++k) {
      below.push_back(best_);
      above.push_back(best_);
      below[k][k] = std::max(0.0, best_[k] - kSlopeStep);
      above[k][k] = std::min(1.0, best_[k] + kSlopeStep);
    }
    for (std::size_t t = 0; t < emulators_.size(); ++t) {
      if (!emulators_[t]) continue;
      const Emulator& e = *emulators_[t];
      const double weight = 1 / variance(t, e.mean(best_));
      for (std::size_t k = 0; k < dimensions(); ++k)
        for (std::size_t l = 0; l < dimensions(); ++l) {
          const double step2 = (above[k][k] - below[k][k]) * (above[l][l] - below[l][l]);
          const double product =
              (e.mean(above[k]).value - e.mean(below[k]).value) * (e.mean(above[l]).value - e.mean(below[l]).value);
          const double error = e.error_covariance(above[k], above[l]) - e.error_covariance(above[k], below[l]) -
                               e.error_covariance(below[k], above[l]) + e.error_covariance(below[k], below[l]);
          information(index(k), index(l)) += weight * (product - error) / step2;
        }
    }
    for (std::size_t k = 0; k < dimensions(); ++k) {
      const FitKey& key = problem_.keys[k];
      if (key.prior_sd > 0) information(index(k), index(k)) += square((key.high - key.low) / key.prior_sd);
    }
    // What was taken off may leave less than nothing in a direction that the data do not see.
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(information);
    const Eigen::VectorXd inverse = (solver.eigenvalues().cwiseMax(0).array() + kFlatInformation).inverse();
    covariance_ = solver.eigenvectors() * inverse.asDiagonal() * solver.eigenvectors().transpose();
  }

  Fit result() const {
    Fit fit;
    fit.chi2 = chi2(best_);
    double data = 0;
    for (std::size_t t = 0; t < emulators_.size(); ++t) {
      fit.emulated.push_back(emulators_[t] ? emulators_[t]->mean(best_) : Estimate{});
      if (emulators_[t])
        ++data;
      else
        fit.notes.push_back(problem_.targets[t].name + " had no part in the fit: too few runs have it");
    }
    for (const FitKey& key : problem_.keys) data += key.prior_sd > 0;
    const double dof = fit.degrees_of_freedom = data - double(dimensions());
    // Wilson & Hilferty (1931): the cube root of chi2 is nearly normal.
    if (dof > 0)
      fit.misfit = (std::cbrt(fit.chi2 / dof) - (1 - 2 / (9 * dof))) / std::sqrt(2 / (9 * dof)) > kSignificance;
    else
      fit.notes.push_back("there are no more data than fitted keys: how well the model fits cannot be told");
    const double wider = fit.misfit ? std::sqrt(fit.chi2 / dof) : 1;

    for (std::size_t k = 0; k < dimensions(); ++k) {
      const FitKey& key = problem_.keys[k];
      FittedKey fitted{key, {value_of(k, best_[k]), kNotGiven}, false, false};
      const double se = wider * std::sqrt(covariance_(index(k), index(k)));
      fitted.value.se = se * (key.high - key.low);
      fitted.undetermined = se > kUndetermined;
      fitted.at_bound = best_[k] < 1e-3 || best_[k] > 1 - 1e-3;
      if (fitted.at_bound)
        fit.notes.push_back(fmt::format("{} ends at {:.4g}, the end of its range: the best value may lie beyond it",
                                        key.key, fitted.value.value));
      if (fitted.undetermined)
        fit.notes.push_back(
            fmt::format("{} is not determined by these data: its standard error is {:.2g} of the range", key.key, se));
      fit.keys.push_back(std::move(fitted));
    }
    for (Eigen::Index i = 0; i < covariance_.rows(); ++i)
      for (Eigen::Index j = 0; j < covariance_.cols(); ++j)
        fit.correlation.push_back(covariance_(i, j) / std::sqrt(covariance_(i, i) * covariance_(j, j)));
    return fit;
  }

  const FitProblem& problem_;
  const Simulate& simulate_;
  Random random_;
  std::vector<std::vector<Sample>> samples_;
  std::vector<std::optional<Emulator>> emulators_;
  Point best_;
  Eigen::MatrixXd covariance_;  // of best_
};

}  // namespace

std::size_t default_simulations(std::size_t keys, std::size_t experiments) {
  return experiments * (3 * (keys + 1) * (keys + 2) / 2 + 6 * keys);
}

std::size_t least_simulations(std::size_t keys, std::size_t experiments) {
  return experiments * Emulator::least_points(keys);
}

Fit fit(const FitProblem& problem, const Simulate& simulate) { return Fitter(problem, simulate).run(); }

}  // namespace tumble::diagnose
