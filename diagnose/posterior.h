#pragma once
#include <span>
#include <string>
#include <vector>

#include "diagnose/evidence.h"

// Who is guilty, and how sure that is: every suspect alone, pairs, nobody, and somebody who is not on the list.
namespace tumble::diagnose {

// `by_lifter[l]`: the conditions, with the drum taken to be turned on by l lifters: for suspects that turn with it.
struct Case {
  std::vector<std::vector<Measured>> by_lifter;
  std::span<const Suspect> suspects;
  std::vector<Clue> clues;
};

struct Accusation {
  Explanation explanation;
  int lifter = 0;         // where on the drum, of suspects that turn with it
  double log_weight = 0;  // ln of prior and evidence
  double log_beside = 0;  // of that, what is not the evidence at this lifter
  double probability = 0;
};

struct Posterior {
  std::vector<Accusation> accusations;  // likeliest first; that of nobody among them
  double unknown = 0;                   // probability that what is behind it is not on the list
  double misfit = 0;                    // chi2 per number of the likeliest, in units of what chance alone makes of it
  double misfit_limit = 0;              // which chance alone exceeds in one of a hundred diagnoses

  double none() const;
  double inclusion(std::span<const Suspect> suspects, const std::string& name) const;
};

Posterior weigh(const Case& of);

// The accusation again by a case whose measurements were put right.
Accusation weighed_again(const Accusation& accusation, const Case& of);

// Again, after some of the accusations were weighed anew: their order, all probabilities, the misfit.
void settle(Posterior& posterior, const Case& of);

}  // namespace tumble::diagnose
