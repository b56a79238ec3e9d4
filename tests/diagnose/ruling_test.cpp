#include "diagnose/ruling.h"

#include <gtest/gtest.h>

namespace tumble::diagnose {
namespace {

std::vector<Suspect> three_suspects() {
  std::vector<Suspect> suspects(3);
  suspects[0].name = "rolling_resistance";
  suspects[1].name = "cohesion";
  suspects[2].name = "camera_scale";
  suspects[2].kind = SuspectKind::kArtefact;
  return suspects;
}

Ruling ruled(const std::vector<std::pair<std::vector<int>, double>>& probabilities, double unknown = 0) {
  Posterior p;
  p.unknown = unknown;
  for (const auto& [guilty, probability] : probabilities) {
    p.accusations.emplace_back();
    p.accusations.back().explanation.suspects = guilty;
    p.accusations.back().probability = probability;
  }
  return rule(p, three_suspects());
}

using Names = std::set<std::string>;

TEST(Ruling, NamesWhoIsSureAndNoMore) {
  EXPECT_EQ(ruled({{{0}, 0.97}, {{}, 0.03}}).names, Names{"rolling_resistance"});
  EXPECT_EQ(ruled({{{0, 1}, 0.96}, {{0}, 0.04}}).names, (Names{"rolling_resistance", "cohesion"}));
  // Hardly anything does without the first; the second may be chance.
  EXPECT_EQ(ruled({{{0, 1}, 0.5}, {{0}, 0.45}, {{2}, 0.05}}).names, Names{"rolling_resistance"});
}

TEST(Ruling, TellsErrorsOfMeasurementFromPhysics) {
  EXPECT_EQ(ruled({{{2}, 0.95}, {{}, 0.05}}).finding, Finding::kMeasurementArtefact);
  EXPECT_EQ(ruled({{{0, 2}, 0.95}, {{2}, 0.05}}).finding, Finding::kMissingEffect);
}

TEST(Ruling, DoesNotDecideWhatTheDataLeaveOpen) {
  const Ruling open = ruled({{{0}, 0.5}, {{1}, 0.46}, {{}, 0.02}, {{2}, 0.02}});
  EXPECT_EQ(open.finding, Finding::kAmbiguous);
  EXPECT_EQ(open.names, (Names{"rolling_resistance", "cohesion"}));
  EXPECT_EQ(ruled({{{}, 0.6}, {{0}, 0.4}}).finding, Finding::kAgreement);
  EXPECT_EQ(ruled({{{}, 0.4}, {{0}, 0.3}, {{0, 1}, 0.3}}).finding, Finding::kAmbiguous);
  EXPECT_EQ(ruled({{{0}, 0.3}}, 0.7).finding, Finding::kUnknownEffect);
}

TEST(Ruling, FindsNothingOnlyWhereSomethingWouldHaveShown) {
  Posterior p;
  p.accusations.resize(2);
  p.accusations[0].probability = 0.8;
  Explanation& one = p.accusations[1].explanation;
  p.accusations[1].probability = 0.2;
  one.suspects = {1};
  one.free = {1};  // places: the three strengths
  one.places = Eigen::VectorXd::Zero(3);
  const auto ruling = [&](double se) {
    one.covariance = Eigen::MatrixXd::Constant(1, 1, se * se);
    return rule(p, three_suspects());
  };
  EXPECT_EQ(ruling(0.1).finding, Finding::kAgreement);
  EXPECT_EQ(ruling(0.6).finding, Finding::kAmbiguous);
  EXPECT_EQ(ruling(0.6).names, Names{"cohesion"});
}

}  // namespace
}  // namespace tumble::diagnose
