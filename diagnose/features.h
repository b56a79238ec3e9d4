#pragma once
#include <Eigen/Core>
#include <vector>

#include "diagnose/library.h"

// A condition's numbers boiled down: of each uncertain key and of each suspect's strength, what the numbers by
// themselves say it is. Such estimates, by regression on simulations, are all of the data that a likelihood of few
// dimensions needs (Fearnhead & Prangle, J. R. Stat. Soc. B 74 (2012) 419), and unlike hundreds of numbers they have a
// covariance that hundreds of runs can tell. Beside them the leading principal components of all numbers: what neither
// key nor suspect explains shows there.
namespace tumble::diagnose {

// What a run of the library shows to a film of this span.
std::vector<double> observed_at(const Sight& sight, double span);

class Features {
 public:
  // `runs`: of this condition, those that failed left out. `chosen`: which numbers of an observation there are; those
  // that the library cannot tell of are dropped. `noise`: how uncertain each was measured, beside chance.
  // `torque_unit`: of offsets of the torque [N m of one slice].
  Features(const std::vector<const SignatureRun*>& runs, const std::vector<Suspect>& suspects,
           const std::vector<std::size_t>& chosen, const std::vector<double>& noise, double span, double torque_unit);

  Eigen::Index count() const { return filters_.cols(); }
  const std::vector<std::size_t>& chosen() const { return chosen_; }
  Eigen::VectorXd of(const std::vector<double>& observation) const;
  // By filters that never saw the run: so would it look as a measurement.
  Eigen::VectorXd of_run(std::size_t run, const std::vector<double>& observation) const;
  // What the measurement's own uncertainty does to them.
  const Eigen::MatrixXd& noise() const { return noise_; }

 private:
  void append_principal(const Eigen::MatrixXd& covariance);
  Eigen::VectorXd scaled(const std::vector<double>& observation) const;

  std::vector<std::size_t> chosen_;
  Eigen::VectorXd middle_, scale_;  // of the numbers
  Eigen::MatrixXd filters_;         // numbers x features
  std::vector<Eigen::MatrixXd> fold_filters_;
  Eigen::VectorXd offset_;
  std::vector<Eigen::VectorXd> fold_offset_;
  Eigen::MatrixXd noise_;
};

}  // namespace tumble::diagnose
