#include "sim/shell.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/random.h"
#include "core/units.h"
#include "tests/support/shells.h"

namespace tumble::sim {
namespace {

using Vec2 = Eigen::Vector2d;

// Distance to the nearest of the straight pieces of the whole outline, and whether the point is inside it: a way to the
// same numbers that knows neither faces, runs nor lifters.
struct Outline {
  std::vector<Vec2> points;
  explicit Outline(const MillShape& shape) : points(outline(shape, 5e-4)) {}

  double distance(const Vec2& p) const {
    double nearest = INFINITY;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec2 a = points[i], d = points[(i + 1) % points.size()] - a;
      const double t = std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (a + t * d - p).norm());
    }
    return nearest;
  }
  bool holds(const Vec2& p) const {
    bool inside = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Vec2 &a = points[i], &b = points[(i + 1) % points.size()];
      if ((a.y() > p.y()) != (b.y() > p.y()) && p.x() < a.x() + (b.x() - a.x()) * (p.y() - a.y()) / (b.y() - a.y()))
        inside = !inside;
    }
    return inside;
  }
};

Vec2 random_place(Random& random, double radius) {
  const double rho = radius * std::sqrt(random.uniform(0.2, 1)), a = random.uniform(0, 2 * kPi);
  return {rho * std::cos(a), rho * std::sin(a)};
}

double nearest_of_all(const Shell& shell, const Vec2& p) {
  double nearest = INFINITY;
  for (int f = 0; f < feature_count(shell); ++f)
    nearest = std::min(nearest, nearest_on_wall(shell, {}, f, p.x(), p.y()).distance);
  return nearest;
}

// From any free place, the nearest wall is as far as the outline is, in the direction that the wall says.
TEST(Shell, NearestWallIsTheOutline) {
  std::vector<NamedMill> mills = mills_of_every_profile();
  Random random(3);
  for (int k = 0; k < 60; ++k) mills.push_back({"random " + std::to_string(k), random_shell(random)});
  for (const NamedMill& mill : mills) {
    const MillShape shape = make_mill_shape(mill.config);
    const Shell shell = make_shell(shape);
    const Outline edge(shape);
    int seen = 0;
    for (int k = 0; k < 100; ++k) {
      const Vec2 p = random_place(random, shape.radius - 1e-3);
      if (!edge.holds(p)) {
        EXPECT_GE(lifter_around(shell, p.x(), p.y()), 0) << mill.name << " at " << p.transpose();
        EXPECT_LT(nearest_of_all(shell, p), 1e-6) << mill.name << ": in the steel at " << p.transpose();
        continue;
      }
      ++seen;
      EXPECT_EQ(lifter_around(shell, p.x(), p.y()), -1) << mill.name << " at " << p.transpose();
      EXPECT_NEAR(nearest_of_all(shell, p), edge.distance(p), 1e-6) << mill.name << " at " << p.transpose();
      for (int f = 0; f < feature_count(shell); ++f) {
        const WallPoint w = nearest_on_wall(shell, {}, f, p.x(), p.y());
        ASSERT_GT(w.distance, 0) << mill.name << " at " << p.transpose();
        if (w.distance > 0.1) continue;
        EXPECT_NEAR(w.nx * w.nx + w.ny * w.ny, 1, 1e-12) << mill.name;
        const Vec2 touched = p + w.distance * Vec2(w.nx, w.ny);
        if (edge.holds(touched * 0.9999)) {
          EXPECT_LT(edge.distance(touched), 1e-4) << mill.name << ": a wall of air";
        }
      }
    }
    EXPECT_GT(seen, 10) << mill.name;
  }
}

