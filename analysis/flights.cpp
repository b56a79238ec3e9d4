#include "analysis/flights.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "core/angle.h"
#include "core/quantile.h"
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

// A fall under a gravity that is known but for what scale, clock and roll are wrong by.
struct Fall {
  double t0 = 0, x = 0, vx = 0, ax = 0, y = 0, vy = 0, ay = 0;
  double x_at(double time) const { return x + (vx + 0.5 * ax * (time - t0)) * (time - t0); }
  double y_at(double time) const { return y + (vy + 0.5 * ay * (time - t0)) * (time - t0); }
  double miss(const TrackPoint& p) const { return std::hypot(p.x - x_at(p.time), p.y - y_at(p.time)); }
};

// `off`: standard deviation of a place. Of a short flight gravity is taken as it is; a long one would leave a parabola
// whose gravity is off by a hundredth long before it lands.
Fall fit_fall(std::span<const TrackPoint> p, double g, double off) {
  constexpr double kDoubt = 0.03;  // of gravity, in each direction
  Fall f;
  f.t0 = 0.5 * (p.front().time + p.back().time);
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
  for (const TrackPoint& q : p) {
    const double t = q.time - f.t0;
    const Eigen::Vector3d basis(1, t, 0.5 * t * t);
    normal += basis * basis.transpose();
    right += basis * Eigen::RowVector2d(q.x, q.y + 0.5 * g * t * t);
  }
  normal(2, 2) += std::pow(off / (kDoubt * g), 2);
  const Eigen::Matrix<double, 3, 2> way = normal.ldlt().solve(right);
  f.x = way(0, 0);
  f.vx = way(1, 0);
  f.ax = way(2, 0);
  f.y = way(0, 1);
  f.vy = way(1, 1);
  f.ay = way(2, 1) - g;
  return f;
}

// When a ball whose last place on its fall is at `first` began to fall. What carried it let go at once, so that before,
// it strays from the fall with the square of time; a tenth of a radius is some hundredths of a second, in which a mill
// turns by degrees.
double start_of(const Fall& fall, std::span<const TrackPoint> p, std::size_t first, std::size_t from,
                double tolerance) {
  constexpr double kFar = 16;         // tolerances, up to which strays follow that law
  constexpr std::size_t kPlaces = 8;  // looked at
  const double until = p[first].time;
  double n = 0, st = 0, sr = 0, stt = 0, str = 0;
  for (std::size_t k = first; k-- > from && first - k <= kPlaces;) {
    const double miss = fall.miss(p[k]), t = p[k].time - until;
    if (miss > kFar * tolerance) break;
    if (miss < tolerance) continue;
    const double root = std::sqrt(miss);
    n += 1;
    st += t;
    sr += root;
    stt += t * t;
    str += t * root;
  }
  const double spread = n * stt - st * st, slope = spread > 0 ? (n * str - st * sr) / spread : 0;
  if (!(slope < 0)) return until;
  return until + std::max(0.0, (st - sr / slope) / n);
}

// What blurs the places, along one axis: third differences of neighbouring sightings hold next to nothing else.
struct Blur {
  double sigma = 0;         // standard deviation
  double interval = 0.005;  // between sightings [s]
};

Blur blur_of(std::span<const TrackPoint> sorted) {
  std::vector<double> thirds, intervals;
  for (std::size_t i = 3; i < sorted.size(); ++i) {
    const TrackPoint *p = &sorted[i - 3], *q = &sorted[i];
    const double dt = (q->time - p->time) / 3;
    if (p->id != q->id || !(dt > 0)) continue;
    bool even = true;
    for (int k = 0; k < 3; ++k) even = even && std::abs(p[k + 1].time - p[k].time - dt) < 0.3 * dt;
    if (!even) continue;
    thirds.push_back(std::abs(p[3].x - 3 * p[2].x + 3 * p[1].x - p[0].x));
    thirds.push_back(std::abs(p[3].y - 3 * p[2].y + 3 * p[1].y - p[0].y));
    intervals.push_back(dt);
  }
  if (thirds.empty()) return {};
  return {median_of(std::move(thirds)) / (0.6745 * std::sqrt(20.0)), median_of(std::move(intervals))};
}

