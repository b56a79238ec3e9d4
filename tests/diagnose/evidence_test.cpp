#include "diagnose/evidence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"

// A made-up mill whose numbers are curved functions of two uncertain keys and of the suspects, with chance that moves
// neighbouring numbers together. Shares nothing with the response that is fitted to it but that it is smooth.
namespace tumble::diagnose {
namespace {

constexpr std::size_t kNumbers = 60;

double normal(Random& random) {
  return std::sqrt(-2 * std::log(1 - random.uniform())) * std::cos(6.283185307 * random.uniform());
}

std::vector<Suspect> suspects() {
  std::vector<Suspect> list(3);
  list[0].name = "bend";
  list[0].sets.push_back({"bend", 0, 1});
  list[1].name = "twist";
  list[1].sets.push_back({"twist", 0, 1});
  list[1].low = -1.5;
  list[2].name = "camera_scale";
  list[2].kind = SuspectKind::kArtefact;
  list[2].low = -1.5;
  list[2].observer.scale = 0.02;
  return list;
}

double law(std::size_t i, double a, double b, double bend, double twist, double scale) {
  const double t = double(i) / kNumbers;
  return 20 * std::sin(3 * t + 0.15 * a) + 5 * std::tanh(0.15 * b) * t + 16 * bend * std::exp(-t * (1 + 0.2 * bend)) +
         8 * twist * std::cos(7 * t + 0.1 * a) + 12 * scale * (1 + t * t);
}

SignatureRun run_of(Random& random, int suspect, double strength, double a, double b) {
  SignatureRun run;
  run.uncertain = {a, b};
  run.suspect = suspect;
  run.strength = strength;
  run.revolutions = 8;
  std::vector<double> chance(kNumbers);
  double drift = 0;
  for (double& c : chance) c = drift = 0.6 * drift + 0.8 * normal(random);
  const auto seen_by = [&](double scale) {
    Observation seen;
    seen.noise.assign(kNumbers, 0);
    for (std::size_t i = 0; i < kNumbers; ++i)
      seen.value.push_back(chance[i] + law(i, a, b, suspect == 0 ? strength : 0, suspect == 1 ? strength : 0,
                                           scale + (suspect == 2 ? strength : 0)));
    Sight sight;
    sight.by_span.fill(seen);
    return sight;
  };
  run.seen = seen_by(0);
  run.misseen[0] = seen_by(-0.5);
  run.misseen[1] = seen_by(0.5);
  return run;
}

class MadeUpMill : public testing::Test {
 protected:
  MadeUpMill() {
    Random random(5);
    std::vector<SignatureRun> runs;
    for (int i = 0; i < 300; ++i) {
      const int suspect = i % 3 - 1;
      const double strength = suspect < 0 ? 0 : random.uniform(list_[static_cast<std::size_t>(suspect)].low, 1.5);
      runs.push_back(run_of(random, suspect, strength, random.uniform(-2.3, 2.3), random.uniform(-2.3, 2.3)));
    }
    std::vector<const SignatureRun*> all;
    for (const SignatureRun& r : runs) all.push_back(&r);
    std::vector<std::size_t> chosen(kNumbers);
    for (std::size_t i = 0; i < kNumbers; ++i) chosen[i] = i;
    response_ = std::make_unique<Response>(all, list_, chosen, std::vector<double>(kNumbers, 0), kSpans[0]);
  }

  Measured measured(const SignatureRun& run) const {
    const std::vector<double> seen = observed_at(run.seen, kSpans[0]);
    return {response_.get(), response_->whitened(seen), response_->outside(seen), run.revolutions};
  }
  std::vector<Explanation> explanations(const SignatureRun& run) const {
    const std::vector<Measured> seen{measured(run)};
    std::vector<Explanation> list{explain(seen, list_, {})};
    for (int s = 0; s < 3; ++s) list.push_back(explain(seen, list_, {s}));
    return list;
  }

  std::vector<Suspect> list_ = suspects();
  std::unique_ptr<Response> response_;
};

TEST_F(MadeUpMill, TheGuiltyIsNamedAndItsStrengthIsKnownWithinItsError) {
  Random random(77);
  int right = 0, within = 0, trials = 0;
  for (int t = 0; t < 60; ++t) {
    const int suspect = t % 3;
    const SignatureRun run = run_of(random, suspect, random.uniform(0.4, 1.1), normal(random), normal(random));
    const auto list = explanations(run);
    int best = 0;
    for (int e = 1; e < 4; ++e)
      if (list[static_cast<std::size_t>(e)].log_evidence > list[static_cast<std::size_t>(best)].log_evidence) best = e;
    ++trials;
    right += best == suspect + 1;
    const Explanation& truth = list[static_cast<std::size_t>(suspect) + 1];
    within += std::abs(truth.places[2 + suspect] - run.strength) < 2 * truth.se(2 + suspect);
  }
  EXPECT_GE(right, trials * 9 / 10);
  EXPECT_GE(within, trials * 9 / 10 - 2);
}

TEST_F(MadeUpMill, NothingIsNamedWhereNothingIsHidden) {
  Random random(78);
  double chi2 = 0, numbers = 0;
  int kept = 0;
  for (int t = 0; t < 60; ++t) {
    const auto list = explanations(run_of(random, -1, 0, normal(random), normal(random)));
    double most = list[1].log_evidence;
    for (std::size_t e = 2; e < 4; ++e) most = std::max(most, list[e].log_evidence);
    kept += list[0].log_evidence > most - 2;  // nobody is accused on odds of 7 to 1
    chi2 += list[0].chi2;
    numbers += list[0].numbers - double(list[0].free.size());
  }
  EXPECT_GE(kept, 57);
  EXPECT_NEAR(chi2 / numbers, 1, 0.1);
}

}  // namespace
}  // namespace tumble::diagnose
