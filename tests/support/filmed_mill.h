#pragma once
#include <string>
#include <vector>

#include "core/frame.h"
#include "io/film_file.h"
#include "render/renderer.h"
#include "sim/simulator.h"

// A mill simulated in memory and filmed: the exact truth, and a picture of it.
namespace tumble {

struct SimulatedMill {
  RunSetup setup;
  std::vector<Frame> frames;
};

inline SimulatedMill simulate_in_memory(const Config& config) {
  SimulatedMill mill;
  sim::RunSink sink;
  sink.setup = [&](const RunSetup& s) { mill.setup = s; };
  sink.frame = [&](const Frame& f) { mill.frames.push_back(f); };
  sim::simulate(config, sink);
  return mill;
}

// One film frame per stored frame. Toe and shoulder are not drawn: the film must give them away by itself.
inline void film(const SimulatedMill& mill, render::Style style, int fps, const std::string& path) {
  style.overlay.toe = style.overlay.shoulder = false;
  render::Renderer renderer(mill.setup, style);
  renderer.set_scale(0, 2.5);
  io::FilmFormat format;
  format.width = style.width;
  format.height = style.height;
  format.fps_numerator = fps;
  std::vector<double> time, torque;
  for (const Frame& f : mill.frames) time.push_back(f.time), torque.push_back(f.observed.torque);
  io::FilmWriter writer(path, format);
  for (const Frame& f : mill.frames) writer.write(renderer.draw(f, {kNotGiven, kNotGiven, time, torque, {}}));
  writer.finish();
}

}  // namespace tumble
