#include "diagnose/evidence.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/diagnose/made_up_mill.h"

namespace tumble::diagnose {
namespace {

class Explained : public testing::Test {
 protected:
  Explanation explained(const SignatureRun& run, std::vector<int> guilty) const {
    const std::vector<Measured> seen{
        {mill_.response(), mill_.response()->whitened(observed_at(run.seen, kSpans[0])), run.revolutions}};
    return explain(seen, mill_.suspects(), std::move(guilty));
  }

  MadeUpMill mill_;
};

TEST_F(Explained, StrengthsAreKnownWithinTheirErrors) {
  Random random(77);
  int within = 0, trials = 0;
  for (int t = 0; t < 60; ++t) {
    std::array<double, 3> strength{};
    const int guilty = t % 3;
    strength[static_cast<std::size_t>(guilty)] = random.uniform(0.4, 1.1);
    const Explanation e = explained(mill_.run(random, {strength[0], strength[1], strength[2]}), {guilty});
    ++trials;
    within += std::abs(e.places[2 + guilty] - strength[static_cast<std::size_t>(guilty)]) < 2 * e.se(2 + guilty);
  }
  EXPECT_GE(within, trials * 9 / 10 - 2);
}

TEST_F(Explained, WhereNothingIsHiddenTheMisfitIsWhatChanceMakesOfIt) {
  Random random(78);
  double chi2 = 0, numbers = 0;
  for (int t = 0; t < 60; ++t) {
    const Explanation e = explained(mill_.run(random, {0, 0, 0}), {});
    chi2 += e.chi2;
    numbers += e.numbers - double(e.free.size());
  }
  EXPECT_NEAR(chi2 / numbers, 1, 0.1);
}

TEST_F(Explained, NobodyForgetsHalfABall) {
  std::vector<Suspect> in_balls = mill_.suspects();
  in_balls[1].sets[0].whole = true;  // at full strength, one ball
  Random random(79);
  const auto gain = [&](double strength) {  // of evidence, by counting in balls
    const SignatureRun run = mill_.run(random, {0, strength, 0});
    const std::vector<Measured> seen{
        {mill_.response(), mill_.response()->whitened(observed_at(run.seen, kSpans[0])), run.revolutions}};
    return explain(seen, in_balls, {1}).log_evidence - explain(seen, mill_.suspects(), {1}).log_evidence;
  };
  EXPECT_GT(gain(1), 0);
  EXPECT_LT(gain(0.5), -5);
}

}  // namespace
}  // namespace tumble::diagnose