// Shortest stretch whose curvature is known to a tenth of gravity: that of n even places has the deviation
// sigma sqrt(720 / n^5) / interval^2.
double window_for(const Blur& blur, double g) {
  const double ratio = blur.sigma / (0.1 * g * blur.interval * blur.interval);
  return std::clamp((std::pow(720 * ratio * ratio, 0.2) - 1) * blur.interval, kLeastFlight, 2 * kLeastFlight);
}

void flights_of_ball(std::span<const TrackPoint> p, double g, const Blur& blur, std::vector<Flight>& flights) {
  const std::size_t n = p.size();
  const double half = 0.5 * window_for(blur, g);
  std::vector<char> falling(n, 0);
  std::size_t from = 0, to = 0, free_from = 0;  // the last: of any flight before
  for (std::size_t i = 0; i < n; ++i) {
    while (p[i].time - p[from].time > half + 1e-9) ++from;
    while (to < n && p[to].time - p[i].time <= half + 1e-9) ++to;
    std::size_t a = from, b = to;
    while (b - a < 5 && (a > 0 || b < n)) {  // slow films: the window is five frames at least
      if (a > 0) --a;
      if (b < n && b - a < 5) ++b;
    }
    if (b - a < 5 || p[b - 1].time - p[a].time > 8 * half) continue;
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
      // Both ends are where the ball leaves the parabola by a tenth of its radius, or by more than places are blurred;
      // one place that is off ends no flight.
      const double tolerance = std::max(std::isnan(p[i].radius) ? 1e-3 * g : 0.1 * p[i].radius, 3.5 * blur.sigma);
      std::size_t first = i, last = end - 1;
      Fall fall;
      const auto on = [&](std::size_t k) { return k < n && fall.miss(p[k]) < tolerance; };
      for (int round = 0; round < 4 && last >= first + 2; ++round) {  // a longer flight is a better parabola
        fall = fit_fall(p.subspan(first, last + 1 - first), g, tolerance / 3.5);
        while (first > free_from && (on(first - 1) || (first > free_from + 1 && on(first - 2)))) --first;
        while (last + 1 < n && (on(last + 1) || on(last + 2))) ++last;
        while (first < last && !on(first)) ++first;
        while (last > first && !on(last)) --last;
      }
      if (p[last].time - p[first].time >= kLeastFlight - 1e-9) {
        const bool whole_start = first > 0;
        const double hugging = std::atan2(p[first].y, p[first].x);
        double start = p[first].time;
        for (int round = 0; round < 3; ++round) {  // places that hug the fall before it begins bend it
          start =
              std::max(start, std::min(start_of(fall, p, first, free_from, tolerance), p[last].time - kLeastFlight));
          while (first + 3 < last && p[first].time < start) ++first;
          fall = fit_fall(p.subspan(first, last + 1 - first), g, tolerance / 3.5);
        }
        const double x = fall.x_at(start), y = fall.y_at(start);
        flights.push_back({p[i].id, start, p[last].time, x, y, p[last].x, p[last].y, whole_start, last + 1 < n,
                           wrap_180(degrees(std::atan2(y, x) - hugging))});
      }
      free_from = end = std::max(end, last + 1);
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

struct Landing {
  double angle = 0;     // from a common origin, along the flights [degrees]
  bool landed = false;  // else lost on the way, here
};

// Median of landings of which some are only known to lie beyond where the flight was lost (Kaplan & Meier 1958): the
// longer a flight, the more likely it is lost, so that those seen to land tell of the short ones. NaN where too many
// were lost.
double median_landing(std::vector<Landing>& landings) {
  std::sort(landings.begin(), landings.end(), [](const Landing& a, const Landing& b) {
    return a.angle != b.angle ? a.angle < b.angle : a.landed && !b.landed;
  });
  constexpr double kHalf = 0.5 + 1e-9;
  double flying = 1, at_half = kNotGiven;
  for (std::size_t i = 0; i < landings.size(); ++i) {
    if (!landings[i].landed) continue;
    if (!std::isnan(at_half)) return 0.5 * (at_half + landings[i].angle);  // an even number: between the middle two
    flying *= 1 - 1 / static_cast<double>(landings.size() - i);
    if (flying > kHalf) continue;
    if (flying < 1 - kHalf) return landings[i].angle;
    at_half = landings[i].angle;
  }
  return at_half;
}

Estimate impact_of(std::vector<Landing> landings, double origin_deg) {
  const double median = median_landing(landings);
  if (std::isnan(median)) return {};
  Estimate e{wrap_360(origin_deg + median), kNotGiven};
  if (landings.size() < 8) return e;
  Random random(3);
  double sum = 0, squares = 0, n = 0;
  constexpr int kReplicates = 200;
  std::vector<Landing> sample;
  for (int r = 0; r < kReplicates; ++r) {
    sample.clear();
    for (std::size_t k = 0; k < landings.size(); ++k) sample.push_back(landings[random.below(landings.size())]);
    double m = median_landing(sample);
    if (std::isnan(m)) m = sample.back().angle;  // where the last one was lost, at least
    sum += m;
    squares += m * m;
    n += 1;
  }
  // Where flights are lost need not be by chance: half of what they move the median by.
  std::vector<Landing> seen;
  std::copy_if(landings.begin(), landings.end(), std::back_inserter(seen), [](const Landing& l) { return l.landed; });
  e.se = std::hypot(std::sqrt(std::max(0.0, squares - sum * sum / n) / (n - 1)), 0.5 * (median - median_landing(seen)));
  return e;
}

}  // namespace

std::vector<Flight> find_flights(std::span<const TrackPoint> tracks, double g) {
  std::vector<TrackPoint> sorted(tracks.begin(), tracks.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const TrackPoint& a, const TrackPoint& b) {
    return a.id != b.id ? a.id < b.id : a.time < b.time;
  });
  const Blur blur = blur_of(sorted);
  std::vector<Flight> flights;
  for (std::size_t i = 0; i < sorted.size();) {
    std::size_t end = i;
    while (end < sorted.size() && sorted[end].id == sorted[i].id) ++end;
    flights_of_ball(std::span(sorted).subspan(i, end - i), g, blur, flights);
    i = end;
  }
  return flights;
}

