#include "analysis/tracking.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/path_linker.h"

namespace tumble::analysis {
namespace {

// A thing that stays in its place while the drum carries balls by several radii is part of the picture.
bool stands_still(const Path& path, const std::vector<SeenFrame>& frames, const MotionModel& model) {
  double x0 = 1e9, x1 = -1e9, y0 = 1e9, y1 = -1e9, reach = 0;
  for (const auto& [f, k] : path.seen) {
    const Sighting& s = frames[static_cast<std::size_t>(f)].balls[static_cast<std::size_t>(k)];
    x0 = std::min(x0, s.x);
    x1 = std::max(x1, s.x);
    y0 = std::min(y0, s.y);
    y1 = std::max(y1, s.y);
    reach = std::max(reach, std::hypot(s.x, s.y));
  }
  const double frames_seen = frames[static_cast<std::size_t>(path.seen.back().first)].time -
                             frames[static_cast<std::size_t>(path.seen.front().first)].time;
  const double carried = std::abs(model.turn) * frames_seen * std::max(reach, 4 * path.radius);
  return carried > 4 * path.radius && std::hypot(x1 - x0, y1 - y0) < 0.3 * path.radius;
}

// What speaks for a path: every sighting by its score, those less likely than not against it.
bool believed(const Path& path, const std::vector<SeenFrame>& frames) {
  if (path.seen.size() < 2) return frames.size() <= 2;  // seen once: as likely a trick of the light
  double evidence = 0;
  for (const auto& [f, k] : path.seen)
    evidence += frames[static_cast<std::size_t>(f)].balls[static_cast<std::size_t>(k)].score - 0.5;
  return evidence > 0.4;
}

}  // namespace

int link_sightings(std::vector<SeenFrame>& frames, const MotionModel& model) {
  const std::vector<Path> first = link_frames(frames, model, nullptr, kNotGiven);
  const FlowGuess flow = flow_of(frames, first);
  const double noise = colour_noise(frames, first);
  const std::vector<Path> paths = join_paths(link_frames(frames, model, &flow, noise), frames, model, flow, noise);
  for (SeenFrame& f : frames)
    for (Sighting& s : f.balls) s.track = -1;
  int id = 0;
  for (const Path& path : paths) {
    if (!believed(path, frames) || stands_still(path, frames, model)) continue;
    for (const auto& [f, k] : path.seen)
      frames[static_cast<std::size_t>(f)].balls[static_cast<std::size_t>(k)].track = id;
    ++id;
  }
  return id;
}

void smooth_velocities(std::vector<SeenFrame>& frames, double window) {
  std::map<int, std::vector<Sighting*>> paths;
  for (SeenFrame& f : frames)
    for (Sighting& s : f.balls) {
      s.vx = s.vy = kNotGiven;
      if (s.track >= 0) paths[s.track].push_back(&s);
    }
  const double half = 0.5 * window + 1e-9;
  for (auto& [id, seen] : paths) {
    for (std::size_t i = 0; i < seen.size(); ++i) {
      std::size_t a = i, b = i;
      while (a > 0 && seen[i]->time - seen[a - 1]->time <= half) --a;
      while (b + 1 < seen.size() && seen[b + 1]->time - seen[i]->time <= half) ++b;
      double s0 = 0, s1 = 0, s2 = 0, s3 = 0, s4 = 0, x0 = 0, x1 = 0, x2 = 0, y0 = 0, y1 = 0, y2 = 0;
      for (std::size_t k = a; k <= b; ++k) {
        const double t = seen[k]->time - seen[i]->time, x = seen[k]->x, y = seen[k]->y;
        s0 += 1;
        s1 += t;
        s2 += t * t;
        s3 += t * t * t;
        s4 += t * t * t * t;
        x0 += x;
        x1 += x * t;
        x2 += x * t * t;
        y0 += y;
        y1 += y * t;
        y2 += y * t * t;
      }
      const double det = s0 * (s2 * s4 - s3 * s3) - s1 * (s1 * s4 - s2 * s3) + s2 * (s1 * s3 - s2 * s2);
      if (b - a >= 2 && det > 1e-9) {  // slope of the parabola at the frame itself
        const auto slope = [&](double m0, double m1, double m2) {
          return (s0 * (m1 * s4 - m2 * s3) - m0 * (s1 * s4 - s2 * s3) + s2 * (s1 * m2 - s2 * m1)) / det;
        };
        seen[i]->vx = slope(x0, x1, x2);
        seen[i]->vy = slope(y0, y1, y2);
      } else if (b > a) {
        const double d = s0 * s2 - s1 * s1;
        seen[i]->vx = (s0 * x1 - s1 * x0) / d;
        seen[i]->vy = (s0 * y1 - s1 * y0) / d;
      }
    }
  }
}

}  // namespace tumble::analysis
