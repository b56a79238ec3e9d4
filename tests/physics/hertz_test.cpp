#include <gtest/gtest.h>

#include "tests/support/balls.h"

namespace tumble::sim {
namespace {

struct Impact {
  double restitution = 0, seconds = 0, overlap = 0;  // overlap: the largest [m]
  double elastic = 0;                                // energy in the spring at that moment [J]
};

constexpr double kLinearOverlap = 2.7386127875258306e-4;  // v sqrt(m / k_n) at 1 m/s: 30 g on 4e5 N/m [m]

// Hertz 1882 for two mean balls, F = k d^(3/2): d_max = (5/4 m v^2 / k)^(2/5). k is such that at reference_speed, 1
// m/s, that is the linear law's; so d_max = d_0 v^(4/5), and the impact lasts 2.943 d_max / v.
double largest_overlap(double speed) { return kLinearOverlap * std::pow(speed, 0.8); }
double impact_time(double speed) { return 2.943275 * largest_overlap(speed) / speed; }

// Two mean balls head on, with a time step that follows the fastest impact, as "auto" does.
constexpr double kFastest = 3;
Impact head_on(double share, double e, double speed, double steps, double phase = 0.3) {
  Config config = smooth_mill(kFlat, {{"hertz_contact", {{"share", {share}}}}}, 0, e);
  MillModel model = resting(config);
  model.gravity = 0;
  model.time_step = impact_time(kFastest) / steps;
  const double gap = speed * model.time_step * (2 + phase);
  RunningMill mill = start_mill(model, charge_of({{.x = -0.012 - gap, .vx = speed}, {.x = 0.012}}));
  Impact impact;
  for (int k = 0; k < 400'000; ++k) {
    advance(mill);
    const std::vector<Contact> contacts = contacts_of(mill, Kind::kBalls);
    const bool touch = !contacts.empty();
    if (!touch && impact.seconds > 0) break;
    if (!touch) continue;
    impact.seconds += model.time_step;
    if (contacts[0].state.overlap > impact.overlap) {
      impact.overlap = contacts[0].state.overlap;
      impact.elastic = energies_of(mill).elastic;
    }
  }
  impact.restitution = (vx_of(mill, 1) - vx_of(mill, 0)) / speed;
  return impact;
}

TEST(Hertz, LastsAndYieldsAsHertzSays) {
  for (const double v : {0.03, 0.3, 1.0, 3.0}) {
    const Impact impact = head_on(1, 1, v, 400);
    const double d_max = largest_overlap(v);
    EXPECT_NEAR(impact.overlap, d_max, 1e-4 * d_max) << v << " m/s";
    EXPECT_NEAR(impact.seconds, impact_time(v), 0.006 * impact.seconds) << v << " m/s: a step more or less";
    EXPECT_NEAR(impact.elastic, 0.5 * 0.03 * v * v, 1e-4 * impact.elastic) << v << " m/s";
  }
}

// A blend of the two springs stores the impact's energy in both: (1 - s) k d^2 / 2 + s (2/5) k_h d^(5/2).
TEST(Hertz, BlendsStoreTheEnergyInBothSprings) {
  for (const double share : {0.2, 0.5, 0.8})
    for (const double v : {0.1, 2.0}) {
      const double d = head_on(share, 1, v, 400).overlap;
      const double linear = 0.5 * 4e5 * d * d, hertz = 0.4 * 1.25 * 4e5 / std::sqrt(kLinearOverlap) * std::pow(d, 2.5);
      const double energy = (1 - share) * linear + share * hertz;
      EXPECT_NEAR(energy, 0.5 * 0.03 * v * v, 3e-4 * energy) << "share " << share << ", " << v << " m/s";
    }
}

// The dashpot of hertz_contact.h gives e at every speed and in any blend. As it grows with d^(1/4) the first and the
// last step err by the order 5/4 of the step: by less than 0.2 / n with n steps in the fastest impact.
TEST(Hertz, KeepsTheRestitutionAtEverySpeed) {
  for (const double share : {0.3, 1.0})
    for (const double e : {0.1, 0.4, 0.8, 1.0})
      for (const double v : {0.02, 0.5, 3.0})
        for (const double n : {20.0, 50.0, 200.0})
          for (const double phase : {0.0, 0.25, 0.5, 0.75})
            EXPECT_NEAR(head_on(share, e, v, n, phase).restitution, e, 0.2 / n)
                << "share " << share << ", e " << e << ", " << v << " m/s, " << n << " steps";
}

}  // namespace
}  // namespace tumble::sim
