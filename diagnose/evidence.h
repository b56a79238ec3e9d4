#pragma once
#include <Eigen/Core>
#include <span>
#include <utility>
#include <vector>

#include "diagnose/response.h"

// How well a set of suspects explains what was measured, whatever the uncertain keys are.
namespace tumble::diagnose {

struct Measured {  // in one condition
  const Response* response = nullptr;
  Eigen::VectorXd seen;    // Response::whitened
  double revolutions = 0;  // that were watched
  // Where simulations at the very places have shown how far off the polynomial is: by this (else empty), known so well.
  Eigen::VectorXd shift = {};
  double shift_variance = 0;
  double scatter = 1;  // variance that chance makes about there, against the response's
};

struct Clue {  // what an exact check says, without any simulation: a weighted sum of strengths
  std::vector<std::pair<int, double>> slopes;  // of suspects
  double value = 0, se = 0;
};

struct Explanation {
  std::vector<int> suspects;   // none: nothing is hidden
  Eigen::VectorXd places;      // the likeliest: keys, then strengths of all suspects
  Eigen::MatrixXd covariance;  // of those in `free`
  std::vector<int> free;       // which places were free
  double chi2 = 0, numbers = 0;
  double log_evidence = 0;
  std::vector<double> chi2_of;  // each condition's

  double se(int place) const;  // of one of the places; NaN where it was not free
};

// `suspects`: the mill's, for ranges and kinds. Local minima: tried from both sides and from weak and strong.
Explanation explain(std::span<const Measured> measured, std::span<const Suspect> suspects, std::vector<int> guilty,
                    std::span<const Clue> clues = {});

// Of what was measured, where everything is known; but for constants.
double log_likelihood(std::span<const Measured> measured, const Eigen::VectorXd& places);

}  // namespace tumble::diagnose
