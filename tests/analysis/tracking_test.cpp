#include "analysis/tracking.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/assignment.h"
#include "core/random.h"

namespace tumble::analysis {
namespace {

TEST(Assignment, TakesTheCheapestWholeNotTheCheapestPair) {
  // Row 0 likes column 0 best, but row 1 can only have column 0.
  const auto chosen = assign({{0, 0, 1.0}, {0, 1, 2.0}, {1, 0, 1.5}}, 10.0);
  EXPECT_EQ(chosen, (std::vector<std::pair<int, int>>{{0, 1}, {1, 0}}));
}

TEST(Assignment, LeavesARowAloneRatherThanPayMore) {
  EXPECT_TRUE(assign({{0, 0, 11.0}}, 10.0).empty());
  EXPECT_EQ(assign({{0, 0, 9.0}, {1, 0, 1.0}}, 10.0), (std::vector<std::pair<int, int>>{{1, 0}}));
}

TEST(Assignment, IsOptimalOnRandomTables) {
  Random random(3);
  for (int trial = 0; trial < 50; ++trial) {
    std::vector<Pairing> table;
    double cost[5][5];
    for (int i = 0; i < 5; ++i)
      for (int j = 0; j < 5; ++j) table.push_back({i, j, cost[i][j] = random.uniform()});
    double got = 0;
    for (const auto& [i, j] : assign(table, 10.0)) got += cost[i][j];
    std::vector<int> order = {0, 1, 2, 3, 4};
    double best = 1e9;
    do {
      double sum = 0;
      for (int i = 0; i < 5; ++i) sum += cost[i][order[i]];
      best = std::min(best, sum);
    } while (std::next_permutation(order.begin(), order.end()));
    EXPECT_NEAR(got, best, 1e-12);
  }
}

struct Scene {
  std::vector<SeenFrame> frames;
  std::vector<std::vector<int>> truth;  // whose each sighting is
};

int count_switches(const Scene& scene) {
  std::map<int, int> last;
  int switches = 0;
  for (std::size_t f = 0; f < scene.frames.size(); ++f)
    for (std::size_t k = 0; k < scene.frames[f].balls.size(); ++k) {
      const int path = scene.frames[f].balls[k].track;
      if (path < 0) continue;
      const auto known = last.find(path);
      if (known != last.end() && known->second != scene.truth[f][k]) ++switches;
      last[path] = scene.truth[f][k];
    }
  return switches;
}

// A carried ring of touching balls, and balls in flight that cross in front of each other, one in ten unseen.
Scene crossing_paths(std::uint64_t seed) {
  Scene scene;
  Random random(seed);
  const double turn = 0.02, g = 0.25;
  for (int f = 0; f < 40; ++f) {
    std::vector<Sighting> here;
    std::vector<int> whose;
    const auto add = [&](int id, double x, double y) {
      if (id >= 100 && random.uniform() < 0.1) return;
      Sighting s;
      s.x = x + random.uniform(-0.3, 0.3);
      s.y = y + random.uniform(-0.3, 0.3);
      s.radius = 12;
      s.score = 0.8;
      here.push_back(s);
      whose.push_back(id);
    };
    for (int k = 0; k < 20; ++k) {
      const double a = -2.0 + 24.5 / 250 * k + turn * f;
      add(k, 250 * std::cos(a), 250 * std::sin(a));
    }
    for (int k = 0; k < 6; ++k) {  // towards each other, meeting about frame 20
      const double side = k % 2 == 0 ? 1 : -1, t = f;
      add(100 + k, side * (-160 + 8.0 * t), 40 * k - 60 + 5 * t - 0.5 * g * t * t);
    }
    scene.frames.push_back({static_cast<double>(f), here});
    scene.truth.push_back(whose);
  }
  return scene;
}

TEST(Tracking, KeepsIdentitiesOfCarriedAndCrossingBalls) {
  for (std::uint64_t seed : {1u, 2u, 3u}) {
    Scene scene = crossing_paths(seed);
    MotionModel model;
    model.turn = 0.02;
    model.gravity_y = -0.25;
    const int paths = link_sightings(scene.frames, model);
    EXPECT_EQ(count_switches(scene), 0);
    EXPECT_LE(paths, 27);  // 26 balls; at most one path broken by a run of unseen frames
  }
}

TEST(Tracking, DropsWhatStandsStillWhileTheMillTurns) {
  std::vector<SeenFrame> frames(60);
  for (int f = 0; f < 60; ++f) {
    Sighting still, carried;
    still.x = 100;
    still.y = 100;
    carried.x = 200 * std::cos(0.03 * f);
    carried.y = 200 * std::sin(0.03 * f);
    still.radius = carried.radius = 10;
    still.score = carried.score = 0.8;
    frames[f] = {static_cast<double>(f), {still, carried}};
  }
  MotionModel model;
  model.turn = 0.03;
  EXPECT_EQ(link_sightings(frames, model), 1);
  EXPECT_EQ(frames[30].balls[0].track, -1);
  EXPECT_EQ(frames[30].balls[1].track, 0);
}

TEST(Tracking, VelocityOfAParabolaIsExact) {
  std::vector<SeenFrame> frames(9);
  for (int f = 0; f < 9; ++f) {
    Sighting s;
    s.x = 3.0 * f;
    s.y = 2.0 * f - 0.5 * 0.4 * f * f;
    s.track = 0;
    s.time = f;
    frames[f] = {static_cast<double>(f), {s}};
  }
  smooth_velocities(frames, 4);
  for (int f = 0; f < 9; ++f) {
    EXPECT_NEAR(frames[f].balls[0].vx, 3.0, 1e-9);
    EXPECT_NEAR(frames[f].balls[0].vy, 2.0 - 0.4 * f, 1e-9);
  }
}

TEST(Tracking, BridgesAFlightAlongItsParabola) {
  std::vector<SeenFrame> frames(12);
  for (int f : {2, 8}) {
    Sighting s;
    s.time = f + 0.25;  // of its row
    s.x = 0.01 * s.time;
    s.y = 0.03 * s.time - 0.002 * s.time * s.time;
    s.vx = 0.01;
    s.vy = 0.03 - 0.004 * s.time;
    s.track = 7;
    s.score = 0.9;
    frames[static_cast<std::size_t>(f)].balls.push_back(s);
  }
  for (std::size_t f = 0; f < frames.size(); ++f) frames[f].time = static_cast<double>(f);
  const auto bridged = bridged_sightings(frames);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    ASSERT_EQ(bridged[f].balls.size(), f > 2 && f < 8 ? 1u : 0u) << f;
    if (bridged[f].balls.empty()) continue;
    const double t = static_cast<double>(f) + 0.25;
    EXPECT_NEAR(bridged[f].balls[0].x, 0.01 * t, 1e-12);
    EXPECT_NEAR(bridged[f].balls[0].y, 0.03 * t - 0.002 * t * t, 1e-12);
    EXPECT_EQ(bridged[f].balls[0].track, 7);
  }
}

// Twenty balls are carried up and fall back, over and over; a bolt and a wedged ball go round with the drum, a lamp
// stands still. Only the ball lies on the shell.
TEST(Tracking, TakesNeitherBoltNorLampForABall) {
  constexpr double kTurn = 0.05;
  std::vector<SeenFrame> frames(140);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    frames[f].time = static_cast<double>(f);
    const auto see = [&](double x, double y) {
      Sighting s;
      s.x = x;
      s.y = y;
      s.radius = 0.01;
      s.deviation = 1e-4;
      s.score = 0.9;
      frames[f].balls.push_back(s);
    };
    const double t = static_cast<double>(f);
    for (int k = 0; k < 20; ++k) {  // to and fro in the lower half
      const double a = 4.7 + 1.2 * std::sin(kTurn * t + 0.3 * k), rho = 0.1 + 0.008 * k;
      see(rho * std::cos(a), rho * std::sin(a));
    }
    see(0.28 * std::cos(kTurn * t), 0.28 * std::sin(kTurn * t));
    see(-0.05, 0.2);
    see(-0.29 * std::cos(kTurn * t), -0.29 * std::sin(kTurn * t));
  }
  MotionModel model;
  model.turn = kTurn;
  model.shell = 0.3;
  link_sightings(frames, model);
  for (const SeenFrame& f : frames) {
    for (std::size_t k = 0; k < 20; ++k) EXPECT_GE(f.balls[k].track, 0);
    EXPECT_EQ(f.balls[20].track, -1);
    EXPECT_EQ(f.balls[21].track, -1);
    EXPECT_GE(f.balls[22].track, 0);
  }
}

}  // namespace
}  // namespace tumble::analysis
