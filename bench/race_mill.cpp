// The peers' mill run by tumble, from the same state of the charge as they start from; bench/race.sh races them.
//   race_mill CASEDIR STEPS DT RATIO FRICTION [THREADS] [--effect NAME] [--frames FILE|none]
//   race_mill CASEDIR STEPS DT RATIO FRICTION [THREADS] --kernels best|avx512|avx2|scalar [--export STATE.csv]
// CASEDIR is what the peers' `gen.py export` makes. The first form is a user's whole path: sim::simulate goes on from
// that state, and torque, energies, impacts, falls, locked balls and 200 frames a second go to a run file, which is
// thrown away unless it is given a name. The second steps the mill alone, with the sums and the energies that a frame
// holds but without frames and checkpoints. Both print what they did, the time from the first step to the last, and the
// most memory of the process.
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <vector>

#include "core/effects.h"
#include "core/error.h"
#include "core/large_arrays.h"
#include "core/parallel_for.h"
#include "core/units.h"
#include "io/run_file.h"
#include "sim/packing.h"
#include "sim/run_state.h"
#include "sim/simulator.h"

using namespace tumble;
namespace fs = std::filesystem;

namespace {

struct Options {
  fs::path folder, frames, export_to;
  long steps = 0;
  double time_step = 0, ratio = 0, friction = 0;
  int threads = 1;
  std::string effect, kernels;
  bool alone() const { return !kernels.empty() || !export_to.empty(); }
};

struct PeerBall {
  double x, y, vx, vy, spin;
};
struct PeerClass {
  double radius = 0, mass = 0;
  std::vector<PeerBall> balls;
};
struct PeerCase {
  std::map<std::string, double> values;  // of case.txt
  std::map<int, PeerClass> classes;      // by the peers' type
};

PeerCase read_case(const fs::path& folder) {
  PeerCase c;
  std::ifstream values(folder / "case.txt"), state(folder / "state.csv");
  if (!values || !state)
    throw InputError(folder.string(), "holds no case.txt and state.csv; make them with the peers' gen.py export");
  std::string key;
  for (double value = 0; values >> key >> value;) c.values[key] = value;
  int id = 0, type = 0;
  char comma = ',';
  PeerBall b{};
  for (double radius = 0, mass = 0; state >> id >> comma >> type >> comma >> radius >> comma >> mass >> comma >> b.x >>
                                    comma >> b.y >> comma >> b.vx >> comma >> b.vy >> comma >> b.spin;) {
    PeerClass& same = c.classes[type];
    same.radius = radius;
    same.mass = mass;
    same.balls.push_back(b);
  }
  return c;
}

Config config_of(const PeerCase& c, const Options& o) {
  Config config;
  config.mill.diameter = c.values.at("D");
  config.mill.critical_speed_rpm = rpm_from_rad_s(c.values.at("wcrit"));
  config.mill.speed = o.ratio;
  config.mill.lifters.count = static_cast<int>(c.values.at("nlift"));
  config.mill.lifters.profile = LifterProfile::kRectangle;
  config.mill.lifters.height = config.mill.lifters.width = 0.02;
  config.charge.count = static_cast<int>(c.values.at("N"));
  for (const auto& [type, same] : c.classes)
    config.charge.balls.push_back({same.radius, same.mass, double(same.balls.size())});
  config.contact.normal_stiffness = c.values.at("kn");
  config.contact.tangential_stiffness = c.values.at("kt");
  config.contact.friction = o.friction;
  config.contact.restitution = 0.8;
  config.contact.wall.restitution = 0.4;
  config.run.time_step = o.time_step;
  config.run.spin_up = c.values.at("theta0") / (2 * kPi);  // what the state has behind it
  config.run.revolutions = double(o.steps) * o.time_step * speed_rpm(config.mill) / 60;
  if (o.effect.empty()) return config;

  const Effect* effect = find_effect(o.effect);
  if (!effect) throw InputError("--effect", "knows no \"" + o.effect + "\"; see tumble effects");
  for (const EffectParameter& p : effect->parameters) {
    if (p.is_column() || (p.list && p.strength))
      config.effects[o.effect][p.name] = typical_list(p);
    else if (!std::isnan(p.typical))
      config.effects[o.effect][p.name] = {p.typical};
  }
  return config;
}

// The state at the nearest whole step; the fraction of a step's turn that is left is turned away.
sim::RunState state_of(PeerCase& c, const Config& config, int threads) {
  const sim::MillModel model = sim::make_mill_model(config);
  const double theta = c.values.at("theta0");
  const auto step = std::llround(theta / (model.speed * model.time_step));
  const double turn = sim::mill_angle(model, step) - theta, cos = std::cos(turn), sin = std::sin(turn);

  sim::Charge charge = sim::make_charge(sim::draw_balls(config));
  std::map<double, std::size_t> taken;
  for (std::size_t i = 0; i < charge.size(); ++i) {
    for (const auto& [type, same] : c.classes) {
      if (same.radius != charge.radius[i]) continue;
      const PeerBall& b = same.balls.at(taken[same.radius]++);
      charge.x[i] = cos * b.x - sin * b.y;
      charge.y[i] = sin * b.x + cos * b.y;
      charge.vx[i] = cos * b.vx - sin * b.vy;
      charge.vy[i] = sin * b.vx + cos * b.vy;
      charge.spin[i] = b.spin;
    }
  }
  for (auto& [type, same] : c.classes) same.balls = std::vector<PeerBall>();  // not to be counted as memory of the run
  sim::RunState run;
  run.mill = sim::start_mill(model, std::move(charge), threads);
  run.mill.step = run.averaging_from = step;
  run.mill.ledger.counting_impacts = true;
  // Samples of the turns that nobody has seen; the first one to come is the next.
  const double samples = double(step) * model.time_step * model.speed / (2 * kPi) * sim::kSamplesPerRevolution;
  for (auto* v : {&run.history.torque, &run.history.closure, &run.history.locked})
    v->assign(static_cast<std::size_t>(samples + 1e-6), 0.0);
  run.sampled_before = static_cast<std::int64_t>(run.history.size());
  return run;
}

struct Stopwatch {
  rusage usage = [] {
    rusage r{};
    getrusage(RUSAGE_SELF, &r);
    return r;
  }();
  std::chrono::steady_clock::time_point wall = std::chrono::steady_clock::now();
};
double seconds(const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); }

