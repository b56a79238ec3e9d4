#include "diagnose/restitution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/units.h"
#include "diagnose/student.h"

namespace tumble::diagnose {
namespace {

Bounce drop(double height, double e) {
  Bounce b;
  b.fall_height = height;
  b.rebound_height = e * e * height;
  return b;
}

TEST(Restitution, OfEqualMassesIsThePapersEquation12) {
  Bounce b;
  b.fall_height = 0.2;
  b.rebound_height = 0.17;
  EXPECT_NEAR(impact_of(b, BounceKind::kPendulum).restitution.value, 2 * std::sqrt(0.17 / 0.2) - 1, 1e-15);
}

// An impact of any two masses, from momentum and e = (u2 - u1) / v1, and not from the formula under test.
TEST(Restitution, OfUnequalMassesKeepsTheMomentum) {
  for (const double m1 : {0.06, 0.195, 0.525})
    for (const double m2 : {0.06, 0.195, 0.525})
      for (const double e : {0.3, 0.8, 1.0}) {
        const double v1 = 1.7, together = m1 * v1 / (m1 + m2);
        const double u2 = together + e * v1 * m1 / (m1 + m2), u1 = together - e * v1 * m2 / (m1 + m2);
        ASSERT_NEAR(m1 * u1 + m2 * u2, m1 * v1, 1e-12);
        ASSERT_NEAR(u2 - u1, e * v1, 1e-12);
        Bounce b;
        b.fall_height = v1 * v1 / (2 * kGravity);
        b.rebound_height = u2 * u2 / (2 * kGravity);
        b.ball_mass = m1;
        b.target_mass = m2;
        const Impact impact = impact_of(b, BounceKind::kPendulum);
        EXPECT_NEAR(impact.restitution.value, e, 1e-12);
        EXPECT_NEAR(impact.speed, v1, 1e-12);
      }
}

// One standard error must hold the truth about as often as it says, with the scatter alone and with uncertainties.
TEST(Restitution, TheStandardErrorCoversTheTruth) {
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0, 0.004);
  for (const double uncertainty : {0.0, 0.004}) {
    int within = 0;
    double sum_z2 = 0;
    constexpr int kSets = 600;
    for (int set = 0; set < kSets; ++set) {
      std::vector<Bounce> bounces;
      for (int i = 0; i < 12; ++i) {
        Bounce b = drop(0.3, 0.5);
        b.rebound_height += noise(random);
        b.rebound_uncertainty = uncertainty;
        b.ball_radius = i % 2 ? 0.012 : 0.018;
        bounces.push_back(b);
      }
      const Estimate e = restitution_from(bounces, BounceKind::kDrop).mean;
      within += std::abs(e.value - 0.5) < e.se;
      sum_z2 += (e.value - 0.5) * (e.value - 0.5) / (e.se * e.se);
    }
    EXPECT_NEAR(double(within) / kSets, 0.70, 0.06) << uncertainty;
    EXPECT_NEAR(std::sqrt(sum_z2 / kSets), 1.0, 0.12) << uncertainty;
  }
}

// Sizes that really differ: the mean of the mix is then known no better than the sizes agree.
TEST(Restitution, SizesThatDifferWidenTheError) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.003);
  std::vector<Bounce> bounces;
  for (int i = 0; i < 30; ++i) {
    Bounce b = drop(0.3, (i % 3 == 0 ? 0.45 : i % 3 == 1 ? 0.5 : 0.55) + noise(random));
    b.ball_radius = 0.012 + 0.006 * (i % 3);
    bounces.push_back(b);
  }
  const RestitutionResult r = restitution_from(bounces, BounceKind::kDrop);
  ASSERT_EQ(r.groups.size(), 3u);
  EXPECT_NEAR(r.mean.se, 0.05 / std::sqrt(3), 0.006);  // as of three means 0.05 apart
  EXPECT_TRUE(r.size_matters);
  EXPECT_NEAR(r.slope_size.value, 0.05 / 0.006, 3 * r.slope_size.se);
}

TEST(Restitution, FindsHowItFallsWithSpeed) {
  std::mt19937 random(6);
  std::normal_distribution<double> noise(0, 0.004);
  std::vector<Bounce> bounces;
  for (const double h : {0.01, 0.03, 0.08, 0.2, 0.5, 1.2})
    for (int i = 0; i < 4; ++i) {
      const double v = std::sqrt(2 * kGravity * h);
      bounces.push_back(drop(h, 0.9 * (1 - 0.4 * (1 - std::exp(-v / 1.1))) + noise(random)));
    }
  const RestitutionResult r = restitution_from(bounces, BounceKind::kDrop);
  ASSERT_TRUE(r.falling) << r.why_not_falling;
  EXPECT_NEAR(r.falling->at_rest.value, 0.9, 3 * r.falling->at_rest.se);
  EXPECT_NEAR(r.falling->drop.value, 0.4, 3 * r.falling->drop.se);
  EXPECT_NEAR(r.falling->speed.value, 1.1, 3 * r.falling->speed.se);
  EXPECT_LT(r.falling->speed.se, 0.2);
  EXPECT_TRUE(r.speed_matters);
}

TEST(Restitution, FitsNoFallWhereThereIsNoneOrTheSpeedsSpanTooLittle) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 0.01);
  std::vector<Bounce> steady, narrow;
  for (int i = 0; i < 24; ++i) {
    steady.push_back(drop(0.01 * std::pow(2, i % 8), 0.5 + noise(random)));
    narrow.push_back(drop(0.3 + 0.02 * (i % 6), 0.6 - 0.1 * (i % 6) + noise(random) / 10));
  }
  EXPECT_FALSE(restitution_from(steady, BounceKind::kDrop).falling);
  EXPECT_FALSE(restitution_from(narrow, BounceKind::kDrop).falling);
}

// Against the motion itself: m x'' + C x' + k x = 0 from x = 0 comes back to x = 0 with e times its speed.
TEST(Restitution, TheDampingConstantGivesTheRestitutionBack) {
  const double k = 4e5, m = 0.06;
  for (const double e : {0.1, 0.5, 0.9}) {
    const double c = damping_constant({e, 0.01}, {k, 0}, m).value;
    double x = 0, v = 1;
    const double dt = kPi * std::sqrt(m / k) / 1e5;
    do {
      const double half = v + 0.5 * dt * (-c * v - k * x) / m;
      x += dt * half;
      v += dt * (-c * half - k * (x - 0.5 * dt * half)) / m;
    } while (x > 0);
    EXPECT_NEAR(-v, e, 1e-4);
  }
}

TEST(Restitution, TheDampingsErrorIsItsSlopeTimesTheOthers) {
  const auto c = [](double e, double k) { return damping_constant({e, 0}, {k, 0}, 0.1).value; };
  const Estimate found = damping_constant({0.5, 1e-3}, {4e5, 1e3}, 0.1);
  const double by_e = c(0.5005, 4e5) - c(0.4995, 4e5), by_k = c(0.5, 400500) - c(0.5, 399500);
  EXPECT_NEAR(found.se, std::hypot(by_e, by_k), 1e-4 * found.se);
}

TEST(Student, IsWhatTablesSay) {
  EXPECT_NEAR(student_95(1), 12.706, 1e-3);
  EXPECT_NEAR(student_95(3), 3.182, 0.03);
  EXPECT_NEAR(student_95(10), 2.228, 0.002);
  EXPECT_NEAR(student_95(1000), 1.962, 0.001);
  EXPECT_TRUE(std::isnan(student_95(0)));
}

}  // namespace
}  // namespace tumble::diagnose
