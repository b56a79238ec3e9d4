#pragma once
#include <cmath>
#include <vector>

#include "core/random.h"
#include "core/units.h"
#include "diagnose/measurement.h"
#include "sim/simulator.h"
#include "tests/support/mills.h"

// A mill simulated once, and what somebody who errs measures on it, as often as wanted.
namespace tumble::diagnose {

struct SimulatedRun {
  RunSetup setup;
  std::vector<Frame> frames;
};

inline SimulatedRun simulate_paper_mill(double revolutions, const std::map<std::string, EffectSettings>& effects = {},
                                        std::uint64_t packing = 1) {
  Config config = paper_mill();
  config.run.seed = packing;
  config.effects = effects;
  config.run.spin_up = 1.5;
  config.run.revolutions = revolutions;
  config.run.frames_per_second = 250;
  SimulatedRun run;
  sim::RunSink sink;
  sink.setup = [&](const RunSetup& s) { run.setup = s; };
  sink.frame = [&](const Frame& f) { run.frames.push_back(f); };
  sim::simulate(config, sink);
  return run;
}

struct Errors {
  double noise = 3e-4;                        // of places [m]
  double angle_noise = 0.5 * kPi / 180;       // of the mill's angle [rad]
  double torque_noise = 0.3;                  // of each sample [N m]
  double scale = 0, rotation = 0, clock = 0;  // as Observer
  double torque_offset = 0;                   // of the mean
  double ripple = 0;                          // of the speed, seven times a revolution, a third of a turn ahead
  double lost = 0;                            // of the balls in every frame
  bool mirrored = false, upside_down = false;
};

inline Measurement measure(const SimulatedRun& run, const Errors& e, std::uint64_t seed) {
  Random random(seed);
  const auto normal = [&] {
    double sum = -6;
    for (int k = 0; k < 12; ++k) sum += random.uniform();
    return sum;
  };
  Measurement m;
  m.config = run.setup.config;
  m.config.effects.clear();  // what the model does not know
  m.experiment.name = m.experiment.place = std::string("e");
  m.frames_file = "tracks.csv";
  const double c = std::cos(e.rotation) * (1 + e.scale), s = std::sin(e.rotation) * (1 + e.scale);
  std::vector<double> torque;
  double mean = 0;
  for (std::size_t i = 1; i < run.frames.size(); ++i)
    mean += run.frames[i].observed.torque / double(run.frames.size() - 1);
  for (const Frame& f : run.frames) {
    SeenFrame seen;
    seen.time = f.time * (1 + e.clock);
    seen.mill_angle = f.mill_angle + e.ripple / 7 * std::sin(7 * f.mill_angle + 2 * kPi / 3) + e.angle_noise * normal();
    if (e.mirrored) seen.mill_angle = kPi - seen.mill_angle;
    for (std::size_t b = 0; b < f.x.size(); ++b) {
      const double x = (e.mirrored ? -1 : 1) * f.x[b], y = (e.upside_down ? -1 : 1) * f.y[b];
      if (random.uniform() < e.lost) continue;
      seen.balls.push_back({static_cast<int>(b), c * x - s * y + e.noise * normal(), s * x + c * y + e.noise * normal(),
                            run.setup.balls.radius[b], f.spin[b]});
    }
    m.frames.push_back(std::move(seen));
    if (&f == &run.frames.front()) continue;
    torque.push_back(f.observed.torque + e.torque_offset * mean + e.torque_noise * normal());
    m.torque_series.push_back({f.time, torque.back()});
  }
  m.torque = mean_of_series(torque);
  m.revolutions = std::abs(m.frames.back().mill_angle - m.frames.front().mill_angle) / (2 * kPi);
  return m;
}

}  // namespace tumble::diagnose
