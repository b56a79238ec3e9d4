#pragma once
#include <Eigen/Core>
#include <vector>

#include "diagnose/features.h"

// How a condition's features depend on what is uncertain and on the suspects' strengths, and how far chance carries one
// run from that: a polynomial fitted to the library, and the scatter about it.
namespace tumble::diagnose {

class Response {
 public:
  // As Features.
  Response(const std::vector<const SignatureRun*>& runs, const std::vector<Suspect>& suspects,
           const std::vector<std::size_t>& chosen, const std::vector<double>& noise, double span, double torque_unit);

  // In units of what chance does to one run of the library's length, without correlation: the features' mean at these
  // places [standard deviations; strengths] and its slopes along them.
  struct Expected {
    Eigen::VectorXd mean;
    Eigen::MatrixXd slope;  // features x (uncertain keys, then suspects)
    double guess = 0;       // variance of the mean's error, alike in all directions
  };
  Expected at(const Eigen::VectorXd& places) const;

  Eigen::VectorXd whitened(const std::vector<double>& observation) const;  // features in the same units
  const Features& features() const { return features_; }

  // ln of chi2 per feature, of the library's runs about the polynomial.
  struct Spread {
    double mean = 0, sd = 1;
  };
  const Spread& log_misfit() const { return log_misfit_; }
  std::size_t numbers() const { return alive_; }  // features, but for those that nothing moves
  std::size_t uncertain() const { return uncertain_; }
  double revolutions() const { return revolutions_; }  // of a run, on average
  double freedom() const { return freedom_; }          // degrees of freedom that the scatter is known by
  // Of the multivariate Student's t that one run's numbers follow about their mean: charges pack and lock in ways of
  // their own, so some runs lie farther off in all their numbers than others.
  double tail_freedom() const { return tail_freedom_; }

 private:
  Eigen::VectorXd places_of(const SignatureRun& run) const;
  Eigen::VectorXd basis(const Eigen::VectorXd& places) const;
  Eigen::MatrixXd basis_slope(const Eigen::VectorXd& places) const;
  void fit(const std::vector<const SignatureRun*>& runs, const Eigen::MatrixXd& seen);
  void fit_observers(const std::vector<const SignatureRun*>& runs, const Eigen::MatrixXd& seen,
                     const std::vector<Suspect>& suspects, double span, double torque_unit);
  std::vector<Eigen::Index> linear_terms() const;
  void whiten(const Eigen::MatrixXd& residuals);

  Features features_;
  std::size_t uncertain_ = 0;
  std::vector<std::size_t> terms_of_;  // first term of each suspect
  std::size_t simulated_terms_ = 0, terms_ = 0;
  double revolutions_ = 0;
  double freedom_ = 0, tail_freedom_ = 0;
  std::size_t alive_ = 0;
  Spread log_misfit_;
  Eigen::MatrixXd coefficients_;  // terms x features
  Eigen::MatrixXd information_;   // inverse, of the simulated terms
  Eigen::MatrixXd lower_;         // Cholesky factor of one run's covariance
  Eigen::MatrixXd white_;         // features x terms: coefficients, whitened
};

}  // namespace tumble::diagnose
