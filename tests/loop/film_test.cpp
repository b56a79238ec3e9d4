#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <vector>

#include "analysis/charge_motion.h"
#include "core/angle.h"
#include "tests/support/filmed_mill.h"
#include "tests/support/mills.h"

// The whole path: a mill is simulated, filmed, and the film alone must give back what the simulation knew.
// Bounds are those the project promises for its own films (docs/film-analysis.md).
namespace tumble {
namespace {

struct Case {
  double speed;
  LifterProfile profile;
  bool mirror;
};

std::string name(const testing::TestParamInfo<Case>& info) {
  return std::string(name_of(info.param.profile)) + "_" + std::to_string(std::lround(info.param.speed * 100)) +
         (info.param.mirror ? "_clockwise" : "_counter_clockwise");
}

Config mill_of(const Case& c, double revolutions, double frames_per_second) {
  Config config = paper_mill();
  config.mill.speed = c.speed;
  config.mill.lifters.profile = c.profile;
  config.run.spin_up = 1;
  config.run.revolutions = revolutions;
  config.run.frames_per_second = frames_per_second;
  return config;
}

ChargeMotion truth_of(const SimulatedMill& mill) {
  std::size_t next = 0;
  return analysis::measure_frames(mill.setup, [&](Frame& f) {
    if (next == mill.frames.size()) return false;
    f = mill.frames[next++];
    return true;
  });
}

// What a laboratory knows of its mill: the drawing and the ball sizes.
Config drawing_of(const Config& config) {
  Config drawing;
  drawing.mill.diameter = config.mill.diameter;
  drawing.mill.lifters = config.mill.lifters;
  drawing.charge.balls = config.charge.balls;
  return drawing;
}

class Film {
 public:
  Film(const SimulatedMill& mill, bool mirror, int fps) {
    render::Style style;
    style.mirror = mirror;
    film(mill, style, fps, path());
  }
  ~Film() { std::filesystem::remove(path()); }
  std::string path() const { return testing::TempDir() + "film_" + std::to_string(id_) + ".mp4"; }

