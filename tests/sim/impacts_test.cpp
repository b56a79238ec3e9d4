#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/random.h"
#include "sim/running_mill.h"
#include "tests/support/balls.h"
#include "tests/support/mills.h"

// What the ledger says of impacts, places and falls, against counts that do not use it.
namespace tumble::sim {
namespace {

constexpr double kShell = 0.2725;     // R of the paper's mill [m]
constexpr double kTimeStep = 8.6e-6;  // a hundredth of the impact of two 60 g balls [s]

RunningMill counting(const MillModel& model, const std::vector<Ball>& balls) {
  RunningMill mill = start_mill(model, charge_of(balls));
  mill.ledger.counting_impacts = true;
  return mill;
}
// The paper's mill at rest, without gravity.
MillModel resting_mill() {
  MillModel model = smooth_shell(kShell, 0, springs(0.5), kTimeStep);
  model.shell = make_shell(make_mill_shape(paper_mill().mill));
  return model;
}
template <class Counts>
double sum(const Counts& counts) {
  return std::accumulate(counts.begin(), counts.end(), 0.0);
}
template <class Counts>
double of_face(const Counts& places, Face face) {
  const auto begin = places.begin() + static_cast<int>(face) * kAngleBins;
  return std::accumulate(begin, begin + kAngleBins, 0.0);
}
double kinetic(const RunningMill& mill) { return energies_of(mill).kinetic; }

TEST(Impacts, FallIntoBinsOfEqualRatio) {
  for (double lost = 1e-12; lost < 1e6; lost *= 1.0137) {
    const double bin = std::floor((std::log10(lost) - kLowestDecade) * kBinsPerDecade);
    ASSERT_EQ(spectrum_bin(lost), std::clamp(bin, 0.0, kBins - 1.0)) << lost << " J";
  }
  EXPECT_EQ(spectrum_bin(1e-3), 6 * kBinsPerDecade) << "an edge belongs to the bin above it";
  for (const double nothing : {0.0, -1.0, std::nan("")}) EXPECT_EQ(spectrum_bin(nothing), 0);
}

TEST(Impacts, LoseWhatTheRestitutionTakes) {
  const double speed = 0.8, e = 0.5, m = 0.06;
  const double at_wall = 0.5 * m * speed * speed * (1 - e * e);
  RunningMill wall = counting(smooth_shell(kShell, 0, springs(e), kTimeStep), {{.x = 0.25, .vx = speed}});
  advance_by(wall, 0.05);
  const Impacts& w = wall.ledger.impacts;
  EXPECT_NEAR(sum(w.wall_energy), at_wall, 5e-3 * at_wall);
  EXPECT_EQ(w.ball_wall.total[spectrum_bin(at_wall)], 1);
  EXPECT_EQ(w.ball_wall.normal[spectrum_bin(at_wall)], 1);
  EXPECT_EQ(w.ball_wall.tangential[0], 1) << "no friction, nothing lost by sliding";
  EXPECT_EQ(sum(w.ball_ball.total), 0);

  // Two balls: half the mass, and their closing speed.
  const double between = 0.5 * (m / 2) * 4 * speed * speed * (1 - e * e);
  RunningMill balls =
      counting(smooth_shell(kShell, 0, springs(e), kTimeStep), {{.x = -0.02, .vx = speed}, {.x = 0.02, .vx = -speed}});
  advance_by(balls, 0.02);
  EXPECT_EQ(balls.ledger.impacts.ball_ball.normal[spectrum_bin(between)], 1);
  EXPECT_EQ(sum(balls.ledger.impacts.ball_ball.total), 1);
}

// An oblique impact: the normal part is the head-on one's, all together is what the ball has lost.
TEST(Impacts, ApartByNormalAndTangential) {
  const double speed = 0.8, e = 0.5, m = 0.06;
  RunningMill mill =
      counting(smooth_shell(kShell, 0, springs(e, 0.1), kTimeStep), {{.x = 0.26, .y = 0, .vx = speed, .vy = speed}});
  const double before = kinetic(mill);
  mill.charge.x[0] = 0.2604;  // just off the wall, so that it is met almost at 3 o'clock
  advance_by(mill, 0.004);
  const Impacts& n = mill.ledger.impacts;
  ASSERT_EQ(sum(n.ball_wall.total), 1) << "parted";
  const double lost = before - kinetic(mill), normal = 0.5 * m * speed * speed * (1 - e * e);
  EXPECT_GT(lost, 1.1 * normal);
  EXPECT_NEAR(sum(n.wall_energy), lost, 1e-3 * lost);
  EXPECT_EQ(n.ball_wall.total[spectrum_bin(lost)], 1);
  EXPECT_EQ(n.ball_wall.normal[spectrum_bin(normal)], 1);
  EXPECT_EQ(n.ball_wall.tangential[spectrum_bin(lost - normal)], 1);
}

// A drop through h, then the bounce: e^2 h.
TEST(Falls, AreAsHighAsTheDrop) {
  const double e = 0.6, r = 0.012, start = 0.05, h = start + kShell - r;
  RunningMill mill = counting(smooth_shell(kShell, 9.81, springs(e), kTimeStep), {{.x = 0, .y = start}});
  const auto bin = [](double height) { return static_cast<std::size_t>(kFallBins * height / (2 * kShell)); };
  ASSERT_NE(bin(0.98 * h), bin(h * h));
  advance_by(mill, std::sqrt(2 * h / 9.81) + 0.01);
  EXPECT_EQ(mill.ledger.impacts.falls[bin(h)], 1);
  EXPECT_EQ(sum(mill.ledger.impacts.falls), 1);
  advance_by(mill, 2 * e * std::sqrt(2 * h / 9.81));
  EXPECT_EQ(mill.ledger.impacts.falls[bin(e * e * h)], 1);
  EXPECT_EQ(sum(mill.ledger.impacts.falls), 2);
}

// Thrown upwards, a ball falls from where it turned, not from where it left; and against the roof it falls not at all.
TEST(Falls, CountFromTheHighestPoint) {
  const double up = 1.5, r = 0.012, start = -0.1, h = start + up * up / 2 / 9.81 + kShell - r;
  RunningMill mill = counting(smooth_shell(kShell, 9.81, springs(0.6), kTimeStep), {{.x = 0, .y = start, .vy = up}});
  advance_by(mill, up / 9.81 + std::sqrt(2 * h / 9.81) + 0.01);
  EXPECT_EQ(mill.ledger.impacts.falls[static_cast<std::size_t>(kFallBins * h / (2 * kShell))], 1);

  RunningMill roof = counting(smooth_shell(kShell, 9.81, springs(0.6), kTimeStep), {{.x = 0, .y = 0.2, .vy = 3}});
  advance_by(roof, 0.03);
  EXPECT_EQ(roof.ledger.impacts.falls[0], 1);
}

TEST(Places, ABallIsCountedWhereItWasThrown) {
  struct Throw {
    double across, along, speed_across, speed_out;  // in the frame of a lifter: beside it and out from the axis
    Face face;
    int bins_off;  // of the touch from the lifter's middle, which lies on a bin's edge
  };
  for (const Throw& t : {Throw{0.04, 0.258, -1, 0, Face::kLeading, 0}, Throw{-0.04, 0.258, 1, 0, Face::kTrailing, -1},
                         Throw{0.002, 0.2, 0, 1, Face::kTop, 0}, Throw{0.045, 0.2, 0, 1, Face::kPlate, 1}}) {
    for (const int lifter : {0, 5, 17}) {
      const double a = lifter * kPi / 9, c = std::cos(a), s = std::sin(a);
      const Ball ball{.radius = 0.006,
                      .mass = 0.007,
                      .x = t.along * c - t.across * s,
                      .y = t.along * s + t.across * c,
                      .vx = t.speed_out * c - t.speed_across * s,
                      .vy = t.speed_out * s + t.speed_across * c};
      RunningMill mill = counting(resting_mill(), {ball});
      for (int k = 0; k < 20000 && sum(mill.ledger.impacts.wall_number) == 0; ++k) advance(mill);
      const Impacts& n = mill.ledger.impacts;
      const int bin = (lifter * kAngleBins / 18 + t.bins_off + kAngleBins) % kAngleBins;
      const auto place = static_cast<std::size_t>(static_cast<int>(t.face) * kAngleBins + bin);
      EXPECT_EQ(n.wall_number[place], 1) << "lifter " << lifter << ", face " << int(t.face);
      EXPECT_EQ(sum(n.wall_number), 1);
      EXPECT_EQ(sum(n.lifter_number), t.face == Face::kPlate ? 0 : 1);
      EXPECT_EQ(n.lifter_number[static_cast<std::size_t>(lifter)], t.face == Face::kPlate ? 0 : 1);
    }
  }
}

// A turning mill full of balls that counts from before the first touch: what ended impacts have lost at their places,
// with what contacts that still last have lost so far, is all that was lost at the wall.
TEST(Places, HoldAllThatIsLostAtTheWall) {
  MillModel model = resting_mill();
  model.gravity = 9.81;
  model.speed = 0.7 * std::sqrt(9.81 / kShell);
  model.ball = springs(0.8, 0.2);
  model.wall = springs(0.4, 0.2);
  model.time_step = 4e-5;
  std::vector<Ball> balls;
  Random random(3);
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j)
      balls.push_back({.x = 0.04 * (i - 3.5) + random.uniform(-0.005, 0.005), .y = 0.04 * (j - 3.5)});
  RunningMill mill = counting(model, balls);
  advance_by(mill, 2);

