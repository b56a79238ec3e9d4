#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "analysis/charge_motion.h"
#include "core/angle.h"
#include "core/error.h"
#include "tests/analysis/painted_mill.h"

namespace tumble::analysis {
namespace {

namespace fs = std::filesystem;

struct PaintedFilm {
  std::string path;
  std::vector<std::vector<PaintedBall>> balls;  // by frame
  PaintedMill mill;
};

constexpr int kFrames = 60;
constexpr double kStep = 0.035;  // turn per frame [rad]
constexpr double kRate = 50;     // frames/s

// Turn of a ball's painted line from frame to frame [rad]: as if neighbours geared into each other.
double spin_of(std::size_t ball) { return kStep + 0.12 * (static_cast<double>(ball % 3) - 1); }

// A bed that turns bodily with the drum, out to the shell between the lifters, and three balls in flight.
PaintedFilm paint_film(const std::string& name, bool clockwise) {
  PaintedFilm film;
  film.path = (fs::path(::testing::TempDir()) / name).string();
  PaintedMill& m = film.mill;
  m.lifter_height = 14;
  const double r = 9.0, sense = clockwise ? -1 : 1;
  std::vector<PaintedBall> bed;  // about the axis, y up, at frame 0
  for (int k = 0; k < 5; ++k)    // in each of five pockets two balls against the shell, and rows further in
    for (int side = -1; side <= 1; side += 2) {
      const double a = 2 * kPi / m.lifters * (k - 5 + 0.5) + side * (r + 0.1) / (m.radius - r);
      bed.push_back({(m.radius - r) * std::cos(a), (m.radius - r) * std::sin(a), r, 0.4 * k + side});
    }
  for (int row = 0; row < 3; ++row)
    for (int k = 0; k < 8 - row; ++k) {
      const double rho = m.radius - m.lifter_height - r - 1 - row * 2 * r, a = -2.45 + (k + 0.5 * row) * 2.02 * r / rho;
      bed.push_back({rho * std::cos(a), rho * std::sin(a), r, 0.9 * k + row});
    }
  cv::VideoWriter writer(film.path, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), kRate, {m.width, m.height});
  for (int f = 0; f < kFrames; ++f) {
    std::vector<PaintedBall> here;
    const double c = std::cos(kStep * f), s = std::sin(kStep * f);
    for (std::size_t k = 0; k < bed.size(); ++k) {
      PaintedBall b = bed[k];
      const double x = c * b.u - s * b.v, y = s * b.u + c * b.v;
      b.u = m.u + sense * x;
      b.v = m.v - y;
      b.mark += spin_of(k) * f;
      if (clockwise) b.mark = kPi - b.mark;
      here.push_back(b);
    }
    for (int k = 0; k < 3; ++k) {
      const double t = f - 20 * k, g = 1e3 * kGravity / (kRate * kRate);  // a pixel is a millimetre
      if (t < 0 || t > 13) continue;
      here.push_back({m.u + sense * (60 - 9.0 * t), m.v - (40 + 18.0 * t - 0.5 * g * t * t), r, 0.0});
    }
    PaintedMill turned = m;
    turned.angle = sense * kStep * f;
    if (clockwise) turned.angle += kPi;
    writer.write(paint(turned, here, 100 + static_cast<std::uint64_t>(f)));
    film.balls.push_back(here);
  }
  return film;
}

class Film : public ::testing::TestWithParam<bool> {};  // clockwise

TEST_P(Film, GivesAwayTheMillItsTurnAndItsBalls) {
  const bool clockwise = GetParam();
  const PaintedFilm film = paint_film(clockwise ? "clockwise.avi" : "counter_clockwise.avi", clockwise);
  Config known;
  known.mill.diameter = 0.3012;
  known.charge.balls = {{0.009, 0.02, 1.0}};
  FilmOptions options;
  options.mill = &known;
  const ChargeMotion motion = measure_film(film.path, options);

  EXPECT_EQ(motion.frames, kFrames);
  EXPECT_EQ(motion.rotation, clockwise ? Rotation::kClockwise : Rotation::kCounterClockwise);
  EXPECT_EQ(motion.lifter_count, film.mill.lifters);
  EXPECT_NEAR(motion.speed_rpm.value, rpm_from_rad_s(kStep * kRate), 0.005 * rpm_from_rad_s(kStep * kRate));
  // Paint has no perspective; through the lens that is supposed, the glass is nearer than the balls by 2 %.
  EXPECT_NEAR(motion.camera.radius_px, film.mill.radius, 0.035 * film.mill.radius);
  EXPECT_NEAR(motion.camera.centre_u_px, film.mill.u, 0.5);
  EXPECT_NEAR(motion.camera.centre_v_px, film.mill.v, 0.5);
  EXPECT_NEAR(motion.camera.metres_per_pixel, 0.001, 3.5e-5);

  int found = 0, all = 0, switches = 0, spins = 0, right = 0;
  double squares = 0;
  std::map<int, std::size_t> owner;
  std::vector<std::vector<const TrackPoint*>> seen(kFrames);
  const std::vector<TrackPoint> tracks = motion.tracks.read(0, motion.tracks.size());
  for (const TrackPoint& p : tracks) seen[static_cast<std::size_t>(p.frame)].push_back(&p);
  for (int f = 0; f < kFrames; ++f)
    for (std::size_t k = 0; k < film.balls[f].size(); ++k) {
      ++all;
      for (const TrackPoint* p : seen[static_cast<std::size_t>(f)]) {
        const double miss = std::hypot(p->u_px - film.balls[f][k].u, p->v_px - film.balls[f][k].v);
        if (miss > 4.5) continue;
        ++found;
        squares += miss * miss;
        const bool in_bed = k < 31;  // the bed keeps its order from frame to frame
        if (in_bed && owner.count(p->id) && owner[p->id] != k) ++switches;
        if (in_bed) owner[p->id] = k;
        if (!in_bed || std::isnan(p->spin)) continue;
        ++spins;
        right += std::abs(p->spin / kRate - spin_of(k)) < 0.05;
      }
    }
  EXPECT_GE(found, 0.98 * all);
  EXPECT_LE(static_cast<double>(motion.tracks.size()), 1.01 * found);
  EXPECT_LT(std::sqrt(squares / found), 0.7);  // balls of 9 px under one hard lamp
  EXPECT_EQ(switches, 0);
  EXPECT_GT(spins, 0.3 * found);
  EXPECT_GE(right, 0.98 * spins);
  // Mirrored where clockwise: carried balls move counter-clockwise in the mill's own frame.
  for (const TrackPoint& p : motion.tracks) {
    if (std::hypot(p.x, p.y) < 0.138 || std::isnan(p.vx)) continue;
    EXPECT_GT(p.x * p.vy - p.y * p.vx, 0);
  }
  fs::remove(film.path);
}

INSTANTIATE_TEST_SUITE_P(BothWays, Film, ::testing::Bool());

TEST(FilmInput, NamesWhatIsWrong) {
  const fs::path folder = fs::path(::testing::TempDir()) / "film_input";
  fs::create_directories(folder);
  const std::string text = (folder / "text.mp4").string();
  std::ofstream(text) << "not a film\n";
  EXPECT_THROW(measure_film(text, {}), InputError);
  EXPECT_THROW(measure_film((folder / "absent.mp4").string(), {}), InputError);
  EXPECT_THROW(measure_film(folder.string(), {}), InputError);
  EXPECT_THROW(measure_stills(folder.string(), {}), InputError);  // no pictures in it
  const std::string grey = (folder / "grey.avi").string();
  {
    cv::VideoWriter writer(grey, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25, {320, 240});
    for (int f = 0; f < 30; ++f) writer.write(cv::Mat(240, 320, CV_8UC3, cv::Scalar(90, 90, 90)));
  }
  try {
    measure_film(grey, {});
    FAIL() << "a film without a mill was taken";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("no turning drum"), std::string::npos) << e.what();
  }
  fs::remove_all(folder);
}

