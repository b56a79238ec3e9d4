#include "trials/score.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

namespace tumble::trials {
namespace {

Hidden hidden(const std::string& name, Nature nature, double value = 0.02) {
  return {name, nature, 1, "coefficient", value, {}};
}
TrialKey key(Kind kind, std::vector<Hidden> what, Tier tier = Tier::kTracks) {
  TrialKey k;
  k.kind = kind;
  k.tier = tier;
  k.hidden = std::move(what);
  return k;
}
TrialKey rolling(double value = 0.02) {
  return key(Kind::kSingle, {hidden("rolling_resistance", Nature::kPhysics, value)});
}

// A verdict as a diagnosis writes it: names with one parameter each.
Verdict said(const std::string& verdict, const std::vector<std::string>& names, double probability = 0.99,
             double value = 0.02, double se = 0.001, const std::string& rest = "") {
  std::string effects, ranking;
  for (const std::string& n : names) {
    if (n != "none" && n != "unknown")
      effects += fmt::format(R"({}{{"name":"{}","parameters":{{"coefficient":{{"value":{},"se":{}}}}}}})",
                             effects.empty() ? "" : ",", n, value, se);
    ranking += fmt::format(R"({}{{"name":"{}","probability":{}}})", ranking.empty() ? "" : ",", n, probability);
  }
  const Verdict v = parse_verdict(
      fmt::format(R"({{"verdict":"{}","effects":[{}],"ranking":[{}]{}}})", verdict, effects, ranking, rest));
  EXPECT_EQ(v.broken, "");
  return v;
}
Verdict missing(const std::string& name) { return said("missing_effect", {name}); }

const Bar& bar(const Score& s, const std::string& number) {
  for (const Bar& b : s.bars)
    if (b.number == number) return b;
  throw std::logic_error("no bar " + number);
}
void expect_bar(const std::vector<Judged>& trials, const std::string& number, double value, int n) {
  const Score s = score(trials);
  EXPECT_EQ(bar(s, number).measured.n, n) << number;
  EXPECT_NEAR(bar(s, number).measured.value, value, 1e-9) << number;
}

// By hand: 8 of 10 at z = 1.96 is 0.490 to 0.943 (Newcombe 1998 tabulates such); 0 of 20 ends at z2 / (n + z2).
TEST(Score, IntervalsAreWilsons) {
  const Measured m = share_of(8, 10);
  EXPECT_NEAR(m.low, 0.4902, 1e-4);
  EXPECT_NEAR(m.high, 0.9433, 1e-4);
  EXPECT_NEAR(share_of(0, 20).high, 3.8415 / 23.8415, 1e-4);
  EXPECT_EQ(share_of(0, 20).low, 0);
  EXPECT_TRUE(std::isnan(share_of(0, 0).value));
}

TEST(Score, CountsTheFirstNameOfTheRanking) {
  std::vector<Judged> trials(4, {rolling(), missing("rolling_resistance")});
  trials[1].verdict = missing("fluid_drag");
  trials[2].verdict = parse_verdict("{ no json");
  trials[3].key.tier = Tier::kFilms;
  expect_bar(trials, "1", 1.0 / 3, 3);
  expect_bar(trials, "2", 1, 1);
  const Score s = score(trials);
  EXPECT_FALSE(bar(s, "1").met());
  EXPECT_TRUE(bar(s, "2").met());
  EXPECT_FALSE(bar(s, "4").tried());
  EXPECT_EQ(s.confusion.at("rolling_resistance").at("fluid_drag"), 1);
  EXPECT_EQ(s.confusion.at("rolling_resistance").at("no verdict"), 1);
}

// Those that are there only to have more of the hard ones do not count for the mean of all.
TEST(Score, HardOnesMayNameTheirRivals) {
  const TrialKey hertz = key(Kind::kHard, {hidden("hertz_contact", Nature::kPhysics)});
  const std::string next = R"(,"next_experiment":{"set":{"mill.speed":0.5},"separates":["a","b"]})";
  const Verdict rivals = said("ambiguous", {"wall_friction", "hertz_contact"}, 0.5, 1, 1, next);
  const std::vector<Judged> trials{
      {hertz, missing("hertz_contact")},
      {hertz, rivals},
      {hertz, said("ambiguous", {"wall_friction", "hertz_contact"}, 0.5)},  // decides nothing
      {hertz, said("ambiguous", {"wall_friction", "cohesion"}, 0.5, 1, 1, next)}};
  expect_bar(trials, "3", 0.5, 4);
  // Five names are no answer, unless the first is right.
  const Verdict all = said("ambiguous", {"hertz_contact", "a", "b", "c", "d"}, 0.2, 1, 1, next);
  const Verdict last = said("ambiguous", {"a", "b", "c", "d", "hertz_contact"}, 0.2, 1, 1, next);
  expect_bar({{hertz, all}, {hertz, last}}, "3", 0.5, 2);
  EXPECT_FALSE(bar(score(trials), "1").tried());
}

TEST(Score, TellsArtefactsFromPhysics) {
  const TrialKey camera = key(Kind::kArtefact, {hidden("camera_scale", Nature::kArtefact)});
  const std::vector<Judged> trials{{camera, said("measurement_artefact", {"camera_rotation"})},  // wrong, not confused
                                   {camera, missing("cohesion")},
                                   {rolling(), said("measurement_artefact", {"camera_scale"})},
                                   {rolling(), said("agreement", {"none"})},
                                   {rolling(), said("ambiguous", {"camera_scale"})}};
  expect_bar(trials, "5", 0.4, 5);
}

TEST(Score, CountsPairsAndSeconds) {
  const TrialKey both =
      key(Kind::kPair, {hidden("cohesion", Nature::kPhysics), hidden("fluid_drag", Nature::kPhysics)});
  const std::vector<Judged> trials{{both, said("missing_effect", {"fluid_drag", "cohesion"})},
                                   {both, missing("cohesion")},
                                   {rolling(), said("missing_effect", {"rolling_resistance", "cohesion"})},
                                   {rolling(), missing("rolling_resistance")},
                                   {rolling(), said("ambiguous", {"rolling_resistance", "cohesion"}, 0.5)}};
  expect_bar(trials, "6a", 0.5, 2);
  expect_bar(trials, "6b", 1.0 / 3, 3);
}

// Claims: every probability above 0.95, of "none" and "unknown" too.
TEST(Score, CountsClaims) {
  const TrialKey magnus = key(Kind::kUnknown, {hidden("magnus_lift", Nature::kUnknown)});
  const std::vector<Judged> trials{{rolling(), missing("rolling_resistance")},
                                   {rolling(), said("missing_effect", {"cohesion"}, 0.97)},
                                   {rolling(), said("missing_effect", {"cohesion"}, 0.94)},  // claims nothing
                                   {key(Kind::kNone, {}), said("agreement", {"none"})},
                                   {magnus, said("unknown_effect", {"unknown"})},
                                   {magnus, said("agreement", {"none"})}};
  expect_bar(trials, "7a", 3.0 / 5, 5);
  expect_bar(trials, "9a", 0.5, 2);
  expect_bar(trials, "9b", 0, 4);
  expect_bar(trials, "4", 1, 1);
}

// Errors of 0, 10, 20, 30 and 40 % in standard errors of 5 %: pulls 0, 2, 4, 6, 8.
TEST(Score, MeasuresStrengths) {
  std::vector<Judged> trials;
  for (int i = 0; i < 5; ++i)
    trials.push_back(
        {rolling(0.02), said("missing_effect", {"rolling_resistance"}, 0.99, 0.02 * (1 + 0.1 * i), 0.001)});
  trials.push_back({rolling(0.02), said("missing_effect", {"cohesion"}, 0.99, 7)});  // another name's does not count
  expect_bar(trials, "8a", 0.2, 5);
  expect_bar(trials, "8b", 0.4, 5);
  expect_bar(trials, "7b", std::sqrt(10.0), 5);
}

TEST(Score, TurnLockedFaultsAreNoticedByAnyNameButNoneAndArtefacts) {
  const TrialKey gap = key(Kind::kTurnLocked, {hidden("missing_lifters", Nature::kPhysics)});
  const std::vector<Judged> trials{{gap, missing("missing_lifters")},
                                   {gap, said("unknown_effect", {"unknown"})},
                                   {gap, said("agreement", {"none"})},
                                   {gap, said("measurement_artefact", {"speed_error"})},
                                   {gap, parse_verdict("")}};
  expect_bar(trials, "10", 0.4, 5);
}

TEST(Score, CountsBrokenVerdictsAsWrongInEveryWay) {
  const std::vector<Judged> trials{{rolling(), parse_verdict("")}, {rolling(), missing("rolling_resistance")}};
  for (const char* number : {"1", "5", "6b", "9b"}) expect_bar(trials, number, 0.5, 2);
}

TEST(Score, MeasuresGapsOfRightVerdicts) {
  const auto gap = [](double before, double after, double runner_up) {
    return said(
        "missing_effect", {"rolling_resistance"}, 0.99, 0.02, 0.001,
        fmt::format(R"(,"gap":{{"before":{{"hold_out":{}}},"after":{{"hold_out":{}}},"runner_up":{{"hold_out":{}}}}})",
                    before, after, runner_up));
  };
  const std::vector<Judged> trials{{rolling(), gap(5, 0.5, 3)},            // closed 1: no more than chance is left
                                   {rolling(), gap(3, 0.9, 0.8)},          // closed 1
                                   {rolling(), gap(2, 1.5, 4)},            // closed 0.5
                                   {key(Kind::kNone, {}), gap(9, 9, 1)}};  // not right
  expect_bar(trials, "11", 1, 3);
  expect_bar(trials, "12", 2.0 / 3, 3);
}

TEST(Score, ScalarsMayNeverBeFalselyCertain) {
  TrialKey drag = rolling();
  drag.tier = Tier::kScalars;
  const std::string next = R"(,"next_experiment":{"set":{},"separates":[]})";
  const std::vector<Judged> trials{
      {drag,
       said("ambiguous", {"rolling_resistance", "cohesion", "fluid_drag", "lifter_wear", "none"}, 0.2, 1, 1, next)},
      {drag, said("ambiguous", {"rolling_resistance", "cohesion"}, 0.5)},  // does not say what would decide
      {drag, missing("cohesion")},
      {drag, missing("rolling_resistance")}};
  expect_bar(trials, "13", 0.5, 4);
  EXPECT_FALSE(bar(score(trials), "1").tried());
}

TEST(Verdict, ThatIsNoneIsBroken) {
  for (const char* text : {"", "[]", R"({"verdict":"perhaps","effects":[],"ranking":[]})", R"({"verdict":"agreement"})",
                           R"({"verdict":"agreement","effects":[{}],"ranking":[]})"}) {
    const Verdict v = parse_verdict(text);
    EXPECT_NE(v.broken, "") << text;
    EXPECT_EQ(v.verdict, "") << text;
  }
  EXPECT_NE(read_verdict("/no/such/verdict.json").broken, "");
}

}  // namespace
}  // namespace tumble::trials
