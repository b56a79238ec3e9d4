#include "analysis/charge_statistics.h"

#include <gtest/gtest.h>

#include <cmath>

#include "analysis/charge_motion.h"
#include "analysis/free_surface.h"
#include "core/angle.h"
#include "core/random.h"
#include "core/units.h"

namespace tumble::analysis {
namespace {

// Balls that turn bodily with the mill at omega, of which those below a straight surface are seen: it lies at
// `slope_deg` and passes over the axis. Velocities scatter by `jitter`, uniformly.
ChargeMotion bodily_charge(double slope_deg, double above, double omega, double jitter) {
  MillGeometry geometry;
  geometry.radius = geometry.tip_radius = 0.25;
  geometry.mean_diameter = 0.016;
  geometry.passage_frames = 10;
  geometry.gravity = kGravity;
  ChargeStatistics statistics(geometry);
  Random random(7);
  const double fps = 100, c = std::cos(radians(slope_deg)), s = std::sin(radians(slope_deg));
  for (int f = 0; f < 300; ++f) {
    std::vector<TrackPoint> balls;
    int id = 0;
    for (int row = -18; row <= 18; ++row)
      for (int k = -18; k <= 18; ++k, ++id) {
        const double x0 = (2 * k + (row & 1)) * 0.008, y0 = row * std::sqrt(3.0) * 0.008, turn = omega * f / fps;
        if (std::hypot(x0, y0) > 0.242) continue;
        TrackPoint p;
        p.x = std::cos(turn) * x0 - std::sin(turn) * y0;
        p.y = std::sin(turn) * x0 + std::cos(turn) * y0;
        if (-s * p.x + c * p.y > above) continue;
        p.frame = f;
        p.id = id;
        p.time = f / fps;
        p.vx = -omega * p.y + random.uniform(-jitter, jitter);
        p.vy = omega * p.x + random.uniform(-jitter, jitter);
        p.radius = 0.008;
        balls.push_back(p);
      }
    statistics.add(f, f / fps, 0, balls);
  }
  ChargeMotion motion;
  statistics.finish(motion);
  return motion;
}

TEST(ChargeStatistics, SurfaceAndCirculationOfABodilyTurningChargeAreKnown) {
  const double omega = 3.7, above = 0.06, jitter = 0.3;
  for (const double slope : {-12.0, 0.0, 34.0, 58.0}) {
    const ChargeMotion m = bodily_charge(slope, above, omega, jitter);
    EXPECT_NEAR(m.surface_angle_deg.value, slope, 0.7);
    EXPECT_LT(m.surface_angle_deg.se, 0.5);
    ASSERT_GT(m.surface.size(), 20u);
    const double c = std::cos(radians(slope)), s = std::sin(radians(slope));
    for (const SurfacePoint& p : m.surface) {
      if (std::abs(c * p.x + s * p.y) > 0.2) continue;  // at its ends it meets the shell
      // Centres end there, discs a radius later; half the occupancy lies between.
      EXPECT_NEAR(-s * p.x + c * p.y, above, 0.008) << "at " << p.x << ", " << p.y;
    }
    EXPECT_LT(m.surface.front().x * c + m.surface.front().y * s, m.surface.back().x * c + m.surface.back().y * s);
    EXPECT_NEAR(m.circulation_time.value, 2 * kPi / omega, 0.01 * 2 * kPi / omega);
    // Two components of variance jitter^2 / 3 each, halved.
    EXPECT_NEAR(m.granular_temperature.value, jitter * jitter / 3, 0.1 * jitter * jitter / 3);
    EXPECT_LT(m.flight_share.value, 0.005);
  }
}

TEST(ChargeStatistics, FlightShareIsThatOfTheBallsOnParabolas) {
  std::vector<TrackPoint> tracks;
  const double fps = 100, rho = 0.24, omega = 4, start = 0.2, length = 0.4;
  for (int ball = 0; ball < 30; ++ball) {
    const bool flies = ball < 10;
    const double a0 = radians(40 + 3.0 * ball);
    for (int f = 0; f <= 100; ++f) {
      TrackPoint p;
      p.frame = f;
      p.id = ball;
      p.time = f / fps;
      p.radius = 0.012;
      const double t = flies ? std::clamp(p.time - start, 0.0, length) : 0;
      const double carried = omega * (flies ? std::min(p.time, start) : p.time);
      const double a = a0 + carried;
      p.x = rho * std::cos(a) - omega * rho * std::sin(a) * t;
      p.y = rho * std::sin(a) + omega * rho * std::cos(a) * t - 0.5 * kGravity * t * t;
      tracks.push_back(p);
    }
  }
  Spool<TrackPoint> all;
  all.append(tracks);
  const Estimate share = flight_share(all, find_flights(tracks, kGravity));
  EXPECT_NEAR(share.value, 10.0 / 30 * length * fps / 101, 0.01);
}

// A bed below, and above it balls that lie by chance in five layers, or a bed that is there half of the time: what is
// seen on average is the same, what there is is not.
TEST(FillingOfDeepMill, HoldsForBallsInFlightAndForABedThatSways) {
  constexpr double kLayers = 5, kEach = 0.25;  // of the settled share, in flight
  Field field;
  field.n = 40;
  field.cell = 2.0 / field.n;
  double bed = 0, above = 0;
  for (int k = 0; k < field.n * field.n; ++k) {
    const double x = (k % field.n + 0.5) * field.cell - 1, y = (k / field.n + 0.5) * field.cell - 1;
    const bool inside = std::hypot(x, y) < 1, low = y < -0.2;
    const double by_chance = 1 - std::pow(1 - kEach * kSettledAreaShare, kLayers);
    field.occupancy.push_back(!inside ? kNotGiven : low ? 1.0 : by_chance);
    (low ? bed : above) += inside ? field.cell * field.cell / kPi : 0.0;
  }
  const double swaying = 1 - std::pow(1 - kEach * kSettledAreaShare, kLayers);
  const Estimate filling = filling_of_deep_mill(field, 1.0, kLayers);
  for (const double truth : {bed + kEach * above, bed + swaying * above})
    EXPECT_LT(std::abs(filling.value - truth), 2 * filling.se);
  EXPECT_LT(filling.se, 0.2 * filling.value);
}

TEST(MeasureEdges, AreThoseOfTheWholeMeasurement) {
  RunSetup setup;
  setup.config.mill.diameter = 0.5;
  setup.config.run.frames_per_second = 100;
  setup.mill_speed = 4;
  setup.frame_count = 40;
  setup.balls.radius.assign(150, 0.012);
  setup.balls.mass.assign(150, 0.06);
  std::vector<Frame> frames(40);
  Random random(5);
  for (std::size_t k = 0; k < frames.size(); ++k) {
    Frame& f = frames[k];
    f.time = 0.01 * double(k);
    f.mill_angle = setup.mill_speed * f.time;
    for (std::size_t i = 0; i < setup.balls.size(); ++i) {  // lie in the lower right, more or less
      const double angle = radians(random.uniform(230, 340)), away = random.uniform(0.1, 0.238);
      f.x.push_back(away * std::cos(angle));
      f.y.push_back(away * std::sin(angle));
    }
    f.vx = f.vy = f.angle = f.spin = std::vector<double>(setup.balls.size(), 0.0);
    f.observed.torque = random.uniform(8, 9);
    f.observed.torque_closure = k == 0 ? kNotGiven : random.uniform(8, 9);
  }
  const auto from_start = [&] {
    return [&, next = std::size_t{0}](Frame& frame) mutable {
      if (next == frames.size()) return false;
      frame = frames[next++];
      return true;
    };
  };
  const ChargeMotion motion = measure_frames(setup, from_start());
  const std::vector<ProfileRow>& whole = motion.profile;
  const std::vector<ProfileRow> edges = measure_edges(setup, from_start());
  ASSERT_EQ(edges.size(), whole.size());
  for (std::size_t k = 0; k < whole.size(); ++k) {
    EXPECT_EQ(edges[k].frame, whole[k].frame);
    EXPECT_EQ(edges[k].time, whole[k].time);
    EXPECT_EQ(edges[k].mill_angle_deg, whole[k].mill_angle_deg);
    EXPECT_EQ(edges[k].toe_deg, whole[k].toe_deg);
    EXPECT_EQ(edges[k].shoulder_deg, whole[k].shoulder_deg);
    EXPECT_FALSE(std::isnan(edges[k].toe_deg) || std::isnan(edges[k].shoulder_deg));
  }
  MeansMeasurer measurer(setup);
  for (const Frame& frame : frames) measurer.add(frame);
  const ChargeMotion means = measurer.finish();
  for (const auto of : {&ChargeMotion::torque, &ChargeMotion::torque_closure, &ChargeMotion::toe_deg,
                        &ChargeMotion::toe_bulk_deg, &ChargeMotion::toe_outer_deg, &ChargeMotion::shoulder_deg,
                        &ChargeMotion::shoulder_bulk_deg, &ChargeMotion::shoulder_outer_deg})
    EXPECT_NEAR((means.*of).value, (motion.*of).value, 1e-9);
}

}  // namespace
}  // namespace tumble::analysis
