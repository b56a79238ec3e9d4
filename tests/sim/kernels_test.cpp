#include "sim/kernels/kernels.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

#include "core/random.h"
#include "core/units.h"
#include "sim/shell.h"
#include "tests/support/shells.h"

namespace tumble::sim {
namespace {

// Balls of different sizes at some features of a shell, in the columns that the kernels read.
struct AtLifters {
  std::vector<double> x, y, radius, cos, sin;
  std::vector<int> i, j;
  ChargeView balls{};

  AtLifters(const Shell& shell, const ShellPose& pose, int n, Random& random) {
    for (const Feature& f : shell.features) {
      const Direction d = direction_of(f, pose);
      cos.push_back(d.cos);
      sin.push_back(d.sin);
    }
    for (int k = 0; k < n; ++k) {
      const int feature = 1 + static_cast<int>(random.below(shell.features.size()));
      const auto f = static_cast<std::size_t>(feature) - 1;
      const double r = 0.003 + 0.02 * random.uniform();
      // Anywhere within reach of the run.
      const double away = (shell.features[f].reach + r) * std::sqrt(random.uniform()), a = random.uniform(0, 2 * kPi);
      const double u = shell.features[f].x + away * std::cos(a), v = shell.features[f].y + away * std::sin(a);
      x.push_back(u * cos[f] - v * sin[f]);
      y.push_back(u * sin[f] + v * cos[f]);
      radius.push_back(r);
      i.push_back(k);
      j.push_back(feature);
    }
    i.resize(i.size() + kMostLanes, 0);
    j.resize(j.size() + kMostLanes, 1);
    balls.x = x.data();
    balls.y = y.data();
    balls.radius = radius.data();
  }
};

std::uint64_t bits(double v) { return std::bit_cast<std::uint64_t>(v); }

// In lanes as one by one, to the last bit, wherever a ball touches; and seldom left to be done one by one.
TEST(Kernels, LiftersOfEveryShape) {
  std::vector<NamedMill> mills = mills_of_every_profile();
  Random random(17);
  for (int k = 0; k < 60; ++k) mills.push_back({"random " + std::to_string(k), random_shell(random)});
  for (const NamedMill& mill : mills) {
    const Shell shell = make_shell(make_mill_shape(mill.config));
    if (shell.features.empty()) continue;
    int touching = 0, in_the_steel = 0;
    for (int trial = 0; trial < 10; ++trial) {
      const ShellPose pose = pose_of(random.uniform(0, 2 * kPi));
      const int n = trial == 0 ? 5 : kBlock;
      const AtLifters at(shell, pose, n, random);
      LifterRuns runs = lifter_runs(shell);
      runs.cos = at.cos.data();
      runs.sin = at.sin.data();
      for (const Kernels* kernels : all_kernels()) {
        WallPoints points;
        const std::uint64_t unsure = kernels->nearest_on_runs(at.balls, runs, at.i.data(), at.j.data(), n, points);
        for (int k = 0; k < n; ++k) {
          const WallPoint p = nearest_on_wall(shell, pose, at.j[k], at.x[k], at.y[k]);
          const std::string place =
              mill.name + ", " + kernels->name + ", trial " + std::to_string(trial) + ", ball " + std::to_string(k);
          if (p.distance <= 0) {
            ++in_the_steel;
          } else if (p.distance >= at.radius[k]) {
            EXPECT_TRUE(unsure >> k & 1 || points.distance[k] >= at.radius[k]) << place;
          } else {
            ++touching;
            ASSERT_FALSE(unsure >> k & 1) << place;
            EXPECT_EQ(bits(points.distance[k]), bits(p.distance)) << place;
            EXPECT_EQ(bits(points.nx[k]), bits(p.nx)) << place;
            EXPECT_EQ(bits(points.ny[k]), bits(p.ny)) << place;
          }
        }
        EXPECT_EQ(unsure >> (n - 1) >> 1, 0u) << mill.name << ": beyond the last";
      }
    }
    EXPECT_GT(touching, 50) << mill.name;
  }
}

}  // namespace
}  // namespace tumble::sim