// A centre in the steel is pushed out the shortest way, by one run alone.
TEST(Shell, SteelPushesOut) {
  Random random(5);
  for (const NamedMill& mill : mills_of_every_profile()) {
    const MillShape shape = make_mill_shape(mill.config);
    const Shell shell = make_shell(shape);
    const Outline edge(shape);
    int seen = 0;
    for (int k = 0; k < 3000 && seen < 40; ++k) {
      const Vec2 p = random_place(random, shape.radius - 1e-3);
      const int lifter = lifter_around(shell, p.x(), p.y());
      if (lifter < 0) continue;
      ++seen;
      int pushing = 0;
      for (int f = 1; f < feature_count(shell); ++f) {
        if (lifter_of(shell, f) != lifter) continue;
        const WallPoint w = nearest_on_wall(shell, {}, f, p.x(), p.y());
        if (w.distance >= 0) continue;
        ++pushing;
        const Vec2 out = p + (w.distance - 2e-6) * Vec2(w.nx, w.ny);
        if (out.norm() < shape.radius) {
          EXPECT_TRUE(edge.holds(out)) << mill.name << " at " << p.transpose();
        }
      }
      EXPECT_EQ(pushing, 1) << mill.name << " at " << p.transpose();
    }
    EXPECT_GT(seen, 5) << mill.name;
  }
}

// What a ball feels of a feature, its overlap, changes by no more than the ball moves: nothing comes out of nowhere.
TEST(Shell, OverlapIsContinuous) {
  Random random(11);
  std::vector<NamedMill> mills = mills_of_every_profile();
  for (int k = 0; k < 15; ++k) mills.push_back({"random " + std::to_string(k), random_shell(random)});
  for (const NamedMill& mill : mills) {
    const Shell shell = make_shell(make_mill_shape(mill.config));
    for (const double radius : {0.003, 0.012, 0.025}) {
      Vec2 p(0, 0.95 * shell.tip_radius - radius), v(0.6, 0.8);
      std::vector<double> before(static_cast<std::size_t>(feature_count(shell)), 0.0), now = before;
      double deepest = 0;
      for (int k = 0; k < 4000; ++k) {
        // On, turned aside a little, drawn outwards, and thrown back where a wall is entered by a twentieth of the
        // radius.
        const double step = 0.02 * radius, turn = random.uniform(-0.3, 0.3);
        v = Vec2(v.x() * std::cos(turn) - v.y() * std::sin(turn), v.x() * std::sin(turn) + v.y() * std::cos(turn));
        v = (v + 0.05 * p.normalized()).normalized();
        const Vec2 next = p + step * v;
        bool inside = false;
        for (int f = 0; f < feature_count(shell); ++f) {
          const WallPoint w = nearest_on_wall(shell, {}, f, next.x(), next.y());
          now[static_cast<std::size_t>(f)] = std::max(0.0, radius - w.distance);
          if (radius - w.distance > 0.05 * radius && v.dot(Vec2(w.nx, w.ny)) > 0) {
            inside = true;
            v -= 2 * v.dot(Vec2(w.nx, w.ny)) * Vec2(w.nx, w.ny);
          }
          if (w.distance < radius) {
            EXPECT_TRUE(may_touch(shell, {}, f, next.x(), next.y(), radius)) << mill.name;
          }
        }
        for (std::size_t f = 0; f < now.size(); ++f) {
          EXPECT_LE(std::abs(now[f] - before[f]), step * (1 + 1e-9))
              << mill.name << " feature " << f << " radius " << radius << " at " << p.transpose();
          deepest = std::max(deepest, now[f] / radius);
        }
        if (inside) {
          for (int f = 0; f < feature_count(shell); ++f)
            before[static_cast<std::size_t>(f)] =
                std::max(0.0, radius - nearest_on_wall(shell, {}, f, p.x(), p.y()).distance);
        } else {
          p = next;
          before = now;
        }
      }
      EXPECT_GT(deepest, 0.02) << mill.name << ": never met a wall";
    }
  }
}

