#pragma once
#include <map>
#include <string>
#include <vector>

#include "trials/trial.h"
#include "trials/verdict.h"

// Verdicts against what was hidden: pure counting, no file.
namespace tumble::trials {

struct Judged {
  TrialKey key;
  Verdict verdict;
};

// A share of n, or a number made of n, with its 95 % interval; NaN of nothing.
struct Measured {
  double value = kNotGiven, low = kNotGiven, high = kNotGiven;
  int n = 0;
};
Measured share_of(int right, int n);  // Wilson (1927), J. Am. Stat. Assoc. 22, 209
// Order statistic; its interval by the binomial distribution of ranks, in the normal approximation.
Measured quantile_with_interval(std::vector<double> values, double share);
Measured spread_of(const std::vector<double>& values);  // standard deviation; the interval holds for normal values

// One line of what a diagnosis must reach (docs/trials.md).
struct Bar {
  std::string number;  // "6a"; empty: told for information
  std::string demand;
  Measured measured;
  double least = kNotGiven, most = kNotGiven;  // what is asked for, either or both
  bool is_share = true;                        // shown in per cent

  bool tried() const { return measured.n > 0; }
  bool met() const;
};

struct Score {
  std::vector<Bar> bars;
  // What was hidden -> what was said -> how often. "fluid_drag + cohesion", "none"; "ambiguous: a, b", "unknown",
  // "no verdict".
  std::map<std::string, std::map<std::string, int>> confusion;
};
Score score(const std::vector<Judged>& trials);

}  // namespace tumble::trials