void FlightLog::take(double until) {
  for (const Flight& f : find_flights(recent_, g_))
    if (f.start_time >= taken_until_ && f.start_time < until) flights_.push_back(f);
  taken_until_ = until;
}

void FlightLog::add(std::span<const TrackPoint> frame) {
  constexpr std::size_t kMost = 400'000;  // points; many flights' time of any mill that can be filmed
  recent_.insert(recent_.end(), frame.begin(), frame.end());
  if (recent_.size() < kMost || frame.empty()) return;
  const double first = recent_.front().time, span = recent_.back().time - first;
  take(first + 0.6 * span);  // those that begin later may go on
  std::erase_if(recent_, [&](const TrackPoint& p) { return p.time < first + 0.4 * span; });
}

std::vector<Flight> FlightLog::finish() {
  take(1e300);
  return std::move(flights_);
}

FlightAngles flight_angles(std::span<const Flight> flights, double shell_reach, double least_length) {
  // What carried a ball may let go at once, or fade: it then strays with the cube of time, and the start lies 0.4 of
  // the way back to where it hugs the parabola; anything between is as likely.
  constexpr double kFades = 0.4 / 3.464;
  std::vector<double> departures, hugged;
  std::vector<const Flight*> worthy;
  for (const Flight& f : flights) {
    if (!f.whole_start || std::hypot(f.start_x, f.start_y) < shell_reach) continue;
    if (std::hypot(f.end_x - f.start_x, f.end_y - f.start_y) < least_length) continue;
    departures.push_back(wrap_360(degrees(std::atan2(f.start_y, f.start_x))));
    hugged.push_back(f.hugged);
    worthy.push_back(&f);
  }
  FlightAngles angles{median_direction(departures), {}};
  if (!hugged.empty()) {
    angles.departure_deg.se = std::hypot(angles.departure_deg.se, kFades * median_of(std::move(hugged)));
  }
  constexpr double kBefore = 60;  // by which flights may end short of where they usually begin [degrees]
  const double origin = angles.departure_deg.value - kBefore;
  std::vector<Landing> landings;
  for (const Flight* f : worthy)
    landings.push_back({wrap_360(degrees(std::atan2(f->end_y, f->end_x)) - origin), f->whole_end});
  angles.impact_toe_deg = impact_of(std::move(landings), origin);
  return angles;
}

Estimate flight_share(const Spool<TrackPoint>& tracks, std::span<const Flight> flights) {
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
