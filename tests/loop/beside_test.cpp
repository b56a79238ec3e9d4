#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "analysis/charge_motion.h"
#include "analysis/film_pictures.h"
#include "tests/support/filmed_mill.h"
#include "tests/support/mills.h"

// A run laid over its own film: outlines must lie on the balls.
namespace tumble {
namespace {

class OverItsOwnFilm : public testing::TestWithParam<bool> {};  // clockwise

TEST_P(OverItsOwnFilm, OutlinesLieOnTheBallsWithinAPixel) {
  Config config = paper_mill();
  config.run.spin_up = 0.6;
  config.run.revolutions = 0.25;
  config.run.frames_per_second = 100;
  const SimulatedMill mill = simulate_in_memory(config);
  render::Style style;
  style.mirror = GetParam();
  const std::string path = testing::TempDir() + "beside_" + std::to_string(getpid()) + ".mp4";
  film(mill, style, 100, path);
  analysis::FilmOptions options;
  options.mill = &config;
  const ChargeMotion seen = analysis::measure_film(path, options);
  std::filesystem::remove(path);

  analysis::PictureView view;
  view.camera = seen.camera;
  view.clockwise = seen.rotation == Rotation::kClockwise;
  view.margin = 1;
  view.edge_px = static_cast<int>(std::lround(2 * seen.camera.radius_px));
  const double scale = view.edge_px / (2 * seen.camera.radius_px), radius = seen.mill_radius;
  const double left = seen.camera.centre_u_px - seen.camera.radius_px,
               top = seen.camera.centre_v_px - seen.camera.radius_px;
  EXPECT_EQ(view.clockwise, GetParam());
  double squares = 0, worst_width = 0;
  const Frame& f = mill.frames.back();
  for (std::size_t b = 0; b < f.x.size(); ++b) {
    const double r = mill.setup.balls.radius[b],
                 pixels = 302.4 / (0.5 * config.mill.diameter);  // the renderer's plan, as below
    const auto outline = analysis::ball_in_picture(view, f.x[b] / radius, f.y[b] / radius, r / radius, 40);
    Eigen::Vector2d middle(0, 0);
    for (const auto& p : outline) middle += p / 40;
    const double u = left + (middle.x() + 0.5) / scale, v = top + (middle.y() + 0.5) / scale;
    squares +=
        std::pow(u - (399.5 + (GetParam() ? -1 : 1) * f.x[b] * pixels), 2) + std::pow(v - (359.5 - f.y[b] * pixels), 2);
    worst_width = std::max(worst_width, std::abs((outline[0] - outline[20]).norm() / scale - 2 * r * pixels));
  }
  const double rmse = std::sqrt(squares / static_cast<double>(f.x.size()));
  EXPECT_LT(rmse, 1);
  EXPECT_LT(worst_width, 1);
  std::printf("             outlines off by %.3f px, wider by at most %.3f px\n", rmse, worst_width);
}

std::string turning(const testing::TestParamInfo<bool>& info) { return info.param ? "clockwise" : "counter_clockwise"; }
INSTANTIATE_TEST_SUITE_P(Turning, OverItsOwnFilm, testing::Bool(), turning);

}  // namespace
}  // namespace tumble
