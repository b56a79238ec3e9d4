#include "diagnose/typical_paths.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <limits>
#include <string>

#include "core/angle.h"
#include "core/error.h"

namespace tumble::diagnose {
namespace {

constexpr double kShares[] = {0.1, 0.3, 0.5, 0.7, 0.9};

struct Sighting {
  int frame = 0;
  double time = 0, x = 0, y = 0;
};

struct Turn {
  int ball = 0;
  std::size_t from = 0, to = 0;  // of the ball's sightings
  double reach = 0;              // distance from the centre where it crosses the bed's middle [m]
};

// A ball's passages through the half-line from the centre into the bed: where its angle about the centre comes to that
// of the bed once more.
void add_turns(std::vector<Turn>& turns, int ball, const std::vector<Sighting>& path, double cx, double cy,
               double bed_deg) {
  double angle = 0, reach = 0;
  std::size_t from = 0;
  bool open = false;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Sighting &p = path[i - 1], &q = path[i];
    if (q.frame != p.frame + 1) open = false;
    const double before = wrap_180(degrees(std::atan2(p.y - cy, p.x - cx)) - bed_deg);
    const double after = wrap_180(degrees(std::atan2(q.y - cy, q.x - cx)) - bed_deg);
    angle += wrap_180(after - before);
    if (q.frame != p.frame + 1 || !(before < 0 && after >= 0 && after - before < 90)) continue;
    if (open && angle > 270) turns.push_back({ball, from, i, reach});
    open = true;
    from = i;
    angle = 0;
    reach = std::hypot(q.x - cx, q.y - cy);
  }
}

BallPath part(int ball, double share, const std::vector<Sighting>& path, std::size_t from, std::size_t to) {
  BallPath out{.ball = ball, .share = share};
  for (std::size_t i = from; i <= to; ++i) {
    out.time.push_back(path[i].time - path[from].time);
    out.x.push_back(path[i].x);
    out.y.push_back(path[i].y);
  }
  return out;
}

}  // namespace

std::vector<BallPath> paths_of(const ChargeMotion& m, std::span<const int> balls, double seconds) {
  std::map<int, std::vector<Sighting>> seen;
  for (const int ball : balls) seen[ball];
  int first = std::numeric_limits<int>::max(), last = -1;
  for (const TrackPoint& p : m.tracks) {
    first = std::min(first, p.id);
    last = std::max(last, p.id);
    if (const auto at = seen.find(p.id); at != seen.end()) at->second.push_back({p.frame, p.time, p.x, p.y});
  }
  std::vector<BallPath> paths;
  for (const int ball : balls) {
    const std::vector<Sighting>& path = seen[ball];
    if (path.empty())
      throw InputError(m.origin, "has no ball " + std::to_string(ball) +
                                     (last < 0 ? "; no ball was followed in it"
                                               : "; its balls are numbered from " + std::to_string(first) + " to " +
                                                     std::to_string(last)));
    std::size_t best_from = 0, best_to = 0, from = 0;
    for (std::size_t i = 0; i < path.size(); ++i) {
      if (i > 0 && path[i].frame != path[i - 1].frame + 1) from = i;
      if (path[i].time - path[from].time > path[best_to].time - path[best_from].time) best_from = from, best_to = i;
      if (path[best_to].time - path[best_from].time >= seconds) break;
    }
    paths.push_back(part(ball, kNotGiven, path, best_from, best_to));
  }
  return paths;
}

std::vector<BallPath> typical_paths(const ChargeMotion& m, double seconds) {
  const double cx = m.centre_of_circulation_x.value, cy = m.centre_of_circulation_y.value;
  if (std::isnan(cx) || std::isnan(cy)) return {};
  std::map<int, std::vector<Sighting>> balls;
  double first = kNotGiven;
  for (const TrackPoint& p : m.tracks) {
    if (std::isnan(first)) first = p.time;
    if (p.time - first > seconds) break;  // rows are in order of frames
    balls[p.id].push_back({p.frame, p.time, p.x, p.y});
  }
  // The bed lies beyond the centre of circulation as seen from the axis.
  const double bed_deg = degrees(std::atan2(cy, cx));
  std::vector<Turn> turns;
  for (const auto& [ball, path] : balls) add_turns(turns, ball, path, cx, cy, bed_deg);
  std::sort(turns.begin(), turns.end(), [](const Turn& p, const Turn& q) { return p.reach < q.reach; });
  std::vector<BallPath> paths;
  if (turns.size() < std::size(kShares)) return paths;
  for (const double share : kShares) {
    const Turn& turn = turns[static_cast<std::size_t>(share * static_cast<double>(turns.size() - 1))];
    paths.push_back(part(turn.ball, share, balls[turn.ball], turn.from, turn.to));
  }
  return paths;
}

}  // namespace tumble::diagnose