TEST(Stills, GiveToeAndShoulderOfAPaintedBed) {
  const fs::path folder = fs::path(::testing::TempDir()) / "stills";
  fs::create_directories(folder);
  PaintedMill mill = large_painted_mill();
  const double r = 7;
  std::vector<PaintedBall> balls;
  for (const PaintedBall& b : packed_bed(mill, r, 35, 3)) balls.push_back(b);
  // The bed's surface is the chord y cos 35 - x sin 35 = -0.15 R: it meets the ring's middle at these angles.
  const double ring = mill.radius - mill.lifter_height - r, away = degrees(std::acos(0.15 * mill.radius / ring));
  for (int i = 0; i < 3; ++i) {
    mill.angle = 0.2 * i;
    cv::imwrite((folder / ("still" + std::to_string(i) + ".png")).string(),
                paint(mill, balls, 40 + static_cast<std::uint64_t>(i)));
  }
  const ChargeMotion motion = measure_stills(folder.string(), {});
  EXPECT_NEAR(wrap_180(motion.shoulder_deg.value - (305 + away)), 0, 6);
  EXPECT_NEAR(wrap_180(motion.toe_deg.value - (305 - away)), 0, 6);
  EXPECT_EQ(motion.frames, 3);
  EXPECT_TRUE(std::isnan(motion.speed_rpm.value));
  fs::remove_all(folder);
}

}  // namespace
}  // namespace tumble::analysis
