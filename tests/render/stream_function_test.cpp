#include "render/stream_function.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"

namespace tumble::render {
namespace {

using Point = Eigen::Vector2d;
constexpr double kShell = 0.3, kTurning = 0.18, kOmega = 4, kCovered = 0.7;
const Point kCentre{0.05, -0.08};

// A disc of charge that turns like one body about a centre of its own; nothing elsewhere.
Field vortex(double noise = 0, const Point& centre = kCentre, double turning = kTurning) {
  Random random(3);
  Field f;
  f.n = 40;
  f.cell = 2 * kShell / f.n;
  for (int j = 0; j < f.n; ++j) {
    for (int i = 0; i < f.n; ++i) {
      const Point r((i - 19.5) * f.cell - centre.x(), (j - 19.5) * f.cell - centre.y());
      const bool inside = r.norm() < turning;
      f.occupancy.push_back(inside ? kCovered : 0);
      f.vx.push_back(inside ? -kOmega * r.y() + noise * random.uniform(-1, 1) : NAN);
      f.vy.push_back(inside ? kOmega * r.x() + noise * random.uniform(-1, 1) : NAN);
    }
  }
  return f;
}

double turn(const Contour& line) {  // > 0 counter-clockwise
  double area = 0;
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    const Point &a = line.points[i], &b = line.points[(i + 1) % line.points.size()];
    area += a.x() * b.y() - b.x() * a.y();
  }
  return area;
}

// Psi of a rigid vortex is phi omega (a^2 - r^2) / 2: its streamlines are circles about the centre, in the sense of the
// turning, at radii that the levels fix.
TEST(StreamFunction, OfARigidVortexHasCirclesForLines) {
  const Grid psi = stream_function(vortex(), kShell);
  const double peak = kCovered * kOmega * kTurning * kTurning / 2;
  EXPECT_NEAR(*std::max_element(psi.value.begin(), psi.value.end()), peak, 0.03 * peak);
  for (const double share : {0.2, 0.5, 0.8}) {
    const auto lines = contours(psi, share * peak);
    ASSERT_EQ(lines.size(), 1u);
    EXPECT_TRUE(lines[0].closed);
    EXPECT_GT(turn(lines[0]), 0);
    const double radius = kTurning * std::sqrt(1 - share);
    // Half a cell: the disc's own edge is a staircase of cells.
    for (const Point& p : rounded(lines[0], 1e-4).points) EXPECT_NEAR((p - kCentre).norm(), radius, 0.5 * psi.cell);
  }
}

// A charge that fills the mill and turns with it: the shell itself is a line, though it cuts through the cells.
TEST(StreamFunction, HasTheShellForALine) {
  const Grid psi = stream_function(vortex(0, {0, 0}, kShell), kShell);
  const double peak = kCovered * kOmega * kShell * kShell / 2;
  for (const double share : {0.01, 0.06, 0.3}) {
    const auto lines = contours(psi, share * peak);
    ASSERT_EQ(lines.size(), 1u);
    for (const Point& p : lines[0].points)
      EXPECT_NEAR(p.norm(), kShell * std::sqrt(1 - share), 0.1 * psi.cell) << share;
  }
}

// What is measured never has a divergence of nought; the lines are closed all the same.
TEST(StreamFunction, HasClosedLinesForAFieldWithNoise) {
  const Grid psi = stream_function(vortex(0.2), kShell);
  const double peak = *std::max_element(psi.value.begin(), psi.value.end());
  for (const double share : {0.1, 0.3, 0.5, 0.7, 0.9})
    for (const Contour& line : contours(psi, share * peak)) EXPECT_TRUE(line.closed) << share;
}

Grid grid_of(double (*value)(double, double)) {
  Grid grid{20, 0.1, {}};  // no middle on the axis: there is a square round it
  for (int j = 0; j < grid.n; ++j)
    for (int i = 0; i < grid.n; ++i) grid.value.push_back(value(grid.place(i), grid.place(j)));
  return grid;
}

TEST(Contours, OfAPlaneAreStraightAndHaveTheHigherGroundOnTheirLeft) {
  const auto lines = contours(grid_of([](double x, double y) { return 2 * x + y; }), 0.33);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_FALSE(lines[0].closed);
  EXPECT_GT(lines[0].points.size(), 20u);
  for (const Point& p : lines[0].points) EXPECT_NEAR(2 * p.x() + p.y(), 0.33, 1e-12);
  const Point way = lines[0].points.back() - lines[0].points.front();
  EXPECT_GT(-way.y() * 2 + way.x() * 1, 0);  // left of the way lies where the plane rises
}

// A saddle's two branches must not be joined across it, and the unknown ends lines.
TEST(Contours, KeepTheBranchesOfASaddleApartAndStopAtTheUnknown) {
  const auto saddle = [](double x, double y) { return x * y; };
  for (const double level : {0.001, -0.001}) {  // both within the square round the saddle
    const auto lines = contours(grid_of(saddle), level);
    ASSERT_EQ(lines.size(), 2u);
    for (const Contour& line : lines) {
      const double side = line.points.front().x();
      for (const Point& p : line.points) EXPECT_GT(p.x() * side, 0);
    }
  }
  Grid broken = grid_of([](double x, double y) { return -std::hypot(x, y); });
  ASSERT_EQ(contours(broken, -0.63).size(), 1u);
  EXPECT_TRUE(contours(broken, -0.63)[0].closed);
  broken.at(16, 10) = NAN;
  ASSERT_EQ(contours(broken, -0.63).size(), 1u);
  EXPECT_FALSE(contours(broken, -0.63)[0].closed);
}

}  // namespace
}  // namespace tumble::render