 private:
  static inline int last_ = 0;
  int id_ = ++last_ + 1000 * static_cast<int>(getpid() % 100000);
};

class FilmedMill : public testing::TestWithParam<Case> {};

TEST_P(FilmedMill, GivesBackToeShoulderAndSpeed) {
  const Case& c = GetParam();
  const SimulatedMill mill = simulate_in_memory(mill_of(c, 2, 60));
  const ChargeMotion truth = truth_of(mill);
  const Film film(mill, c.mirror, 60);
  const Config drawing = drawing_of(mill.setup.config);
  analysis::FilmOptions options;
  options.mill = &drawing;
  const ChargeMotion seen = analysis::measure_film(film.path(), options);

  EXPECT_EQ(seen.rotation, c.mirror ? Rotation::kClockwise : Rotation::kCounterClockwise);
  EXPECT_NEAR(seen.speed_rpm.value / truth.speed_rpm.value, 1, 0.005);
  EXPECT_LT(std::abs(wrap_180(seen.toe_deg.value - truth.toe_deg.value)), 2)
      << seen.toe_deg.value << " for " << truth.toe_deg.value;
  EXPECT_LT(std::abs(wrap_180(seen.shoulder_deg.value - truth.shoulder_deg.value)), 2)
      << seen.shoulder_deg.value << " for " << truth.shoulder_deg.value;
  EXPECT_NEAR(seen.filling.value / truth.filling.value, 1, 0.03);
  std::printf("             toe %.2f for %.2f  shoulder %.2f for %.2f  speed %.3f for %.3f rev/min\n",
              seen.toe_deg.value, truth.toe_deg.value, seen.shoulder_deg.value, truth.shoulder_deg.value,
              seen.speed_rpm.value, truth.speed_rpm.value);
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const double speed : {0.5, 0.7, 0.9})
    for (const auto profile : {LifterProfile::kRectangle, LifterProfile::kTriangle})
      for (const bool mirror : {false, true}) cases.push_back({speed, profile, mirror});
  return cases;
}

INSTANTIATE_TEST_SUITE_P(All, FilmedMill, testing::ValuesIn(all_cases()), name);
// What every change must pass: the fastest film, clockwise, and the slowest with the shallowest lifters.
INSTANTIATE_TEST_SUITE_P(Hard, FilmedMill,
                         testing::Values(Case{0.9, LifterProfile::kRectangle, true},
                                         Case{0.5, LifterProfile::kTriangle, false}),
                         name);

// At 200 frames/s, ball by ball against the simulation's positions.
class FastFilm : public testing::TestWithParam<Case> {};

TEST_P(FastFilm, FindsAndFollowsTheBalls) {
  const Case& c = GetParam();
  const SimulatedMill mill = simulate_in_memory(mill_of(c, 0.4, 200));
  const Film film(mill, c.mirror, 200);
  const Config drawing = drawing_of(mill.setup.config);
  analysis::FilmOptions options;
  options.mill = &drawing;
  const ChargeMotion seen = analysis::measure_film(film.path(), options);
  const double metres_per_pixel = 0.2725 / 302.4;  // the renderer's plan: R is 302.4 px high in a picture of 720

  std::size_t found = 0, switches = 0;
  double squares = 0, squares_px = 0;
  std::map<int, std::size_t> ball_of_track;
  for (const TrackPoint& p : seen.tracks) {
    const Frame& f = mill.frames[static_cast<std::size_t>(p.frame)];
    std::size_t nearest = 0;
    double best = INFINITY;
    for (std::size_t b = 0; b < f.x.size(); ++b) {
      const double d = std::hypot(p.x - f.x[b], p.y - f.y[b]);
      if (d < best) best = d, nearest = b;
    }
    if (best > mill.setup.balls.radius[nearest] / 2) continue;  // a false ball
    ++found;
    squares += best * best;
    const double u = 399.5 + (c.mirror ? -1 : 1) * f.x[nearest] / metres_per_pixel;  // the renderer's plan
    const double v = 359.5 - f.y[nearest] / metres_per_pixel;
    squares_px += (p.u_px - u) * (p.u_px - u) + (p.v_px - v) * (p.v_px - v);
    const auto [track, is_new] = ball_of_track.try_emplace(p.id, nearest);
    if (!is_new && track->second != nearest) ++switches, track->second = nearest;
  }
  const double truth = double(mill.frames.size() * mill.setup.balls.size());
  const double recall = double(found) / truth, rmse_px = std::sqrt(squares_px / double(found));
  const double rmse_mm = 1e3 * std::sqrt(squares / double(found));
  const double false_share = double(seen.tracks.size() - found) / double(seen.tracks.size());
  EXPECT_GE(recall, 0.98);
  EXPECT_LE(false_share, 0.01);
  EXPECT_LE(rmse_px, 0.5);
  EXPECT_NEAR(seen.camera.centre_u_px, 399.5, 0.8);  // by less than half a turn of the drum
  EXPECT_NEAR(seen.camera.centre_v_px, 359.5, 0.5);
  EXPECT_LE(double(switches) / double(found), 1e-3);
  std::printf("             recall %.4f  false %.4f  RMSE %.3f px %.3f mm  switches %zu of %zu\n", recall, false_share,
              rmse_px, rmse_mm, switches, found);
}

INSTANTIATE_TEST_SUITE_P(
    All, FastFilm,
    testing::Values(Case{0.5, LifterProfile::kRectangle, true}, Case{0.5, LifterProfile::kTriangle, false},
                    Case{0.7, LifterProfile::kRectangle, false}, Case{0.7, LifterProfile::kTriangle, true},
                    Case{0.9, LifterProfile::kRectangle, true}, Case{0.9, LifterProfile::kTriangle, false}),
    name);
INSTANTIATE_TEST_SUITE_P(Hard, FastFilm,
                         testing::Values(Case{0.7, LifterProfile::kRectangle, true},
                                         Case{0.9, LifterProfile::kTriangle, false}),
                         name);

}  // namespace
}  // namespace tumble