// Looking up by angle finds what looking at all features finds, in order, for any mill angle and ball size.
TEST(Shell, FeaturesNearABall) {
  std::vector<NamedMill> mills = mills_of_every_profile();
  for (const int lifters : {1, 2, 60}) {
    Config config = paper_mill();
    config.mill.lifters.count = lifters;
    config.mill.lifters.width = lifters == 60 ? 0.005 : 0.02;
    mills.push_back({std::to_string(lifters), config});
  }
  for (const NamedMill& mill : mills) {
    const Shell shell = make_shell(make_mill_shape(mill.config));
    Random random(7);
    for (int k = 0; k < 300; ++k) {
      const double angle = random.uniform(0, 1000), direction = random.uniform(0, 2 * kPi);
      const double rho = random.uniform(0, 0.26), reach = random.uniform(0.005, 0.12);
      const double x = rho * std::cos(direction), y = rho * std::sin(direction);
      const ShellPose pose = pose_of(angle);
      std::vector<NearFeature> near;
      features_near(shell, pose, x, y, reach, near);
      std::vector<int> found;
      for (const NearFeature& f : near) found.push_back(f.feature);
      EXPECT_TRUE(std::is_sorted(found.begin(), found.end()));
      for (int f = 0; f < feature_count(shell); ++f) {
        const WallPoint w = nearest_on_wall(shell, pose, f, x, y);
        const bool listed = std::find(found.begin(), found.end(), f) != found.end();
        if (w.distance < reach && w.distance > -reach) {
          EXPECT_TRUE(listed) << mill.name << " feature " << f;
        }
        if (listed) {
          EXPECT_TRUE(may_touch(shell, pose, f, x, y, reach)) << mill.name << " feature " << f;
        }
      }
    }
  }
}

// A ball in a re-entrant corner lies on two features, on a rounded edge or a wave's crest on one.
TEST(Shell, CornersCountTwiceAndCrestsOnce) {
  const auto touching = [](const std::string& name, double x, double y, double radius) {
    for (const NamedMill& mill : mills_of_every_profile()) {
      if (mill.name != name) continue;
      const Shell shell = make_shell(make_mill_shape(mill.config));
      int n = 0;
      for (int f = 0; f < feature_count(shell); ++f) n += nearest_on_wall(shell, {}, f, x, y).distance < radius;
      return n;
    }
    return -1;
  };
  const double r = 0.003, in = r - 1e-5, shell = 0.2725;
  EXPECT_EQ(touching("hook", shell - 0.02 + in, 0.004 + in, r), 2) << "under the hook";
  EXPECT_EQ(touching("hook", shell - 0.03 - in, 0.005, r), 1) << "on top";
  EXPECT_EQ(touching("worn rectangle", shell - 0.016 - in, 0.0, r), 1);
  EXPECT_EQ(touching("worn rectangle", shell - 0.010 - (0.006 + in) * std::sqrt(0.5),
                     0.004 + (0.006 + in) * std::sqrt(0.5), r),
            1)
      << "on the rounded edge";
  EXPECT_EQ(touching("wave", shell - 0.02 - in, 0.0, r), 1) << "on the crest";
}

// Faces by the direction they look in.
TEST(Shell, FacesByTheirNormals) {
  const Shell shell = make_shell(make_mill_shape(paper_mill()));
  const auto face = [&](double x, double y) { return nearest_on_wall(shell, {}, 1, x, y).face; };
  EXPECT_EQ(face(0.24, 0.0), Face::kTop);
  EXPECT_EQ(face(0.26, 0.02), Face::kLeading);
  EXPECT_EQ(face(0.26, -0.02), Face::kTrailing);
  EXPECT_EQ(face(0.24, 0.02), Face::kLeading) << "a corner: between top and leading face";
  EXPECT_EQ(nearest_on_wall(shell, {}, 0, 0.2, 0.1).face, Face::kPlate);
  const Shell wave = make_shell(make_mill_shape(mill_with_profile(LifterProfile::kWave)));
  EXPECT_EQ(nearest_on_wall(wave, {}, 1, 0.24, 0.0).face, Face::kTop);
  const double trough = kPi / 18 - 1e-3;
  EXPECT_EQ(nearest_on_wall(wave, {}, 1, 0.26 * std::cos(trough), 0.26 * std::sin(trough)).face, Face::kPlate);
}

}  // namespace
}  // namespace tumble::sim