void print_result(const Options& o, std::size_t balls, double torque, const Stopwatch& start) {
  const Stopwatch now;
  const double user = seconds(now.usage.ru_utime) - seconds(start.usage.ru_utime);
  const double system = seconds(now.usage.ru_stime) - seconds(start.usage.ru_stime);
  const double wall = std::chrono::duration<double>(now.wall - start.wall).count();
  const double ball_steps = double(balls) * double(o.steps);
  fmt::print(
      "balls {} steps {} ball_steps {:.6g} torque_N_m {:.6g} user_s {:.4f} system_s {:.4f} wall_s {:.4f} "
      "per_user_s {:.4g} peak_bytes {}\n",
      balls, o.steps, ball_steps, torque, user, system, wall, ball_steps / user, now.usage.ru_maxrss * 1024);
}

// Keeps the start in a file, where it takes no memory of the run.
StoredCheckpoint put_aside(const Checkpoint& start) {
  const std::shared_ptr<std::FILE> file(std::tmpfile(), [](std::FILE* f) { f ? std::fclose(f) : 0; });
  if (!file) throw WorkError(fs::temp_directory_path().string(), "takes no file");
  start.tell(
      [&](std::span<const double> words) { std::fwrite(words.data(), sizeof(double), words.size(), file.get()); });
  std::rewind(file.get());
  return {start.frames_written, start.size, [file](std::span<double> words) {
            if (std::fread(words.data(), sizeof(double), words.size(), file.get()) != words.size())
              throw WorkError(fs::temp_directory_path().string(), "could not keep the start");
          }};
}

void run_as_a_user(const Options& o, const Config& config, StoredCheckpoint start) {
  // The name of a scratch file is ours alone: races run side by side.
  const bool scratch = o.frames.empty(), none = o.frames == "none";
  const fs::path file = scratch ? fs::temp_directory_path() / fmt::format("race_mill_{}.h5", ::getpid()) : o.frames;
  std::unique_ptr<io::RunWriter> writer;
  Stopwatch stopwatch;
  double torque = 0;
  std::size_t balls = 0, frames = 0;
  sim::RunSink sink;
  sink.setup = [&](const RunSetup& setup) {
    balls = setup.balls.size();
    if (!none) writer = std::make_unique<io::RunWriter>(file, setup, sim::checkpoint_capacity(setup.config));
    stopwatch = {};
  };
  if (!none) {
    sink.frame = [&](const Frame& frame) {
      writer->write(frame);
      torque += frame.observed.torque;
      ++frames;
    };
    sink.checkpoint = [&](const Checkpoint& c) { writer->write(c); };
  }
  const RunResult result = sim::simulate(config, sink, std::move(start));
  if (writer) writer->finish(result);
  print_result(o, balls, none ? kNotGiven : torque / double(frames), stopwatch);
  if (scratch) fs::remove(file);
}

