#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "diagnose/library.h"

// How all that is observed of a mill in one condition depends on what is uncertain and on the suspects' strengths, and
// how far chance carries one run from that: a polynomial fitted to the library, and the scatter about it.
namespace tumble::diagnose {

// What a run of the library shows to a film of this span.
std::vector<double> observed_at(const Sight& sight, double span);

class Response {
 public:
  // `runs`: of this condition, those that failed left out. `chosen`: which numbers of an observation there are;
  // `noise`: how uncertain each was measured, beside chance.
  Response(const std::vector<const SignatureRun*>& runs, const std::vector<Suspect>& suspects,
           std::vector<std::size_t> chosen, const std::vector<double>& noise, double span);

  // In units of what chance does to one run of the library's length, without correlation: the numbers' mean at these
  // places [standard deviations; strengths] and its slopes along them.
  struct Expected {
    Eigen::VectorXd mean;
    Eigen::MatrixXd slope;  // numbers x (uncertain keys, then suspects)
    double guess = 0;       // variance of the mean's error, alike in all directions
  };
  Expected at(const Eigen::VectorXd& places) const;

  Eigen::VectorXd whitened(const std::vector<double>& observation) const;  // in the same units
  double outside(const std::vector<double>& observation) const;            // squared length that no change explains
  std::size_t numbers() const { return chosen_.size(); }
  std::size_t uncertain() const { return uncertain_; }
  std::size_t suspects() const { return terms_of_.size(); }
  double revolutions() const { return revolutions_; }  // of a run, on average

  // Numbers as they would be observed, in their own units, and one run's scatter.
  std::vector<double> mean_observation(const Eigen::VectorXd& places) const;
  std::vector<double> scatter() const;

 private:
  Eigen::VectorXd places_of(const SignatureRun& run) const;
  Eigen::VectorXd white(const std::vector<double>& observation) const;
  Eigen::VectorXd basis(const Eigen::VectorXd& places) const;
  Eigen::MatrixXd basis_slope(const Eigen::VectorXd& places) const;
  void fit(const std::vector<const SignatureRun*>& runs, const Eigen::MatrixXd& seen);
  void fit_observers(const std::vector<const SignatureRun*>& runs, const Eigen::MatrixXd& seen,
                     const std::vector<Suspect>& suspects, double span);
  void whiten(const Eigen::MatrixXd& residuals, const std::vector<double>& noise);

  std::vector<std::size_t> chosen_;
  std::size_t uncertain_ = 0;
  std::vector<std::size_t> terms_of_;  // first term of each suspect
  std::size_t simulated_terms_ = 0, terms_ = 0;
  double revolutions_ = 0;
  Eigen::MatrixXd coefficients_;  // terms x numbers
  Eigen::MatrixXd information_;   // inverse, of the simulated terms
  Eigen::MatrixXd lower_;         // Cholesky factor of one run's covariance
  Eigen::MatrixXd span_;          // orthonormal, numbers x terms: all that the model can move, whitened
  Eigen::MatrixXd within_;        // terms x terms: coefficients, whitened, in that basis
};

}  // namespace tumble::diagnose
