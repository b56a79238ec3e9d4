// A scene of discs in a drum, as the rendering peers read it, turned into a run file; bench/render_race.sh renders it.
//   scene_run SCENE.f32 RUN.h5 [--frames-per-second 100] [--lifters 0]
// SCENE.f32 is what the peers' gen_frames.py makes: int32 balls, frames; then per frame and ball x, y, theta, r, speed
// as float32, in a drum of radius 1. Nothing was simulated: the mill turns at 0.7 of critical speed, the torque is a
// wave.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <vector>

#include "core/error.h"
#include "core/units.h"
#include "io/run_file.h"

using namespace tumble;
namespace fs = std::filesystem;

namespace {

struct Disc {
  float x, y, theta, r, speed;
};

struct Scene {
  std::size_t balls = 0, frames = 0;
  std::vector<Disc> discs;  // frame by frame
};

Scene read_scene(const fs::path& path) {
  const auto refuse = [&](const char* problem) {
    throw InputError(path.string(), std::string(problem) + "; make it with the peers' gen_frames.py");
  };
  std::ifstream file(path, std::ios::binary);
  std::int32_t head[2] = {};
  if (!file.read(reinterpret_cast<char*>(head), sizeof head)) refuse("cannot be read");
  if (head[0] < 1 || head[0] > 10'000'000 || head[1] < 1 || head[1] > 1'000'000) refuse("is no scene");
  Scene scene{static_cast<std::size_t>(head[0]), static_cast<std::size_t>(head[1]), {}};
  scene.discs.resize(scene.balls * scene.frames);
  const auto bytes = static_cast<std::streamsize>(scene.discs.size() * sizeof(Disc));
  if (!file.read(reinterpret_cast<char*>(scene.discs.data()), bytes)) refuse("is cut off");
  return scene;
}

RunSetup setup_of(const Scene& scene, double frames_per_second, int lifters) {
  constexpr double kSteel = 7800;  // [kg/m3]
  RunSetup setup;
  Config& config = setup.config;
  config.mill.diameter = 2;
  config.mill.speed = 0.7;
  if (lifters > 0) {
    config.mill.lifters.count = lifters;
    config.mill.lifters.profile = LifterProfile::kRectangle;
    config.mill.lifters.height = config.mill.lifters.width = 0.07;
  }
  std::map<double, int> classes;
  for (std::size_t i = 0; i < scene.balls; ++i) {
    const double r = scene.discs[i].r;
    setup.balls.radius.push_back(r);
    setup.balls.mass.push_back(kSteel * 4 / 3 * kPi * r * r * r);
    ++classes[r];
  }
  config.charge.count = static_cast<int>(scene.balls);
  for (const auto& [r, count] : classes)
    config.charge.balls.push_back({r, kSteel * 4 / 3 * kPi * r * r * r, double(count)});
  setup.mill_speed = rad_s_from_rpm(speed_rpm(config.mill));
  setup.frame_count = static_cast<std::int64_t>(scene.frames);
  setup.time_step = 1 / frames_per_second;
  config.run.frames_per_second = frames_per_second;
  config.run.revolutions = double(scene.frames) / frames_per_second * speed_rpm(config.mill) / 60;
  return setup;
}

Frame frame_of(const Scene& scene, const RunSetup& setup, std::size_t k) {
  Frame frame;
  frame.step = static_cast<std::int64_t>(k);
  frame.time = double(k) * setup.time_step;
  frame.mill_angle = setup.mill_speed * frame.time;
  for (std::size_t i = k * scene.balls; i < (k + 1) * scene.balls; ++i) {
    const Disc& disc = scene.discs[i];
    const double away = std::max(1e-6, std::hypot(double(disc.x), double(disc.y)));
    frame.x.push_back(disc.x);
    frame.y.push_back(disc.y);
    frame.vx.push_back(-disc.speed * disc.y / away);
    frame.vy.push_back(disc.speed * disc.x / away);
    frame.angle.push_back(disc.theta);
    frame.spin.push_back(5);
  }
  frame.observed.torque = 1000 + 100 * std::sin(40 * frame.time) + 30 * std::sin(17 * frame.time);
  frame.observed.power = frame.observed.torque * setup.mill_speed;
  return frame;
}

void convert(const fs::path& from, const fs::path& to, double frames_per_second, int lifters) {
  const Scene scene = read_scene(from);
  const RunSetup setup = setup_of(scene, frames_per_second, lifters);
  io::RunWriter writer(to, setup, 0);
  for (std::size_t k = 0; k < scene.frames; ++k) writer.write(frame_of(scene, setup, k));
  writer.finish({});
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Turns a scene of discs into a run file");
  fs::path scene, run;
  double frames_per_second = 100;
  int lifters = 0;
  app.add_option("scene", scene, "SCENE.f32 of the peers' gen_frames.py")->required();
  app.add_option("run", run, "RUN.h5 to write")->required();
  app.add_option("--frames-per-second", frames_per_second, "Of the scene")->check(CLI::PositiveNumber);
  app.add_option("--lifters", lifters, "Square lifters of 0.07 radii; they cut through the outermost discs");
  CLI11_PARSE(app, argc, argv);
  try {
    convert(scene, run, frames_per_second, lifters);
  } catch (const std::exception& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 1;
  }
  return 0;
}
