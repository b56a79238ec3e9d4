#include "bench/film_mills.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>

#include "core/error.h"
#include "core/units.h"
#include "io/config_file.h"
#include "sim/simulator.h"

namespace tumble::films {
namespace {

double log_uniform(Random& random, double low, double high) {
  return low * std::exp(random.uniform() * std::log(high / low));
}

Lifters random_lifters(Random& random, double radius) {
  Lifters lifters;
  constexpr std::array kProfiles = {LifterProfile::kNone,     LifterProfile::kRectangle, LifterProfile::kRectangle,
                                    LifterProfile::kTriangle, LifterProfile::kTrapezoid, LifterProfile::kTrapezoid,
                                    LifterProfile::kWave,     LifterProfile::kSwivel};
  lifters.profile = kProfiles[random.below(kProfiles.size())];
  if (lifters.profile == LifterProfile::kNone) return lifters;
  lifters.count = 3 + static_cast<int>(random.below(28));
  lifters.height = radius * random.uniform(0.025, 0.11);
  const double pitch = 2 * kPi * radius / lifters.count;
  lifters.width = std::min(lifters.height * random.uniform(0.5, 2.5), 0.6 * pitch);
  if (lifters.profile == LifterProfile::kTrapezoid) lifters.leading_angle_deg = random.uniform(5, 40);
  if (lifters.profile == LifterProfile::kTriangle && random.uniform() < 0.5)
    lifters.leading_angle_deg = random.uniform(10, 60);
  if (lifters.profile == LifterProfile::kWave) lifters.width = kNotGiven;
  if (lifters.profile == LifterProfile::kSwivel) lifters.swivel_angle_deg = random.uniform(-30, 40);
  return lifters;
}

Config random_config(Random& random) {
  Config config;
  config.mill.diameter = log_uniform(random, 0.15, 1.0);
  const double radius = config.mill.diameter / 2;
  config.mill.speed = random.uniform(0.4, 1.1);
  config.mill.lifters = random_lifters(random, radius);
  config.charge.filling = random.uniform(0.1, 0.5);
  const int classes = 1 + static_cast<int>(random.below(4));
  const double smallest = radius / log_uniform(random, 10, 45);
  const double ratio = classes == 1 ? 1 : std::min(random.uniform(1.25, 2.5), radius / 8 / smallest);
  for (int k = 0; k < classes; ++k) {
    BallClass c;
    c.radius = smallest * std::pow(ratio, classes == 1 ? 0.0 : double(k) / (classes - 1));
    c.mass = 7800 * 4.0 / 3 * kPi * std::pow(c.radius, 3);
    c.share = random.uniform(0.2, 1) / std::pow(c.radius / smallest, random.uniform(0, 2));
    config.charge.balls.push_back(c);
  }
  // As soft as keeps overlaps of hard blows at some per cent of a radius: pictures need no more.
  const BallClass& middle = config.charge.balls[config.charge.balls.size() / 2];
  const double blow = std::sqrt(4 * kGravity * radius);
  config.contact.normal_stiffness = middle.mass * blow * blow / std::pow(0.06 * middle.radius, 2);
  config.contact.tangential_stiffness = 0.75 * config.contact.normal_stiffness;
  config.contact.friction = random.uniform(0.15, 0.6);
  config.contact.restitution = random.uniform(0.3, 0.8);
  config.contact.wall.restitution = random.uniform(0.3, 0.7);
  return config;
}

void add_layer(FilmMill& mill, int layer) {
  Config config = mill.config;
  config.run.seed = mill.config.run.seed + static_cast<std::uint64_t>(layer);
  std::size_t index = 0;
  sim::RunSink sink;
  sink.setup = [&](const RunSetup& setup) {
    mill.mill_speed = setup.mill_speed;
    for (const double r : setup.balls.radius) {
      int which = 0;
      for (std::size_t k = 0; k < config.charge.balls.size(); ++k)
        if (config.charge.balls[k].radius == r) which = static_cast<int>(k);
      mill.radius.push_back(r);
      mill.ball_class.push_back(which);
      mill.layer.push_back(layer);
    }
  };
  sink.frame = [&](const Frame& frame) {
    if (layer == 0) mill.states.push_back({frame.time, frame.mill_angle, {}});
    if (index >= mill.states.size()) return;
    FilmMill::State& state = mill.states[index++];
    for (std::size_t i = 0; i < frame.x.size(); ++i)
      state.balls.push_back({frame.x[i], frame.y[i], 0, frame.vx[i], frame.vy[i], frame.angle[i], frame.spin[i]});
  };
  sim::simulate(config, sink);
}

template <class T>
void put(std::ofstream& out, const std::vector<T>& v) {
  const std::uint64_t n = v.size();
  out.write(reinterpret_cast<const char*>(&n), sizeof n);
  out.write(reinterpret_cast<const char*>(v.data()), static_cast<std::streamsize>(n * sizeof(T)));
}

template <class T>
void get(std::ifstream& in, std::vector<T>& v) {
  std::uint64_t n = 0;
  in.read(reinterpret_cast<char*>(&n), sizeof n);
  if (!in || n > (1u << 28)) throw WorkError("mills", "the file of simulated mills is not whole; remove it");
  v.resize(n);
  in.read(reinterpret_cast<char*>(v.data()), static_cast<std::streamsize>(n * sizeof(T)));
}

void write_mills(const std::filesystem::path& file, const std::vector<FilmMill>& mills) {
  const std::filesystem::path part = file.string() + ".part";
  std::ofstream out(part, std::ios::binary);
  for (const FilmMill& m : mills) {
    const std::string toml = io::to_toml(m.config);
    put(out, std::vector<char>(toml.begin(), toml.end()));
    put(out, std::vector<double>{double(m.layers), m.length, m.mill_speed, m.charge_depth});
    put(out, m.radius);
    put(out, m.ball_class);
    put(out, m.layer);
    put(out, std::vector<int>(m.states.size()));
    for (const FilmMill::State& s : m.states) {
      put(out, std::vector<double>{s.time, s.mill_angle});
      put(out, s.balls);
    }
  }
  if (!out.flush()) throw WorkError(file.string(), "could not be written");
  out.close();
  std::filesystem::rename(part, file);
}

std::vector<FilmMill> read_mills(const std::filesystem::path& file, int count) {
  std::ifstream in(file, std::ios::binary);
  std::vector<FilmMill> mills(static_cast<std::size_t>(count));
  for (FilmMill& m : mills) {
    std::vector<char> toml;
    std::vector<double> numbers;
    std::vector<int> states;
    get(in, toml);
    m.config = io::parse_config(std::string(toml.begin(), toml.end()), file.string());
    get(in, numbers);
    m.layers = static_cast<int>(numbers.at(0));
    m.length = numbers.at(1);
    m.mill_speed = numbers.at(2);
    m.charge_depth = numbers.at(3);
    get(in, m.radius);
    get(in, m.ball_class);
    get(in, m.layer);
    get(in, states);
    m.states.resize(states.size());
    for (FilmMill::State& s : m.states) {
      get(in, numbers);
      s.time = numbers.at(0);
      s.mill_angle = numbers.at(1);
      get(in, s.balls);
    }
  }
  return mills;
}

}  // namespace

FilmMill simulate_random_mill(std::uint64_t seed, const Keeping& keeping) {
  for (std::uint64_t attempt = 0;; ++attempt) {
    Random random(seed * 7919 + attempt * 104729 + 3);
    random.next();
    FilmMill mill;
    mill.config = random_config(random);
    mill.config.run.seed = 1 + random.below(1000000);
    mill.layers = random.uniform() < 0.4 ? 1 : 2 + static_cast<int>(random.below(3));
    double largest = 0, sum = 0;
    for (const BallClass& c : mill.config.charge.balls) {
      largest = std::max(largest, c.radius);
      sum += c.radius;
    }
    const double mean = sum / double(mill.config.charge.balls.size());
    mill.length = mill.layers == 1 ? 2 * largest * random.uniform(1.03, 1.3)
                  : keeping.slabs  ? 2.02 * largest * mill.layers
                                   : std::max(2.05 * largest, mill.layers * 2 * mean * random.uniform(0.95, 1.1));
    mill.charge_depth = mill.length;
    // Some mills go on behind: what lies there would be hidden by what is simulated, but for a dark background.
    if (mill.layers > 2 && random.uniform() < 0.4)
      mill.length += random.uniform(0.1, 0.7) * mill.config.mill.diameter / 2;
    mill.config.mill.length = mill.length;
    RunPlan& run = mill.config.run;
    run.spin_up = keeping.spin_up;
    run.revolutions = keeping.revolutions;
    try {
      check(mill.config);
      const double a_turn = 60 / speed_rpm(mill.config.mill);
      if (keeping.seconds > 0) run.revolutions = keeping.seconds / a_turn;
      const double seconds = run.revolutions * a_turn;
      run.frames_per_second = keeping.states_per_second > 0 ? keeping.states_per_second : 24 / seconds;
      for (int layer = 0; layer < mill.layers; ++layer) add_layer(mill, layer);
      return mill;
    } catch (const Error& e) {  // lifters that do not fit, a blow too hard: take another mill
      if (attempt > 50) throw;
    }
  }
}

std::vector<FilmMill> cached_mills(const std::filesystem::path& file, std::uint64_t seed, int count) {
  if (std::filesystem::exists(file)) return read_mills(file, count);
  std::vector<FilmMill> mills;
  for (int k = 0; k < count; ++k) {
    mills.push_back(simulate_random_mill(seed * 1000 + static_cast<std::uint64_t>(k), {}));
    fmt::print(stderr, "\rmill {} of {}: {} balls in {} layers   ", k + 1, count, mills.back().radius.size(),
               mills.back().layers);
  }
  fmt::print(stderr, "\n");
  write_mills(file, mills);
  return mills;
}

std::vector<double> slab_depths_of(const FilmMill& mill, Random& random) {
  const double pitch = mill.charge_depth / mill.layers;
  std::vector<double> z(mill.radius.size());
  for (std::size_t i = 0; i < z.size(); ++i)
    z[i] = -(mill.layer[i] + 0.5) * pitch + (0.5 * pitch - mill.radius[i]) * random.uniform(-1, 1);
  return z;
}

PlacedBalls place_balls(const FilmMill& mill, const FilmMill::State& state, Random& random) {
  const std::size_t n = mill.radius.size();
  const double pitch = mill.charge_depth / mill.layers;
  std::vector<double> z(n);
  const auto clamped = [&](std::size_t i, double value) {
    return std::clamp(value, -mill.charge_depth + mill.radius[i], -mill.radius[i]);
  };
  const double spread = random.uniform(0, 0.5);
  for (std::size_t i = 0; i < n; ++i)
    z[i] = clamped(i, -(mill.layer[i] + 0.5) * pitch + pitch * spread * random.uniform(-1, 1));
  // Neighbouring slices interlock: whoever overlaps is pushed apart along the axis, a little at a time.
  struct Pair {
    std::size_t i, j;
    double apart;  // along z, at least
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      const auto &a = state.balls[i], &b = state.balls[j];
      const double reach = mill.radius[i] + mill.radius[j], dx = a.x - b.x, dy = a.y - b.y;
      const double flat = dx * dx + dy * dy;
      if (flat < reach * reach) pairs.push_back({i, j, std::sqrt(reach * reach - flat)});
    }
  for (int round = 0; round < 30; ++round)
    for (const Pair& p : pairs) {
      const double gap = z[p.i] - z[p.j], need = p.apart - std::abs(gap);
      if (need <= 0 || (mill.layer[p.i] == mill.layer[p.j])) continue;
      const double by = 0.5 * need * (gap >= 0 ? 1 : -1);
      z[p.i] = clamped(p.i, z[p.i] + by);
      z[p.j] = clamped(p.j, z[p.j] - by);
    }
  // Where that did not help, the smaller goes. A fifth of a radius may be left: contacts are soft, and nobody sees it.
  std::vector<char> gone(n);
  for (const Pair& p : pairs) {
    if (mill.layer[p.i] == mill.layer[p.j] || gone[p.i] || gone[p.j]) continue;
    const double dz = z[p.i] - z[p.j], reach = mill.radius[p.i] + mill.radius[p.j];
    const double apart = std::sqrt(reach * reach - p.apart * p.apart + dz * dz);
    const std::size_t smaller = mill.radius[p.i] < mill.radius[p.j] ? p.i : p.j;
    if (reach - apart > 0.2 * mill.radius[smaller]) gone[smaller] = 1;
  }
  PlacedBalls placed;
  for (std::size_t i = 0; i < n; ++i) {
    if (gone[i]) continue;
    placed.ball.push_back(i);
    placed.z.push_back(z[i]);
  }
  return placed;
}

}  // namespace tumble::films
