#include "diagnose/observation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/random.h"
#include "core/units.h"
#include "diagnose/free_flight.h"
#include "diagnose/tracking_noise.h"

namespace tumble::diagnose {
namespace {

constexpr double kRadius = 0.3, kTip = 0.28, kBall = 0.012, kOmega = 4;

// Balls that are carried with the drum as if glued to it.
MapSums carried(const ObservationLayout& layout, const std::vector<View>& views, double lost = 0) {
  MapSums sums(layout, kRadius, kTip, kBall, views);
  Random random(3);
  for (int frame = 0; frame < 400; ++frame) {
    const double time = frame / 250.0, angle = kOmega * time;
    std::vector<Sighting> balls;
    for (int i = 0; i < 40; ++i) {
      const double r = 0.05 + 0.006 * i, a = 2.4 * i + angle;
      if (random.uniform() < lost) continue;
      balls.push_back({i, r * std::cos(a), r * std::sin(a), kBall, kOmega});
    }
    sums.add(time, angle, balls);
  }
  return sums;
}

double sum_of(const Observation& seen, const ObservationLayout& layout, Observable o) {
  const auto first = seen.value.begin() + static_cast<long>(layout.first(o));
  return std::accumulate(first, first + static_cast<long>(layout.count(o)), 0.0);
}

TEST(Observation, SharesAndSpinsAddUpToTheCharge) {
  const ObservationLayout layout(18);
  Observation seen;
  carried(layout, {{0.004, {}}}).finish(0, seen);
  EXPECT_NEAR(sum_of(seen, layout, Observable::kOccupancy), 1, 1e-9);
  EXPECT_NEAR(sum_of(seen, layout, Observable::kSpin), kOmega, 1e-9 * kOmega);
}

TEST(Observation, CarriedBallsMoveAsTheDrumAndNotAgainstIt) {
  const ObservationLayout layout(18);
  Observation seen;
  carried(layout, {{0.004, {}}}).finish(0, seen);
  const std::size_t cells = layout.cells.size();
  for (std::size_t k = 0; k < cells; ++k) {
    const double area = seen.value[layout.first(Observable::kOccupancy) + k];
    if (area < 0.003) continue;
    // Shares of balls that are up to a cell away: the mean place is within half a cell of the middle.
    const double tolerance = 0.5 * kOmega * 2 * kRadius / kCells;
    EXPECT_NEAR(seen.value[layout.first(Observable::kMomentum) + k] / area, -kOmega * kRadius * layout.cells[k].y,
                tolerance);
    EXPECT_NEAR(seen.value[layout.first(Observable::kMomentum) + cells + k] / area,
                kOmega * kRadius * layout.cells[k].x, tolerance);
  }
  const std::size_t pockets = layout.first(Observable::kPockets);
  double filled = 0;
  for (std::size_t p = 0; p < 18; ++p) {
    filled += seen.value[pockets + p] > 0;
    EXPECT_NEAR(seen.value[pockets + 18 + p], 0, 1e-3);  // a chord is shorter than its arc
  }
  EXPECT_GT(filled, 2);
}

// Noise of tracking would add 2 (0.3 mm / 8 ms)^2 to the square of a velocity measured once.
TEST(Observation, NoiseOfTrackingIsNoAgitation) {
  const ObservationLayout layout(18);
  Random random(8);
  MapSums sums(layout, kRadius, kTip, kBall, {{0.004, {}}});
  const double v = 0.2;
  for (int frame = 0; frame < 4000; ++frame) {
    const double time = frame / 250.0;
    std::vector<Sighting> balls;
    for (int i = 0; i < 20; ++i) {
      const double a = v / 0.1 * time + i;
      balls.push_back({i, 0.1 * std::cos(a) + 3e-4 * std::sqrt(12.0) * (random.uniform() - 0.5),
                       0.1 * std::sin(a) + 3e-4 * std::sqrt(12.0) * (random.uniform() - 0.5), kBall, 0});
    }
    sums.add(time, 0, balls);
  }
  Observation seen;
  sums.finish(0, seen);
  const double area = sum_of(seen, layout, Observable::kOccupancy);
  EXPECT_NEAR(sum_of(seen, layout, Observable::kAgitation) / area, v * v, 0.01 * v * v);
}

TEST(Observation, ObserversErrAsTheySay) {
  const ObservationLayout layout(18);
  const double quarter = kPi / 2;
  const MapSums sums = carried(layout, {{0.004, {}}, {0.004, {0, quarter, 0}}, {0.004, {0, 0, 0.02}}});
  Observation right, turned, slow;
  sums.finish(0, right);
  sums.finish(1, turned);
  sums.finish(2, slow);
  const std::size_t occupancy = layout.first(Observable::kOccupancy), momentum = layout.first(Observable::kMomentum);
  for (int v = 0; v < kCells; ++v)
    for (int u = 0; u < kCells; ++u) {  // a quarter turn carries cells into cells
      const int from = layout.cell_at[static_cast<std::size_t>(v * kCells + u)],
                to = layout.cell_at[static_cast<std::size_t>(u * kCells + kCells - 1 - v)];
      if (from < 0) continue;
      EXPECT_NEAR(turned.value[occupancy + static_cast<std::size_t>(to)],
                  right.value[occupancy + static_cast<std::size_t>(from)], 1e-9);
    }
  // Who takes times to be 2 % longer than they are sees everything 2 % slower.
  for (std::size_t k = 0; k < layout.count(Observable::kMomentum); ++k)
    EXPECT_NEAR(slow.value[momentum + k] * 1.02, right.value[momentum + k], 1e-3);
}

TEST(Observation, LostBallsAreNoSmallerCharge) {
  const ObservationLayout layout(18);
  Observation all, some;
  carried(layout, {{0.004, {}}}).finish(0, all);
  carried(layout, {{0.004, {}}}, 0.1).finish(0, some);
  for (const Observable o : {Observable::kOccupancy, Observable::kAgitation, Observable::kSpin})
    EXPECT_NEAR(sum_of(some, layout, o), sum_of(all, layout, o), 0.02 * std::abs(sum_of(all, layout, o))) << name_of(o);
}

// Balls that lie on the tips of the lifters, where pockets end: seen with an error or without, they count as many.
TEST(Observation, NoiseDoesNotEmptyPockets) {
  const ObservationLayout layout(18);
  const auto filled = [&](double noise) {
    Random random(9);
    MapSums sums(layout, kRadius, kTip, kBall, {{0.004, {}}});
    for (int frame = 0; frame < 600; ++frame) {
      std::vector<Sighting> balls;
      for (int i = 0; i < 36; ++i) {
        const double r = kTip - kBall + 1e-5 + noise * gaussian(random), a = 2 * kPi * (i + 0.5) / 36;
        balls.push_back({i, r * std::cos(a), r * std::sin(a), kBall, 0});
      }
      sums.add(frame / 250.0, 0, balls);
    }
    Observation seen;
    sums.finish(0, seen);
    return sum_of(seen, layout, Observable::kPockets);
  };
  EXPECT_NEAR(filled(3e-4), filled(0), 0.01 * filled(0));
}

TEST(TrackingNoise, IsToldFromWhatBallsDo) {
  Random random(4);
  std::vector<SeenFrame> frames;
  for (int f = 0; f < 100; ++f) {
    frames.push_back({f / 250.0, 0, {}});
    for (int i = 0; i < 10; ++i) {
      const double a = i + 4 * frames.back().time;
      frames.back().balls.push_back(
          {i, 0.2 * std::cos(a) + 3e-4 * gaussian(random), 0.2 * std::sin(a) + 3e-4 * gaussian(random), kBall, 0});
    }
  }
  EXPECT_NEAR(noise_of_places(frames), 3e-4, 0.3e-4);
  EXPECT_NEAR(noise_of_places(noisier(frames, 4e-4)), 5e-4, 0.5e-4);
}

// Thrown balls with linear drag, some of which fly into another that hangs in the air.
TEST(FreeFlights, GiveGravityAndDrag) {
  constexpr double kDrag = 0.8;  // [1/s]
  const ObservationLayout layout(18);
  FreeFlights flights(kTip);
  for (int throws = 0; throws < 40; ++throws) {
    const double vx = -1 + 0.05 * throws, vy = 0.6 + 0.02 * throws;
    for (int frame = 0; frame < 30; ++frame) {
      const double t = frame / 250.0, lag = (1 - std::exp(-kDrag * t)) / kDrag;
      const double x = vx * lag, y = -kGravity / kDrag * t + (vy + kGravity / kDrag) * lag;
      // The hanging one is not free, nor is whoever is near it.
      flights.add(throws + t, std::vector<Sighting>{{0, x, y, kBall}, {1, 0.05, kTip - kBall, kBall}});
    }
  }
  Observation seen, slow;
  flights.finish(layout, {}, seen);
  const std::size_t f = layout.first(Observable::kFlight);
  EXPECT_NEAR(seen.value[f], 0, 0.01);
  EXPECT_NEAR(seen.value[f + 1], -kGravity, 0.01);
  EXPECT_NEAR(seen.value[f + 2], -kDrag, 0.01);
  EXPECT_NEAR(seen.value[f + 3], -kDrag, 0.01);
  flights.finish(layout, {0, 0, 0.02}, slow);
  EXPECT_NEAR(slow.value[f + 1], -kGravity / 1.02 / 1.02, 0.01);
}

}  // namespace
}  // namespace tumble::diagnose
