#include "diagnose/seen_motion.h"

#include <algorithm>
#include <cmath>

#include "analysis/charge_motion.h"
#include "core/units.h"

namespace tumble::diagnose {
namespace {

const Sighting* find(const SeenFrame& frame, int ball) {
  const auto at = std::lower_bound(frame.balls.begin(), frame.balls.end(), ball,
                                   [](const Sighting& s, int id) { return s.ball < id; });
  return at != frame.balls.end() && at->ball == ball ? &*at : nullptr;
}

// As the ball moves between the frames before and after; NaN where it is in neither.
void give_velocity(TrackPoint& p, const SeenFrame& before, const SeenFrame& here, const SeenFrame& after) {
  const Sighting *now = find(here, p.id), *a = find(before, p.id), *b = find(after, p.id);
  const double from = a ? before.time : here.time, to = b ? after.time : here.time;
  if (!(to > from)) return;
  if (!a) a = now;
  if (!b) b = now;
  p.vx = (b->x - a->x) / (to - from);
  p.vy = (b->y - a->y) / (to - from);
}

RunSetup setup_of(std::span<const SeenFrame> frames, const Config& mill) {
  RunSetup setup;
  setup.config = mill;
  const double seconds = frames.back().time - frames.front().time;
  setup.config.run.frames_per_second = double(frames.size() - 1) / seconds;
  setup.mill_speed = turning_speed(frames, mill);
  setup.frame_count = static_cast<std::int64_t>(frames.size());
  double most = 0;
  const SeenFrame* fullest = &frames.front();
  for (const SeenFrame& f : frames)
    if (double(f.balls.size()) > most) most = double(f.balls.size()), fullest = &f;
  for (const Sighting& s : fullest->balls)
    if (!std::isnan(s.radius)) setup.balls.radius.push_back(s.radius);
  return setup;
}

}  // namespace

double turning_speed(std::span<const SeenFrame> frames, const Config& mill) {
  double n = 0, t = 0, a = 0, tt = 0, ta = 0;  // a straight line by least squares
  for (const SeenFrame& f : frames) {
    if (std::isnan(f.mill_angle)) continue;
    const double since = f.time - frames.front().time;
    n += 1;
    t += since;
    a += f.mill_angle;
    tt += since * since;
    ta += since * f.mill_angle;
  }
  return n < 2 ? rad_s_from_rpm(speed_rpm(mill.mill)) : (n * ta - t * a) / (n * tt - t * t);
}

ChargeMotion motion_of(std::span<const SeenFrame> frames, const Config& mill) {
  analysis::FrameMeasurer measurer(setup_of(frames, mill));
  std::vector<TrackPoint> points;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const SeenFrame &here = frames[i], &before = frames[i > 0 ? i - 1 : 0],
                    &after = frames[std::min(i + 1, frames.size() - 1)];
    points.clear();
    for (const Sighting& s : here.balls) {
      if (std::isnan(s.radius)) continue;
      TrackPoint& p = points.emplace_back();
      p.frame = static_cast<int>(i);
      p.id = s.ball;
      p.time = here.time;
      p.x = s.x;
      p.y = s.y;
      p.radius = s.radius;
      p.spin = s.spin;
      give_velocity(p, before, here, after);
    }
    measurer.add(here.time, here.mill_angle, points);
  }
  ChargeMotion motion = measurer.finish();
  motion.source = MotionSource::kTracks;
  return motion;
}

}  // namespace tumble::diagnose
