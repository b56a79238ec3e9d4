#include "analysis/tracking.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/path_linker.h"
#include "core/angle.h"

namespace tumble::analysis {
namespace {

constexpr double kCentrifuging = 0.1;  // share of all sightings
constexpr double kOnShell = 0.1;       // of a ball's radius

struct Stay {
  double turned = 0;          // by the drum meanwhile [rad]
  double reach = 0;           // largest distance from the axis
  double wander = 0;          // largest extent of its places, as seen
  double wander_on_drum = 0;  // the same on the turning drum
};

Stay stay_of(const Path& path, const std::vector<SeenFrame>& frames, const MotionModel& model) {
  struct Box {
    double x0 = 1e9, x1 = -1e9, y0 = 1e9, y1 = -1e9;
    void add(double x, double y) {
      x0 = std::min(x0, x);
      x1 = std::max(x1, x);
      y0 = std::min(y0, y);
      y1 = std::max(y1, y);
    }
    double extent() const { return std::hypot(x1 - x0, y1 - y0); }
  } seen, on_drum;
  Stay stay;
  const double start = frames[static_cast<std::size_t>(path.seen.front().first)].time;
  for (const auto& [f, k] : path.seen) {
    const SeenFrame& frame = frames[static_cast<std::size_t>(f)];
    const Sighting& s = frame.balls[static_cast<std::size_t>(k)];
    const double turn = model.turn * (frame.time - start), c = std::cos(turn), si = std::sin(turn);
    seen.add(s.x, s.y);
    on_drum.add(c * s.x + si * s.y, c * s.y - si * s.x);
    stay.reach = std::max(stay.reach, std::hypot(s.x, s.y));
    stay.turned = std::abs(turn);
  }
  stay.wander = seen.extent();
  stay.wander_on_drum = on_drum.extent();
  return stay;
}

// A thing that stays in its place while the drum carries balls by several radii is part of the picture.
bool stands_still(const Path& path, const Stay& stay) {
  return stay.turned * std::max(stay.reach, 4 * path.radius) > 4 * path.radius && stay.wander < 0.3 * path.radius;
}

// A thing that keeps its place on the drum while it goes over the top is part of the drum.
// But for what lies on the shell: that is a ball wedged between lifters.
bool rides_the_drum(const Path& path, const Stay& stay, double shell) {
  if (std::abs(stay.reach + path.radius - shell) < kOnShell * path.radius) return false;
  return stay.turned > radians(200) && stay.wander_on_drum < 0.5 * path.radius;
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
  std::vector<const Path*> believed_ones, riding;
  double all = 0, ridden = 0;
  for (const Path& path : paths) {
    const Stay stay = stay_of(path, frames, model);
    if (!believed(path, frames) || stands_still(path, stay)) continue;
    all += static_cast<double>(path.seen.size());
    if (rides_the_drum(path, stay, model.shell)) {
      ridden += static_cast<double>(path.seen.size());
      riding.push_back(&path);
    } else {
      believed_ones.push_back(&path);
    }
  }
  // Where much of all that is seen rides the drum, it is a charge that centrifuges.
  if (ridden > kCentrifuging * all) believed_ones.insert(believed_ones.end(), riding.begin(), riding.end());
  int id = 0;
  for (const Path* path : believed_ones) {
    for (const auto& [f, k] : path->seen)
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

void turn_upright(std::vector<SeenFrame>& frames, double roll, bool clockwise) {
  const double c = std::cos(roll), s = std::sin(roll);
  for (SeenFrame& f : frames)
    for (Sighting& b : f.balls) {
      const double x = c * b.x + s * b.y, y = c * b.y - s * b.x;
      const double vx = c * b.vx + s * b.vy, vy = c * b.vy - s * b.vx;
      b.x = clockwise ? -x : x;
      b.y = y;
      b.vx = clockwise ? -vx : vx;
      b.vy = vy;
      if (clockwise) b.spin = -b.spin;
    }
}

bool is_told(const Sighting& s) {
  constexpr double kToldScore = 0.5;
  return s.track >= 0 && s.score > kToldScore;
}

std::vector<SeenFrame> bridged_sightings(const std::vector<SeenFrame>& frames) {
  struct Last {
    std::size_t frame = 0;
    const Sighting* seen = nullptr;
  };
  std::vector<SeenFrame> bridged(frames.size());
  std::map<int, Last> last;
  for (std::size_t f = 0; f < frames.size(); ++f)
    for (const Sighting& s : frames[f].balls) {
      if (!is_told(s)) continue;
      Last& before = last[s.track];
      for (std::size_t k = before.frame + 1; before.seen != nullptr && k < f; ++k) {
        const Sighting& a = *before.seen;
        const double span = s.time - a.time, begin = frames[before.frame].time;
        const double share = (frames[k].time - begin) / (frames[f].time - begin);
        const double chord_x = (s.x - a.x) / span, chord_y = (s.y - a.y) / span;
        const auto or_chord = [](double v, double chord) { return std::isnan(v) ? chord : v; };
        // Cubic: a flight is exact.
        const double to = share * (1 - share) * (1 - share) * span, from = -share * share * (1 - share) * span;
        Sighting b = a;
        b.time = a.time + share * span;
        b.x = a.x + share * (s.x - a.x) + to * (or_chord(a.vx, chord_x) - chord_x) +
              from * (or_chord(s.vx, chord_x) - chord_x);
        b.y = a.y + share * (s.y - a.y) + to * (or_chord(a.vy, chord_y) - chord_y) +
              from * (or_chord(s.vy, chord_y) - chord_y);
        b.vx = chord_x;
        b.vy = chord_y;
        bridged[k].balls.push_back(b);
      }
      before = {f, &s};
    }
  return bridged;
}

std::vector<TrackPoint> points_of(const SeenFrame& seen, int frame, double unit, double rate) {
  std::vector<TrackPoint> points;
  for (const Sighting& s : seen.balls) {
    if (!is_told(s)) continue;
    TrackPoint p;
    p.frame = frame;
    p.id = s.track;
    p.time = s.time / rate;
    p.x = s.x * unit;
    p.y = s.y * unit;
    p.vx = s.vx * unit * rate;
    p.vy = s.vy * unit * rate;
    p.radius = s.radius * unit;
    p.spin = s.spin * rate;
    p.u_px = s.u;
    p.v_px = s.v;
    p.x_se = s.deviation * unit;
    p.visible = s.visible;
    p.confidence = s.confidence;
    points.push_back(p);
  }
  std::sort(points.begin(), points.end(), [](const TrackPoint& a, const TrackPoint& b) { return a.id < b.id; });
  return points;
}

}  // namespace tumble::analysis
