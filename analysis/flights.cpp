#include "analysis/flights.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/angle.h"
#include "core/random.h"

namespace tumble::analysis {
namespace {

struct Polynomial {                            // x(t) about a middle time, degree 2, least squares
  double value = 0, slope = 0, curvature = 0;  // curvature = second derivative
};

// Rows [from, to) of one track; `t0` the middle.
template <class Get>
Polynomial fit_parabola(std::span<const TrackPoint> p, double t0, Get get) {
  double s[5] = {}, b[3] = {};
  for (const TrackPoint& q : p) {
    const double t = q.time - t0, v = get(q);
    double power = 1;
    for (int k = 0; k < 5; ++k, power *= t) {
      s[k] += power;
      if (k < 3) b[k] += power * v;
    }
  }
  // Cramer's rule on the 3 x 3 normal equations.
  const double d =
      s[0] * (s[2] * s[4] - s[3] * s[3]) - s[1] * (s[1] * s[4] - s[2] * s[3]) + s[2] * (s[1] * s[3] - s[2] * s[2]);
  Polynomial r;
  r.value =
      (b[0] * (s[2] * s[4] - s[3] * s[3]) - s[1] * (b[1] * s[4] - b[2] * s[3]) + s[2] * (b[1] * s[3] - b[2] * s[2])) /
      d;
  r.slope =
      (s[0] * (b[1] * s[4] - b[2] * s[3]) - b[0] * (s[1] * s[4] - s[2] * s[3]) + s[2] * (s[1] * b[2] - s[2] * b[1])) /
      d;
  r.curvature =
      2 *
      (s[0] * (s[2] * b[2] - s[3] * b[1]) - s[1] * (s[1] * b[2] - s[2] * b[1]) + b[0] * (s[1] * s[3] - s[2] * s[2])) /
      d;
  return r;
}

// A fall with gravity known: straight lines in x and in y + g t^2 / 2.
struct Fall {
  double t0 = 0, x = 0, vx = 0, y = 0, vy = 0, g = 0;
  double miss(const TrackPoint& p) const {
    const double t = p.time - t0;
    return std::hypot(p.x - x - vx * t, p.y - y - vy * t + 0.5 * g * t * t);
  }
};

Fall fit_fall(std::span<const TrackPoint> p, double g) {
  Fall f;
  f.g = g;
  f.t0 = 0.5 * (p.front().time + p.back().time);
  double n = 0, st = 0, stt = 0, sx = 0, sxt = 0, sy = 0, syt = 0;
  for (const TrackPoint& q : p) {
    const double t = q.time - f.t0, y = q.y + 0.5 * g * t * t;
    n += 1;
    st += t;
    stt += t * t;
    sx += q.x;
    sxt += q.x * t;
    sy += y;
    syt += y * t;
  }
  const double d = n * stt - st * st;
  f.vx = (n * sxt - st * sx) / d;
  f.x = (sx - f.vx * st) / n;
  f.vy = (n * syt - st * sy) / d;
  f.y = (sy - f.vy * st) / n;
  return f;
}

void flights_of_ball(std::span<const TrackPoint> p, double g, std::vector<Flight>& flights) {
  const std::size_t n = p.size();
  std::vector<char> falling(n, 0);
  std::size_t from = 0, to = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double half = 0.5 * kLeastFlight;
    while (p[i].time - p[from].time > half + 1e-9) ++from;
    while (to < n && p[to].time - p[i].time <= half + 1e-9) ++to;
    std::size_t a = from, b = to;
    while (b - a < 5 && (a > 0 || b < n)) {  // slow films: the window is five frames at least
      if (a > 0) --a;
      if (b < n && b - a < 5) ++b;
    }
    if (b - a < 5 || p[b - 1].time - p[a].time > 4 * kLeastFlight) continue;
    const auto window = p.subspan(a, b - a);
    const double ax = fit_parabola(window, p[i].time, [](const TrackPoint& q) { return q.x; }).curvature;
    const double ay = fit_parabola(window, p[i].time, [](const TrackPoint& q) { return q.y; }).curvature;
    falling[i] = std::hypot(ax, ay + g) < 0.3 * g;
  }
  for (std::size_t i = 0; i < n;) {
    if (!falling[i]) {
      ++i;
      continue;
    }
    std::size_t end = i;
    while (end < n && falling[end]) ++end;
    if (end - i >= 3) {
      const Fall fall = fit_fall(p.subspan(i, end - i), g);
      // Both ends are where the ball leaves the parabola by a tenth of its radius.
      const double tolerance = std::isnan(p[i].radius) ? 1e-3 * g : 0.1 * p[i].radius;
      std::size_t first = i, last = end - 1;
      while (first > 0 && fall.miss(p[first - 1]) < tolerance) --first;
      while (last + 1 < n && fall.miss(p[last + 1]) < tolerance) ++last;
      while (first < last && fall.miss(p[first]) >= tolerance) ++first;
      while (last > first && fall.miss(p[last]) >= tolerance) --last;
      if (p[last].time - p[first].time >= kLeastFlight - 1e-9)
        flights.push_back({p[i].id, p[first].time, p[last].time, p[first].x, p[first].y, p[last].x, p[last].y,
                           first > 0, last + 1 < n});
      end = std::max(end, last + 1);
    }
    i = end;
  }
}

// Median of directions about their circular mean, its error by the bootstrap over flights (taken as independent).
Estimate median_direction(const std::vector<double>& directions) {
  if (directions.empty()) return {};
  double c = 0, s = 0;
  for (double d : directions) {
    c += std::cos(radians(d));
    s += std::sin(radians(d));
  }
  const double mean = degrees(std::atan2(s, c));
  std::vector<double> about;
  for (double d : directions) about.push_back(wrap_180(d - mean));
  const auto median = [](std::vector<double>& v) {
    std::sort(v.begin(), v.end());
    return 0.5 * (v[(v.size() - 1) / 2] + v[v.size() / 2]);
  };
  Estimate e;
  std::vector<double> sorted = about;
  e.value = wrap_360(mean + median(sorted));
  if (about.size() < 8) return e;
  Random random(2);
  double sum = 0, squares = 0;
  constexpr int kReplicates = 200;
  for (int r = 0; r < kReplicates; ++r) {
    std::vector<double> sample;
    for (std::size_t k = 0; k < about.size(); ++k) sample.push_back(about[random.below(about.size())]);
    const double m = median(sample);
    sum += m;
    squares += m * m;
  }
  e.se = std::sqrt(std::max(0.0, squares - sum * sum / kReplicates) / (kReplicates - 1));
  return e;
}

}  // namespace

