#include "diagnose/fit.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "core/random.h"

namespace tumble::diagnose {
namespace {

double normal(Random& random) {  // Box & Muller
  const double u = 1 - random.uniform();
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * kPi * random.uniform());
}

// A stand-in for a mill: power and toe of an experiment at some "speed", curved in both parameters, with scatter.
struct StandIn {
  double scatter_power = 0.4, scatter_toe = 1.5;

  static double power(double speed, const std::vector<double>& p) {
    return 20 * speed * (1 + std::tanh(4 * p[0]) + 0.5 * speed * p[1] * p[1] + 0.3 * p[0] * p[1]);
  }
  static double toe(double speed, const std::vector<double>& p) {  // crosses 0 degrees: directions are taken round
    return wrap_360(5 - 20 * speed * p[0] - 25 * (1 - speed) * std::sqrt(p[1] + 0.1));
  }
  std::vector<Estimate> run(double speed, const std::vector<double>& p, std::uint64_t seed) const {
    Random random(seed * 977 + static_cast<std::uint64_t>(speed * 1000));
    return {{power(speed, p) + scatter_power * normal(random), scatter_power},
            {wrap_360(toe(speed, p) + scatter_toe * normal(random)), scatter_toe}};
  }
};

const std::vector<double> kSpeeds{0.4, 0.6, 0.8, 1.0, 1.2};

FitProblem problem_at(const std::vector<double>& truth, std::size_t keys, std::uint64_t seed) {
  constexpr double kPowerSd = 0.25, kToeSd = 1;
  FitProblem problem;
  problem.keys = {{"friction", 0.05, 0.6}, {"damping", 0.1, 0.9}};
  problem.keys.resize(keys);
  problem.experiments = kSpeeds.size();
  Random random(seed);
  for (std::size_t e = 0; e < kSpeeds.size(); ++e) {
    FitTarget target;
    target.experiment = e;
    target.measured = {StandIn::power(kSpeeds[e], truth) + kPowerSd * normal(random), kPowerSd};
    problem.targets.push_back(target);
    target.measured = {wrap_360(StandIn::toe(kSpeeds[e], truth) + kToeSd * normal(random)), kToeSd};
    target.is_direction = true;
    problem.targets.push_back(target);
  }
  problem.simulations = default_simulations(keys, problem.experiments);
  problem.seed = seed + 1000;
  return problem;
}

Simulate stand_in(const std::vector<double>& truth) {
  return [truth](const std::vector<Trial>& trials) {
    std::vector<std::vector<Estimate>> results;
    for (const Trial& t : trials) {
      std::vector<double> at = truth;  // what is not fitted is known
      std::copy(t.at.begin(), t.at.end(), at.begin());
      results.push_back(StandIn{}.run(kSpeeds[t.experiment], at, t.seed));
    }
    return results;
  };
}

// Over many made-up measurements the deviations in standard errors scatter by 1: error bars that are too small are
// worse than none. chi2 comes to the degrees of freedom.
void expect_calibrated(std::size_t keys, int trials) {
  double sum = 0, sum2 = 0, chi2 = 0, dof = 0;
  int n = 0, flagged = 0;
  Random random(7);
  for (int i = 0; i < trials; ++i) {
    const std::vector<double> truth{random.uniform(0.12, 0.5), random.uniform(0.25, 0.75)};
    const Fit found = fit(problem_at(truth, keys, 100 + i), stand_in(truth));
    chi2 += found.chi2;
    dof += found.degrees_of_freedom;
    flagged += found.misfit;
    for (std::size_t k = 0; k < keys; ++k) {
      const double pull = (found.keys[k].value.value - truth[k]) / found.keys[k].value.se;
      sum += pull;
      sum2 += pull * pull;
      ++n;
    }
  }
  const double sd = std::sqrt(sum2 / n);
  EXPECT_NEAR(sum / n, 0, 3.0 / std::sqrt(n));
  EXPECT_GT(sd, 0.7);
  EXPECT_LT(sd, 1.35);  // a few runs an experiment cannot tell their own error better
  EXPECT_NEAR(chi2 / dof, 1, 0.2);
  EXPECT_LE(flagged, trials / 5);  // 5 % are meant to be
}

TEST(Fit, ErrorBarsOfOneKeyAreRight) { expect_calibrated(1, 60); }
TEST(Fit, ErrorBarsOfTwoKeysAreRight) { expect_calibrated(2, 30); }

// Three experiments that see only friction: damping is left open, and that is said.
TEST(Fit, SaysWhatTheDataCannotTell) {
  FitProblem problem = problem_at({0.3, 0.5}, 2, 1);
  std::erase_if(problem.targets, [](const FitTarget& t) { return t.is_direction; });
  const Fit found = fit(problem, [](const std::vector<Trial>& trials) {
    auto results = stand_in({0.3, 0.5})(trials);
    for (std::size_t i = 0; i < trials.size(); ++i)
      results[i] = {StandIn{}.run(kSpeeds[trials[i].experiment], {trials[i].at[0], 0.5}, trials[i].seed)[0]};
    return results;
  });
  EXPECT_FALSE(found.keys[0].undetermined);
  EXPECT_NEAR(found.keys[0].value.value, 0.3, 4 * found.keys[0].value.se);
  EXPECT_TRUE(found.keys[1].undetermined);
}

TEST(Fit, SaysWhereTheBestLiesBeyondTheRange) {
  FitProblem problem = problem_at({0.3, 0.5}, 1, 1);
  problem.keys[0].low = 0.4;
  const Fit found = fit(problem, stand_in({0.3, 0.5}));
  EXPECT_TRUE(found.keys[0].at_bound);
  EXPECT_NEAR(found.keys[0].value.value, 0.4, 1e-3);
  EXPECT_TRUE(found.misfit);
}

// What is known beforehand counts as one more datum.
TEST(Fit, PriorIsWeighedAgainstTheData) {
  FitProblem problem = problem_at({0.3, 0.5}, 1, 1);
  const Fit free = fit(problem, stand_in({0.3, 0.5}));
  const Estimate alone = free.keys[0].value;
  problem.keys[0].prior = alone.value + 2 * alone.se;
  problem.keys[0].prior_sd = alone.se;
  const Fit held = fit(problem, stand_in({0.3, 0.5}));
  EXPECT_NEAR(held.keys[0].value.value, alone.value + alone.se, 0.5 * alone.se);
  EXPECT_NEAR(held.keys[0].value.se, alone.se / std::sqrt(2), 0.2 * alone.se);
}

// A datum that most runs lack, as the toe of a charge that centrifuges, does not spoil the others.
TEST(Fit, LeavesOutWhatTheRunsDoNotHave) {
  FitProblem problem = problem_at({0.3, 0.5}, 1, 1);
  problem.targets[1].name = "first: toe_deg";
  const Fit found = fit(problem, [](const std::vector<Trial>& trials) {
    auto results = stand_in({0.3, 0.5})(trials);
    for (std::size_t i = 0; i < trials.size(); ++i)
      if (trials[i].experiment == 0) results[i][1] = {};
    return results;
  });
  EXPECT_NEAR(found.keys[0].value.value, 0.3, 4 * found.keys[0].value.se);
  ASSERT_EQ(found.notes.size(), 1u);
  EXPECT_EQ(found.notes[0], "first: toe_deg had no part in the fit: too few runs have it");
}

}  // namespace
}  // namespace tumble::diagnose
