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
  EXPECT_NEAR(angles.departure_deg.value, 50, 2 * frame + 1 + 1e3 * GetParam().noise);
  EXPECT_NEAR(wrap_180(angles.impact_toe_deg.value - land), 0, 3 * frame);
}

INSTANTIATE_TEST_SUITE_P(Rates, Flights,
                         ::testing::Values(Filming{60, 2e-4}, Filming{200, 2e-4}, Filming{100, 1.5e-3},
                                           Filming{200, 1.5e-3}));

// A ball held up on its circle until `leave_deg` and let go there, as balls on a lifter's side are.
TEST(Flights, BeginWhereTheBallIsLetGoNotWhereItsWayFirstLooksLikeAFall) {
  double land = 0;
  std::vector<double> misses;
  for (double leave = 40; leave < 70; leave += 0.5) {
    const auto flights = find_flights(cataract(leave, 4.2, 120, 3e-4, land), kGravity);
    ASSERT_EQ(flights.size(), 1u);
    misses.push_back(degrees(std::atan2(flights[0].start_y, flights[0].start_x)) - leave);
  }
  double mean = 0;
  for (double m : misses) mean += m / static_cast<double>(misses.size());
  EXPECT_NEAR(mean, 0, 1.5);  // half a frame; a tenth of a radius from the fall it was -4 and more
}

// Lengths 3 % too large, or a clock that is 1.5 % off: the flight is still one, and ends where the ball lands.
TEST(Flights, AreWholeWhereTheScaleIsOff) {
  double land = 0;
  auto track = cataract(60, 4.2, 120, 1e-4, land);
  for (TrackPoint& p : track) {
    p.x *= 1.03;
    p.y *= 1.03;
    p.radius = 0.006;
  }
  const auto flights = find_flights(track, kGravity);
  ASSERT_EQ(flights.size(), 1u);
  EXPECT_NEAR(wrap_180(degrees(std::atan2(flights[0].end_y, flights[0].end_x)) - land), 0, 2 * degrees(4.2 / 120));
}

// Landings spread evenly over 100 to 200 degrees, of which each is lost on the way with the same chance per degree:
// most of the far ones.
TEST(Flights, LostOnTheWayDoNotShortenTheImpact) {
  Random random(5);
  std::vector<Flight> flights;
  double lost = 0;
  for (int i = 0; i < 2000; ++i) {
    const double end = random.uniform(100, 200), until = 60 - 100 * std::log(1 - random.uniform());
    const double seen = radians(std::min(end, until));
    flights.push_back({i, 0, 0.3, 0.2 * std::cos(1.0), 0.2 * std::sin(1.0), 0.25 * std::cos(seen),
                       0.25 * std::sin(seen), true, end < until});
    lost += end >= until;
  }
  ASSERT_GT(lost, 1000);
  const Estimate impact = flight_angles(flights, 0.2, 0.01).impact_toe_deg;
  EXPECT_NEAR(impact.value, 150, 2 * impact.se);
  EXPECT_LT(impact.se, 8);
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