std::vector<Flight> find_flights(std::span<const TrackPoint> tracks, double g) {
  std::vector<TrackPoint> sorted(tracks.begin(), tracks.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const TrackPoint& a, const TrackPoint& b) {
    return a.id != b.id ? a.id < b.id : a.time < b.time;
  });
  std::vector<Flight> flights;
  for (std::size_t i = 0; i < sorted.size();) {
    std::size_t end = i;
    while (end < sorted.size() && sorted[end].id == sorted[i].id) ++end;
    flights_of_ball(std::span(sorted).subspan(i, end - i), g, flights);
    i = end;
  }
  return flights;
}

FlightAngles flight_angles(std::span<const Flight> flights, double shell_reach, double least_length) {
  std::vector<double> departures, impacts;
  for (const Flight& f : flights) {
    if (!f.whole_start || std::hypot(f.start_x, f.start_y) < shell_reach) continue;
    if (std::hypot(f.end_x - f.start_x, f.end_y - f.start_y) < least_length) continue;
    departures.push_back(wrap_360(degrees(std::atan2(f.start_y, f.start_x))));
    if (f.whole_end) impacts.push_back(wrap_360(degrees(std::atan2(f.end_y, f.end_x))));
  }
  return {median_direction(departures), median_direction(impacts)};
}

Estimate flight_share(std::span<const TrackPoint> tracks, std::span<const Flight> flights) {
  std::map<int, std::vector<const Flight*>> by_ball;
  for (const Flight& f : flights) by_ball[f.id].push_back(&f);
  std::map<int, std::pair<double, double>> frames;  // balls in flight, balls
  for (const TrackPoint& p : tracks) {
    auto& [flying, all] = frames[p.frame];
    all += 1;
    const auto ball = by_ball.find(p.id);
    if (ball != by_ball.end())
      flying += std::any_of(ball->second.begin(), ball->second.end(), [&](const Flight* f) {
        return p.time >= f->start_time - 1e-9 && p.time <= f->end_time + 1e-9;
      });
  }
  std::vector<double> shares;
  for (const auto& [frame, counts] : frames) shares.push_back(counts.first / counts.second);
  return shares.empty() ? Estimate{} : mean_of_series(shares);
}

}  // namespace tumble::analysis
