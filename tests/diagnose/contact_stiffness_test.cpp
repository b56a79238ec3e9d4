#include "diagnose/contact_stiffness.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/units.h"

namespace tumble::diagnose {
namespace {

// The drop of a ball on a contact F = K d^n, which takes up all of m g (h + d) until the ball stands still.
LoadCellDrop drop_on(double stiffness, double n, double height, double mass = 0.25) {
  double d = 1e-3;
  for (int i = 0; i < 100; ++i) d = std::pow((n + 1) * mass * kGravity * (height + d) / stiffness, 1 / (n + 1));
  LoadCellDrop drop;
  drop.ball_mass = mass;
  drop.fall_height = height;
  drop.max_displacement = d;
  drop.max_force = stiffness * std::pow(d, n);
  drop.particle_layers = 1;
  return drop;
}

std::vector<LoadCellDrop> series(double stiffness, double n, double noise, std::mt19937& random) {
  std::normal_distribution<double> error(0, noise);
  std::vector<LoadCellDrop> drops;
  for (const double h : {0.1, 0.2, 0.4, 0.8})
    for (int i = 0; i < 2; ++i) {
      drops.push_back(drop_on(stiffness, n, h));
      drops.back().max_force *= std::exp(error(random));
      drops.back().max_displacement *= std::exp(error(random));
    }
  return drops;
}

TEST(ContactStiffness, OfALinearSpringIsOneNumberHoweverItIsTaken) {
  const DropStiffness k = stiffness_of(drop_on(4e5, 1, 0.3));
  EXPECT_NEAR(k.by_slope, 4e5, 1e-4);
  EXPECT_NEAR(k.by_energy, 4e5, 1e-3);
  EXPECT_NEAR(k.by_force, 4e5, 1e-3);
}

TEST(ContactStiffness, TheStandardErrorCoversTheTruth) {
  std::mt19937 random(1);
  int within = 0;
  double sum_z2 = 0;
  constexpr int kSets = 600;
  for (int set = 0; set < kSets; ++set) {
    const Estimate k = stiffness_groups(series(4e5, 1, 0.05, random))[0].stiffness;
    within += std::abs(k.value - 4e5) < k.se;
    sum_z2 += (k.value - 4e5) * (k.value - 4e5) / (k.se * k.se);
  }
  // The disagreement with the energy is noise here and makes the error larger than it need be, never smaller.
  EXPECT_GT(double(within) / kSets, 0.66);
  EXPECT_LT(double(within) / kSets, 0.90);
  EXPECT_LT(std::sqrt(sum_z2 / kSets), 1.0);
  EXPECT_GT(std::sqrt(sum_z2 / kSets), 0.5);
}

// Errors in d would flatten a plain regression of F on d: here they must not bias n.
TEST(ContactStiffness, FindsTheExponentWithItsError) {
  for (const double n : {1.0, 1.5}) {
    std::mt19937 random(2);
    double sum = 0, sum_z2 = 0;
    int right = 0, wrong = 0;
    constexpr int kSets = 400;
    for (int set = 0; set < kSets; ++set) {
      const StiffnessGroup g = stiffness_groups(series(n > 1 ? 1.1e7 : 4e5, n, 0.05, random))[0];
      ASSERT_EQ(g.freedom_by_height, 6);
      sum += g.exponent_by_height.value / kSets;
      sum_z2 += std::pow((g.exponent_by_height.value - n) / g.exponent_by_height.se, 2) / kSets;
      const FavouredLaw truth = n > 1 ? FavouredLaw::kHertz : FavouredLaw::kLinear;
      right += g.law == truth;
      wrong += g.law == FavouredLaw::kHertz || g.law == FavouredLaw::kLinear ? g.law != truth : 0;
    }
    EXPECT_NEAR(sum, n, 0.02);
    EXPECT_NEAR(sum_z2, 6.0 / 4, 0.45);  // the variance of Student's t with six degrees
    EXPECT_GT(right, 0.9 * kSets);
    EXPECT_LT(wrong, 0.01 * kSets);
  }
}

TEST(ContactStiffness, CannotTellTheLawFromOneHeightOrMuchNoise) {
  EXPECT_EQ(stiffness_groups(std::vector{drop_on(1.1e7, 1.5, 0.3)})[0].law, FavouredLaw::kCannotTell);
  std::mt19937 random(3);
  int open = 0, wrong = 0;
  constexpr int kSets = 300;
  for (int set = 0; set < kSets; ++set) {
    std::vector<LoadCellDrop> few = series(4e5, 1, 0.3, random);
    few.resize(3);
    const FavouredLaw law = stiffness_groups(few)[0].law;
    open += law == FavouredLaw::kCannotTell;
    wrong += law == FavouredLaw::kHertz;
  }
  EXPECT_GT(open, 0.6 * kSets);
  EXPECT_LT(wrong, 0.1 * kSets);  // ten to one
}

// Balls of other mass and size touch otherwise: only heights at equal mass tell the exponent.
TEST(ContactStiffness, MassesAloneGiveNoExponent) {
  std::vector<LoadCellDrop> drops;
  for (const double m : {0.1, 0.25, 0.6}) drops.push_back(drop_on(4e5, 1, 0.3, m));
  EXPECT_TRUE(std::isnan(stiffness_groups(drops)[0].exponent_by_height.value));
}

TEST(ContactStiffness, GroupsByParticlesInOrderOfLayers) {
  std::vector<LoadCellDrop> drops(4, drop_on(4e5, 1, 0.3));
  drops[0].particle_layers = 3;
  drops[1].particle_size = drops[3].particle_size = "1-2";
  const auto groups = stiffness_groups(drops);
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_EQ(groups[0].drops.size(), 2u);
  EXPECT_EQ(groups[0].particle_size, "1-2");
  EXPECT_EQ(groups[2].particle_layers, 3);
}

// The simulator's k_h = (5/4) k_n d_0^(-1/2) at the mean pair, d_0 = v sqrt(m / 2 / k_n) (core/effects.cpp), must be
// the K of the drop, brought from the anvil's effective radius to the pair's.
TEST(ContactStiffness, TheHertzLawsStiffnessMeetsTheDrop) {
  const double prefactor = 1.1e7, mass = 0.25;
  const StiffnessGroup g = stiffness_groups(std::vector{drop_on(prefactor, 1.5, 0.3, mass)})[0];
  const double k = g.hertz_normal_stiffness, overlap = std::sqrt(mass / 2 / k);
  EXPECT_NEAR(1.25 * k / std::sqrt(overlap), prefactor / std::sqrt(2.0), 1e-6 * prefactor);
}

}  // namespace
}  // namespace tumble::diagnose
