#include "diagnose/posterior.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "tests/diagnose/made_up_mill.h"

namespace tumble::diagnose {
namespace {

class Trial : public testing::Test {
 protected:
  Case of(const SignatureRun& run) const {
    Case c;
    c.by_lifter = {{{mill_.response(), mill_.response()->whitened(observed_at(run.seen, kSpans[0])), run.revolutions}}};
    c.suspects = mill_.suspects();
    return c;
  }
  std::string likeliest(const Posterior& p) const {
    std::string names;
    for (const int s : p.accusations.front().explanation.suspects)
      names += mill_.suspects()[static_cast<std::size_t>(s)].name + " ";
    return names;
  }

  MadeUpMill mill_;
};

TEST_F(Trial, TwoThatAreGuiltyAreBothNamed) {
  Random random(31);
  int right = 0;
  for (int t = 0; t < 20; ++t) {
    const SignatureRun run = mill_.run(random, {random.uniform(0.5, 1.1), -random.uniform(0.5, 1.1), 0});
    right += likeliest(weigh(of(run))) == "bend twist ";
  }
  EXPECT_GE(right, 18);
}

TEST_F(Trial, NobodyIsAccusedWhereNothingIsHidden) {
  Random random(32);
  int kept = 0;
  for (int t = 0; t < 40; ++t) {
    const Posterior p = weigh(of(mill_.run(random, {0, 0, 0})));
    kept += likeliest(p).empty() && p.none() > 0.5;
  }
  EXPECT_GE(kept, 34);
}

TEST_F(Trial, WhoIsNotOnTheListIsUnknown) {
  Random random(33);
  int unknown = 0, false_alarms = 0;
  for (int t = 0; t < 20; ++t) {
    unknown += weigh(of(mill_.run(random, {0, 0, 0}, 6))).unknown > 0.5;
    false_alarms += weigh(of(mill_.run(random, {0.8, 0, 0}))).unknown > 0.5;
  }
  EXPECT_GE(unknown, 18);
  EXPECT_LE(false_alarms, 1);
}

TEST_F(Trial, ProbabilitiesAddUpAndCluesAreHeard) {
  Random random(34);
  Case c = of(mill_.run(random, {0, 0, 0}));
  Posterior p = weigh(c);
  double sum = p.unknown;
  for (const Accusation& a : p.accusations) sum += a.probability;
  EXPECT_NEAR(sum, 1, 1e-9);
  EXPECT_LT(p.inclusion(c.suspects, "twist"), 0.3);
  c.clues.push_back({{{1, 1.0}}, 0.05, 0.0025});
  p = weigh(c);
  EXPECT_GT(p.inclusion(c.suspects, "twist"), 0.99);
}

// Eight films by chance, of which one looks a little like a suspect's, are no evidence against one who turns with the
// drum.
TEST_F(Trial, TurningTheDrumAloneIsNoEvidence) {
  Random random(35);
  std::vector<Suspect> suspects = mill_.suspects();
  suspects[1].turns_with_drum = true;
  int kept = 0;
  for (int t = 0; t < 20; ++t) {
    Case c = of(mill_.run(random, {0, 0, 0}));
    for (int l = 1; l < 8; ++l) c.by_lifter.push_back(of(mill_.run(random, {0, 0, 0})).by_lifter.front());
    c.suspects = suspects;
    kept += weigh(c).none() > 0.5;
  }
  EXPECT_GE(kept, 18);
}

}  // namespace
}  // namespace tumble::diagnose
