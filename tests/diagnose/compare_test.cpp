#include "diagnose/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/motion_quantities.h"
#include "core/units.h"

namespace tumble::diagnose {
namespace {

const Difference* find(const Deviation& deviation, const std::string& name) {
  for (const Difference& d : deviation.differences)
    if (d.name == name) return &d;
  return nullptr;
}

const SampledDifference* find(const std::vector<SampledDifference>& all, const std::string& name) {
  for (const SampledDifference& d : all)
    if (d.name == name) return &d;
  return nullptr;
}

constexpr int kCells = 40;
constexpr double kRadius = 0.25, kError = 0.02;  // [m]; of every number of a field

double x_of(int k) { return (k % kCells + 0.5) * 2 / kCells - 1; }
double y_of(int k) { return (k / kCells + 0.5) * 2 / kCells - 1; }

// A bed in the lower right, every number with its own chance error of the size it says.
ChargeMotion mill(unsigned seed, double error = kError) {
  std::mt19937 random(seed);
  std::normal_distribution<double> chance(0, error);
  ChargeMotion m;
  m.mill_radius = kRadius;
  m.lifter_count = 18;
  m.frames = 400;
  m.speed_fraction = {0.7, 0};
  for (const MotionQuantity& q : kMotionQuantities) {
    if (std::string(q.name).starts_with("speed") || std::string(q.name) == "filling") continue;
    m.*q.of = {100 + chance(random), kError};
  }
  m.toe_deg = {225 + chance(random), kError};
  m.shoulder_deg = {40 + chance(random), kError};
  Field& f = m.field;
  f.n = kCells;
  f.cell = 2 * kRadius / kCells;
  for (auto* values : {&f.occupancy, &f.occupancy_se, &f.vx, &f.vy, &f.vx_se, &f.vy_se})
    values->assign(kCells * kCells, kNotGiven);
  for (int k = 0; k < kCells * kCells; ++k) {
    const auto i = static_cast<std::size_t>(k);
    if (std::hypot(x_of(k), y_of(k)) > 1) continue;
    const bool bed = x_of(k) - y_of(k) > 0.2;
    f.occupancy[i] = bed ? 0.7 + chance(random) : 0.2 + chance(random);
    f.vx[i] = -y_of(k) + chance(random);
    f.vy[i] = x_of(k) + chance(random);
    f.occupancy_se[i] = f.vx_se[i] = f.vy_se[i] = kError;
  }
  m.ring_occupancy.fill(0.5);
  m.ring_occupancy_se.fill(kError);
  return m;
}

TEST(Compare, TakesDirectionsRoundTheCircleAndAddsErrorsInSquares) {
  ChargeMotion a, b;
  a.shoulder_deg = {359, 0.3};
  b.shoulder_deg = {2, 0.4};
  a.head = {0.2, 0.01};
  b.head = {0.17, 0.0};
  const Deviation deviation = compare(a, b);
  const Difference* shoulder = find(deviation, "shoulder_deg");
  ASSERT_TRUE(shoulder);
  EXPECT_NEAR(shoulder->difference, 3, 1e-12);
  EXPECT_NEAR(shoulder->se, 0.5, 1e-12);
  EXPECT_NEAR(shoulder->z, 6, 1e-9);
  const Difference* head = find(deviation, "head_m");
  ASSERT_TRUE(head);
  EXPECT_NEAR(head->difference, -0.03, 1e-12);
  EXPECT_NEAR(head->z, -3, 1e-9);
}

TEST(Compare, WhatOneLacksHasNoDifferenceAndWhatBothLackNoRow) {
  ChargeMotion a, b;
  a.toe_deg = {230, 1};
  b.toe_deg = {231, kNotGiven};
  a.torque = {8, 0.1};
  const Deviation deviation = compare(a, b);
  ASSERT_EQ(deviation.differences.size(), 2u);
  EXPECT_TRUE(std::isnan(find(deviation, "toe_deg")->z)) << "an error that is not known is not zero";
  EXPECT_TRUE(std::isnan(find(deviation, "torque_N_m")->difference));
  EXPECT_EQ(find(deviation, "torque_N_m")->note, "only A has it");
  EXPECT_EQ(deviation.verdict, Verdict::kUnknown) << "nothing has an error, so nothing can be said";
}

TEST(Compare, EqualMillsGiveOneAndNothingBeyondChance) {
  double mean = 0;
  int named = 0;
  constexpr int kPairs = 20;
  for (unsigned pair = 0; pair < kPairs; ++pair) {
    const Deviation d = compare(mill(2 * pair + 1), mill(2 * pair + 2));
    mean += d.chi / kPairs;
    named += d.verdict == Verdict::kDiffer;
    ASSERT_EQ(d.agreements.size(), 3u);
  }
  // Chance is normal here and is judged by Student's t, which expects wider tails: 0.96 rather than 1.
  EXPECT_NEAR(mean, 0.97, 0.06);
  EXPECT_LE(named, 2);
}

TEST(Compare, ErrorsThatAreTwiceAsLargeAsTheyShouldBeHalveTheNumber) {
  const double right = compare(mill(1), mill(2)).chi;
  EXPECT_NEAR(compare(mill(1, 0.5 * kError), mill(2, 0.5 * kError)).chi, 0.5 * right, 0.03);
}

TEST(Compare, FindsAPatchOfCellsAndSaysWhere) {
  const ChargeMotion a = mill(1);
  ChargeMotion b = mill(2);
  int planted = 0;
  for (int k = 0; k < kCells * kCells; ++k)
    if (std::hypot(x_of(k) - 0.4, y_of(k) + 0.5) < 0.2) {
      b.field.occupancy[static_cast<std::size_t>(k)] -= 8 * kError;
      ++planted;
    }
  const Deviation d = compare(a, b);
  const SampledDifference* occupancy = find(d.fields, "occupancy");
  ASSERT_TRUE(occupancy);
  int found = 0, invented = 0;
  for (int k = 0; k < kCells * kCells; ++k) {
    if (!occupancy->significant[static_cast<std::size_t>(k)]) continue;
    ++(std::hypot(x_of(k) - 0.4, y_of(k) + 0.5) < 0.2 ? found : invented);
  }
  EXPECT_GT(found, 0.9 * planted);
  EXPECT_LE(invented, 2) << "one in a hundred of what is named may be chance";
  EXPECT_EQ(occupancy->where, "in the bed");
  EXPECT_NEAR(occupancy->se[kCells * kCells / 2 + kCells / 2], std::sqrt(2.0) * kError, 1e-12);
  EXPECT_EQ(d.verdict, Verdict::kDiffer);
  EXPECT_NE(d.sentence.find("occupancy differs"), std::string::npos) << d.sentence;
}

TEST(Compare, OneQuantityFarOffIsNamedWithItsSign) {
  ChargeMotion b = mill(2);
  b.shoulder_deg.value -= 12 * kError;
  const Deviation d = compare(mill(1), b);
  EXPECT_TRUE(find(d, "shoulder_deg")->significant);
  EXPECT_NE(d.sentence.find("shoulder \u22120."), std::string::npos) << d.sentence;
}

TEST(Compare, WhatHangsOnThePicturesRateDoesNotCountBetweenFilmAndRun) {
  ChargeMotion film = mill(2), run = mill(2);
  film.source = MotionSource::kFilm;
  for (ChargeMotion* m : {&film, &run}) m->granular_temperature.value += 100 * kError;
  EXPECT_EQ(compare(mill(1), run).verdict, Verdict::kDiffer);
  const Deviation d = compare(mill(1), film);
  EXPECT_EQ(d.verdict, Verdict::kAgree) << d.sentence;
  EXPECT_GT(find(d, "granular_temperature_m2_s2")->z, 50) << "it is still told";
}

TEST(Compare, AFilmTooSlowForItsBallsIsSaidEvenIfItSawSlowBallsAlone) {
  ChargeMotion film = mill(2);
  film.source = MotionSource::kFilm;
  TrackPoint p;
  p.radius = 0.01;
  film.tracks = {p};
  for (auto* v : {&film.field.vx, &film.field.vy})
    for (double& one : *v) one *= 0.1;
  // One cell in ten of the run moves faster than 0.95 m/s.
  film.frames_per_second = 60;
  EXPECT_TRUE(compare(mill(1), film).caveats.empty());
  film.frames_per_second = 40;
  ASSERT_EQ(compare(mill(1), film).caveats.size(), 1u);
}

TEST(Compare, ConditionsDoNotCountButAreSaid) {
  ChargeMotion b = mill(2);
  b.speed_fraction = {0.9, 0.001};
  const ChargeMotion same = mill(2);
  const Deviation d = compare(mill(1), b);
  EXPECT_EQ(d.chi, compare(mill(1), same).chi);
  ASSERT_EQ(d.caveats.size(), 1u);
  EXPECT_NE(d.caveats[0].find("different speeds"), std::string::npos);
}

TEST(Compare, MillsOfOtherSizeAreComparedInWhatHasNoLength) {
  ChargeMotion b = mill(2);
  b.mill_radius *= 2;
  b.field.cell *= 2;
  const Deviation d = compare(mill(1), b);
  EXPECT_FALSE(std::isnan(find(d, "toe_deg")->z));
  EXPECT_FALSE(std::isnan(find(d, "flight_share")->z));
  for (const char* with_length : {"head_m", "torque_N_m", "circulation_time_s", "granular_temperature_m2_s2"}) {
    EXPECT_TRUE(std::isnan(find(d, with_length)->z)) << with_length;
    EXPECT_FALSE(find(d, with_length)->note.empty());
  }
  EXPECT_TRUE(find(d.fields, "occupancy"));
  EXPECT_FALSE(find(d.fields, "velocity_x"));
  EXPECT_FALSE(find(d.lines, "surface"));
  ASSERT_FALSE(d.caveats.empty());
  EXPECT_NE(d.caveats[0].find("differ in diameter"), std::string::npos);
  EXPECT_EQ(compare(mill(1), mill(2)).caveats.size(), 0u);
}

// White noise on a tone of known power: Welch's density is theirs in every band, and the tone's stands out.
ChargeMotion beating(unsigned seed, double rate, double tone) {
  std::mt19937 random(seed);
  std::normal_distribution<double> chance(0, 1);
  ChargeMotion m = mill(seed);
  for (int i = 0; i < 30 * rate; ++i) {
    const double t = i / rate;
    // White noise of density 2 / rate x variance, so that both rates have the same density.
    m.torque_series.push_back({t, std::sqrt(rate / 100) * chance(random) + tone * std::sin(2 * kPi * 12 * t), 0});
  }
  return m;
}

TEST(Compare, SpectraAreDensitiesWhateverTheRateAndFindATone) {
  const Deviation equal = compare(beating(1, 100, 0), beating(2, 200, 0));
  const SampledDifference* noise = find(equal.lines, "torque_spectrum");
  ASSERT_TRUE(noise);
  // 0.02 but for the geometric mean, which lies a few per cent below in bands of some tens of independent powers.
  const auto upper = [](const std::vector<double>& v) { return (v.end()[-2] + v.end()[-3] + v.end()[-4]) / 3; };
  EXPECT_NEAR(upper(noise->a), 0.019, 0.002);
  EXPECT_NEAR(upper(noise->b), 0.019, 0.002);
  EXPECT_EQ(noise->beyond_chance, 0);

  const Deviation apart = compare(beating(1, 100, 0), beating(2, 200, 1));
  const SampledDifference* tone = find(apart.lines, "torque_spectrum");
  EXPECT_EQ(tone->beyond_chance, 1);
  for (std::size_t i = 0; i < tone->x.size(); ++i) {
    if (tone->significant[i]) {
      EXPECT_NEAR(tone->x[i], 12, 3);
    }
  }
}

// Two revolutions a second, 18 lifters: a torque that beats with them, its strength drawn anew for each revolution, and
// sampled as a run is, each frame's mean since the one before.
ChargeMotion passing(unsigned seed, double rate, double lag_deg) {
  std::mt19937 random(seed);
  std::normal_distribution<double> chance(0, 0.3);
  ChargeMotion m = mill(seed);
  double weather = 0;
  for (int i = 0; i < 20 * rate; ++i) {
    const double time = i / rate, turned = 720 * time, middle = turned - 360 / rate;
    if (i % static_cast<int>(rate / 2) == 0) weather = chance(random);
    m.profile.push_back({.frame = i, .time = time, .mill_angle_deg = std::fmod(turned, 360)});
    m.torque_series.push_back({time, 10 + weather + 2 * std::cos(18 * (middle - lag_deg) * kPi / 180), 0});
  }
  return m;
}

TEST(Compare, TorqueOverALiftersPassageIsTheSameAtAnyRateAndFindsALag) {
  const Deviation equal = compare(passing(1, 487, 5), passing(2, 613, 5));
  const SampledDifference* same = find(equal.lines, "torque_over_lifter_passage");
  ASSERT_TRUE(same);
  ASSERT_EQ(same->x.size(), 12u);
  for (std::size_t i = 0; i < same->x.size(); ++i)
    EXPECT_NEAR(same->a[i], 10 + 2 * std::cos(18 * (same->x[i] - 5) * kPi / 180), 0.25) << same->x[i];
  EXPECT_EQ(same->compared, 12);
  EXPECT_EQ(same->beyond_chance, 0);

  const Deviation apart = compare(passing(1, 487, 5), passing(2, 613, 10));
  EXPECT_GT(find(apart.lines, "torque_over_lifter_passage")->beyond_chance, 6);

  ChargeMotion fewer = passing(2, 613, 5);
  fewer.lifter_count = 12;
  EXPECT_FALSE(find(compare(passing(1, 487, 5), fewer).lines, "torque_over_lifter_passage"));
  // Three pictures a passage do not show it.
  EXPECT_FALSE(find(compare(passing(1, 487, 5), passing(2, 110, 5)).lines, "torque_over_lifter_passage"));
}

}  // namespace
}  // namespace tumble::diagnose
