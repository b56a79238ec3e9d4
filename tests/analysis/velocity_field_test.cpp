#include "analysis/velocity_field.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "core/units.h"

namespace tumble::analysis {
namespace {

// Discs strewn over the mill that move with v(x, y).
template <class Velocity>
FieldStatistics strewn(double radius, int frames, Velocity velocity) {
  FieldStatistics statistics(radius);
  Random random(3);
  for (int f = 0; f < frames; ++f) {
    std::vector<MovingDisc> discs;
    for (int k = 0; k < 150; ++k) {
      MovingDisc d;
      d.x = random.uniform(-radius, radius);
      d.y = random.uniform(-radius, radius);
      d.radius = 0.01;
      velocity(d);
      if (std::hypot(d.x, d.y) < radius) discs.push_back(d);
    }
    statistics.add(discs);
  }
  return statistics;
}

TEST(VelocityField, OfABodilyTurnIsThatTurn) {
  const double omega = 4.0, R = 0.25;
  const Field f = strewn(R, 400, [&](MovingDisc& d) {
                    d.vx = -omega * d.y;
                    d.vy = omega * d.x;
                  }).field();
  int known = 0;
  for (int j = 0; j < f.n; ++j)
    for (int i = 0; i < f.n; ++i) {
      const std::size_t k = static_cast<std::size_t>(j) * f.n + i;
      const double x = (i + 0.5 - 0.5 * f.n) * f.cell, y = (j + 0.5 - 0.5 * f.n) * f.cell;
      if (std::hypot(x, y) > R - 0.02 || std::isnan(f.vx[k])) continue;
      ++known;
      // A disc reaches a radius beyond the cell; its centre's velocity speaks for all of it.
      EXPECT_NEAR(f.vx[k], -omega * y, omega * 0.006);
      EXPECT_NEAR(f.vy[k], omega * x, omega * 0.006);
    }
  EXPECT_GT(known, 800);
}

TEST(VelocityField, CentreOfCirculationIsTheVortexThatTurnsWithTheMill) {
  const double cx = 0.09, cy = -0.07;
  Random noise(5);
  const auto statistics = strewn(0.25, 400, [&](MovingDisc& d) {
    const double dx = d.x - cx, dy = d.y - cy, slow = 1 + 20 * (dx * dx + dy * dy);
    d.vx = -5 * dy / slow + noise.uniform(-0.3, 0.3);
    d.vy = 5 * dx / slow + noise.uniform(-0.3, 0.3);
  });
  const auto c = statistics.centre_of_circulation(0.04);
  EXPECT_NEAR(c.x.value, cx, 4 * c.x.se);
  EXPECT_NEAR(c.y.value, cy, 4 * c.y.se);
  EXPECT_LT(c.x.se, 0.003);
  EXPECT_GT(c.x.se, 1e-5);
}

TEST(VelocityField, HasNoCentreWhereNothingTurnsWithTheMill) {
  const auto against = strewn(0.25, 100, [](MovingDisc& d) {
    d.vx = 4 * d.y;
    d.vy = -4 * d.x;
  });
  EXPECT_TRUE(std::isnan(against.centre_of_circulation(0.04).x.value));
}

TEST(VelocityField, OccupancyIsTheShareOfAreaAndTemperatureTheSpread) {
  FieldStatistics statistics(0.2);
  MovingDisc d{0.05, 0.05, 0.03, 1.0, 0.0};
  for (int f = 0; f < 100; ++f) {
    d.vx = f % 2 == 0 ? 1.5 : 0.5;  // mean 1, variance 1/4
    statistics.add(std::vector<MovingDisc>{d});
  }
  const Field field = statistics.field();
  double area = 0;
  for (double o : field.occupancy)
    if (!std::isnan(o)) area += o * field.cell * field.cell;
  EXPECT_NEAR(area, kPi * 0.03 * 0.03, 0.02 * kPi * 0.03 * 0.03);
  const std::size_t k = static_cast<std::size_t>(25) * field.n + 25;  // the cell that holds the disc's middle
  EXPECT_NEAR(field.vx[k], 1.0, 1e-12);
  EXPECT_NEAR(field.temperature[k], 0.125, 1e-12);
}

}  // namespace
}  // namespace tumble::analysis
