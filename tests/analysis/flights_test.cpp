#include "analysis/flights.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/angle.h"
#include "core/random.h"
#include "core/units.h"

namespace tumble::analysis {
namespace {

// Carried up on a circle until `leave_deg`, then a parabola until it meets the circle again, then carried.
std::vector<TrackPoint> cataract(double leave_deg, double omega, double fps, double noise, double& land_deg) {
  const double rho = 0.24;
  std::vector<TrackPoint> track;
  Random random(11);
  const double leave = radians(leave_deg), x0 = rho * std::cos(leave), y0 = rho * std::sin(leave);
  const double vx = -omega * y0, vy = omega * x0, start = 0.4;
  double landed_at = -1;
  for (int f = 0; f < static_cast<int>(1.2 * fps); ++f) {
    TrackPoint p;
    p.frame = f;
    p.time = f / fps;
    p.radius = 0.012;
    const double t = p.time - start;
    double a = leave + omega * t;
    p.x = rho * std::cos(a);
    p.y = rho * std::sin(a);
    if (t > 0 && landed_at < 0) {
      p.x = x0 + vx * t;
      p.y = y0 + vy * t - 0.5 * kGravity * t * t;
      if (std::hypot(p.x, p.y) > rho) {
        landed_at = p.time;
        land_deg = wrap_360(degrees(std::atan2(p.y, p.x)));
      }
    }
    if (landed_at >= 0) {
      a = radians(land_deg) + omega * (p.time - landed_at);
      p.x = rho * std::cos(a);
      p.y = rho * std::sin(a);
    }
    p.x += random.uniform(-noise, noise);
    p.y += random.uniform(-noise, noise);
    track.push_back(p);
  }
  return track;
}

struct Filming {
  double fps, noise;  // [m]: 0.2, and 1 px of a usual film
};
class Flights : public ::testing::TestWithParam<Filming> {};

TEST_P(Flights, StartWhereTheBallLeavesTheShellAndEndWhereItLands) {
  double land = 0;
  const auto track = cataract(50, 4.2, GetParam().fps, GetParam().noise, land);
  const auto flights = find_flights(track, kGravity);
  ASSERT_EQ(flights.size(), 1u);
  const FlightAngles angles = flight_angles(flights, 0.2, 0.1);
  const double frame = degrees(4.2 / GetParam().fps);  // the ball's turn in a frame
  // It hugs the circle at first, the longer the more places are blurred.
  EXPECT_NEAR(angles.departure_deg.value, 50, 3 * frame + 3 + 3e3 * GetParam().noise);
  EXPECT_NEAR(wrap_180(angles.impact_toe_deg.value - land), 0, 3 * frame);
}

INSTANTIATE_TEST_SUITE_P(Rates, Flights,
                         ::testing::Values(Filming{60, 2e-4}, Filming{200, 2e-4}, Filming{100, 1.5e-3},
                                           Filming{200, 1.5e-3}));

TEST(Flights, LostOnTheWayAreAnErrorOfTheImpact) {
  std::vector<Flight> flights;
  for (int i = 0; i < 20; ++i) {
    const double end = radians(180 + 2 * i);
    flights.push_back({i, 0, 0.3, 0.2, 0.1, 0.25 * std::cos(end), 0.25 * std::sin(end), true, true});
  }
  const FlightAngles all_seen = flight_angles(flights, 0.2, 0.1);
  for (int i = 0; i < 10; ++i) flights.push_back({20 + i, 0, 0.1, 0.2, 0.1, 0.1, 0.2, true, false});
  const FlightAngles some_lost = flight_angles(flights, 0.2, 0.05);
  EXPECT_EQ(some_lost.impact_toe_deg.value, all_seen.impact_toe_deg.value);
  EXPECT_NEAR(some_lost.impact_toe_deg.se, std::hypot(all_seen.impact_toe_deg.se, 10), 0.5);
}

TEST(Flights, AreNotSeenInACarriedCharge) {
  std::vector<TrackPoint> track;
  for (int f = 0; f < 300; ++f) {
    TrackPoint p;
    p.frame = f;
    p.time = f / 200.0;
    p.x = 0.24 * std::cos(4.2 * p.time);
    p.y = 0.24 * std::sin(4.2 * p.time);
    p.radius = 0.012;
    track.push_back(p);
  }
  EXPECT_TRUE(find_flights(track, kGravity).empty());
}

}  // namespace
}  // namespace tumble::analysis
