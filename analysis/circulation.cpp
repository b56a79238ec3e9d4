#include "analysis/circulation.h"

#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "core/units.h"

namespace tumble::analysis {

Estimate circulation_time(const Spool<TrackPoint>& tracks, const FieldStatistics& field, double centre_x,
                          double centre_y, double least) {
  if (std::isnan(centre_x) || std::isnan(centre_y)) return {};
  const std::vector<bool> charge = field.charge();
  const auto counts = [&](const TrackPoint& p) {
    const std::size_t cell = field.cell_at(p.x, p.y);
    return cell < charge.size() && charge[cell] && std::hypot(p.x - centre_x, p.y - centre_y) > least;
  };
  struct Turned {
    double angle = 0, time = 0;
  };
  std::map<int, Turned> frames;
  std::map<int, TrackPoint> before;  // by ball
  double angle = 0, time = 0;
  for (const TrackPoint& p : tracks) {
    const auto [place, is_new] = before.try_emplace(p.id, p);
    const TrackPoint last = std::exchange(place->second, p);
    if (!is_new && p.frame == last.frame + 1 && p.time > last.time && counts(p) && counts(last)) {
      const double ax = last.x - centre_x, ay = last.y - centre_y, bx = p.x - centre_x, by = p.y - centre_y;
      const double turn = std::atan2(ax * by - ay * bx, ax * bx + ay * by);
      frames[p.frame].angle += turn;
      frames[p.frame].time += p.time - last.time;
      angle += turn;
      time += p.time - last.time;
    }
  }
  if (!(angle > 0)) return {};
  // A ratio of sums: its error is that of each frame's departure from it.
  std::vector<double> departures;
  const double speed = angle / time, n = static_cast<double>(frames.size());
  for (const auto& [frame, turned] : frames) departures.push_back((turned.angle - speed * turned.time) / (time / n));
  return {2 * kPi / speed, 2 * kPi / (speed * speed) * mean_of_series(departures).se};
}

}  // namespace tumble::analysis