  const Impacts& n = mill.ledger.impacts;
  double lasting = 0;
  for (const Kind kind : {Kind::kPlate, Kind::kLifters})
    for (const Contact& contact : contacts_of(mill, kind))
      lasting += contact.state.normal_lost + contact.state.sliding_lost;
  const auto lost = [&](Cause cause) { return mill.ledger.dissipated[static_cast<std::size_t>(cause)]; };
  const double all = lost(Cause::kBallWallNormal) + lost(Cause::kBallWallSliding);
  ASSERT_GT(all, 1);
  EXPECT_NEAR(sum(n.wall_energy) + lasting, all, 1e-9 * all);
  EXPECT_EQ(sum(n.wall_number), sum(n.ball_wall.total));

  // Every face has its share, and the lifters have what the faces have that are theirs.
  double on_lifters = 0, energy_on_lifters = 0;
  for (const Face face : {Face::kLeading, Face::kTop, Face::kTrailing}) {
    EXPECT_GT(of_face(n.wall_number, face), 0) << int(face);
    on_lifters += of_face(n.wall_number, face);
    energy_on_lifters += of_face(n.wall_energy, face);
  }
  EXPECT_GT(of_face(n.wall_number, Face::kPlate), 0);
  EXPECT_EQ(sum(n.lifter_number), on_lifters);
  EXPECT_NEAR(sum(n.lifter_energy), energy_on_lifters, 1e-9 * all);
}

}  // namespace
}  // namespace tumble::sim
