#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <vector>

#include "core/statistics.h"

namespace tumble::diagnose {

// A cheap stand-in for one observable of a noisy simulation: a polynomial of the parameters plus a smooth random
// deviation from it plus the runs' own scatter (universal kriging: Cressie 1993, section 3.4; Matern 5/2). Widths and
// scatter are found by restricted likelihood. Parameters are scaled to the unit cube.
class Emulator {
 public:
  // `typical_se`: what the runs say of their own standard error, a hint for the scatter; NaN where they say nothing.
  // Needs least_points(d) points.
  Emulator(std::vector<std::vector<double>> at, const std::vector<double>& values, double typical_se);
  static std::size_t least_points(std::size_t dimensions) { return dimensions + 3; }

  // The mean of many runs there, with the error of this guess of it.
  Estimate mean(const std::vector<double>& at) const;
  // Covariance of the guess's errors at two places.
  double error_covariance(const std::vector<double>& a, const std::vector<double>& b) const;
  // Standard deviation of a single run about that mean.
  double scatter() const { return scatter_; }

 private:
  Eigen::VectorXd basis(const std::vector<double>& at) const;
  Eigen::VectorXd covariances(const std::vector<double>& at) const;
  double correlation(const std::vector<double>& a, const std::vector<double>& b) const;
  bool factorise(const std::vector<double>& logs);
  double misfit(const std::vector<double>& logs, double log_hint);

  std::vector<std::vector<double>> at_;
  bool quadratic_ = false;
  double offset_ = 0, scale_ = 1, scatter_ = 0;
  double amplitude2_ = 0, noise2_ = 0;  // of the scaled values
  std::vector<double> widths_;
  Eigen::VectorXd values_, weights_, trend_;                    // scaled values; K^-1 (y - H b); b
  Eigen::MatrixXd basis_;                                       // H
  Eigen::LLT<Eigen::MatrixXd> covariance_, trend_information_;  // of K, of H' K^-1 H
  Eigen::MatrixXd solved_basis_;                                // K^-1 H
};

}  // namespace tumble::diagnose