void write_state(const fs::path& path, const PeerCase& c, const sim::RunningMill& mill) {
  std::ofstream out(path);
  out.precision(10);
  for (const char* key : {"N", "D", "nlift", "wcrit"}) out << "# " << key << ' ' << c.values.at(key) << '\n';
  out << "# theta " << sim::mill_angle(mill.model, mill.step) << "\n# graded 0\n";
  const sim::Charge& b = mill.charge;
  for (std::size_t i = 0; i < b.size(); ++i)
    for (const auto& [type, same] : c.classes)
      if (same.radius == b.radius[i])
        out << b.id[i] + 1 << ',' << type << ',' << b.radius[i] << ',' << b.mass[i] << ',' << b.x[i] << ',' << b.y[i]
            << ',' << b.vx[i] - b.ax[i] << ',' << b.vy[i] - b.ay[i] << ',' << b.spin[i] - b.alpha[i] << '\n';
  if (!out.flush()) throw WorkError(path.string(), "could not be written");
}

void run_alone(const Options& o, const PeerCase& c, sim::RunningMill& mill) {
  for (const sim::Kernels* k : sim::all_kernels())
    if (o.kernels == k->name) mill.kernels = k;
  if (!o.kernels.empty() && o.kernels != "best" && o.kernels != mill.kernels->name)
    throw InputError("--kernels", "knows no \"" + o.kernels + "\" on this machine");
  const Stopwatch stopwatch;
  double energy = 0;
  for (long step = 1; step <= o.steps; ++step) {
    sim::advance(mill);
    if (step % mill.model.steps_per_frame == 0) energy = sim::energies_of(mill).kinetic;
  }
  print_result(o, mill.charge.size(), mill.ledger.torque / double(mill.ledger.steps), stopwatch);
  fmt::print("kernels {} kinetic_J {:.17g}\n", mill.kernels->name, energy);  // the same for all kernels and threads
  if (!o.export_to.empty()) write_state(o.export_to, c, mill);
}

void race(const Options& o) {
  limit_threads(o.threads);
  give_large_arrays_back();
  PeerCase c = read_case(o.folder);
  const Config config = config_of(c, o);
  check_complete(config);
  sim::RunState start = state_of(c, config, o.alone() ? o.threads : 1);
  if (const int n = start.mill.model.steps_per_frame; o.steps < n || o.steps % n != 0)
    throw InputError("STEPS", fmt::format("is {}; give a multiple of the {} steps from frame to frame", o.steps, n));
  if (o.alone()) return run_alone(o, c, start.mill);
  StoredCheckpoint checkpoint = put_aside(sim::checkpoint_of(start));
  start = {};
  run_as_a_user(o, config, std::move(checkpoint));
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app{"The peers' mill, run by tumble from the state that they start from"};
  Options o;
  app.add_option("case", o.folder, "Folder with case.txt and state.csv")->required();
  app.add_option("steps", o.steps, "Time steps")->required();
  app.add_option("time_step", o.time_step, "s")->required();
  app.add_option("ratio", o.ratio, "Speed over critical speed")->required();
  app.add_option("friction", o.friction, "Of balls and wall")->required();
  app.add_option("threads", o.threads, "Threads");
  app.add_option("--effect", o.effect, "Switch an effect on, with its typical values");
  app.add_option("--frames", o.frames, "The run file to keep, or \"none\" for no frames at all");
  app.add_option("--kernels", o.kernels, "Step the mill alone, with these kernels");
  app.add_option("--export", o.export_to, "Step the mill alone and write its last state as the peers read it");
  CLI11_PARSE(app, argc, argv);
  race(o);
  return 0;
} catch (const Error& e) {
  fmt::print(stderr, "race_mill: {}\n", e.what());
  return 1;
}
