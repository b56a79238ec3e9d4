#include "diagnose/contact_events.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/units.h"

namespace tumble::diagnose {
namespace {

// Of the radii: who is nearer may touch, for all that tracking knows. Flights are many and can do with less.
constexpr double kClearance = 0.08, kWide = 0.12, kWallClearance = 0.24;
constexpr double kFastest = 0.6;     // of the radii: gap from which a pair may touch before the next frame
constexpr double kWallSlack = 0.03;  // of the mill's radius: what a camera's scale may be wrong by
constexpr double kSlack = 0.08;      // of the touching distance: by how much two paths may miss the touch
constexpr double kReach = 0.05;      // [s] of path before and after an impact
constexpr std::size_t kLeastBefore = 4, kLeastAfter = 3, kMostReach = 24;
constexpr double kLongest = 0.1, kShortest = 0.028;  // of a flight's window [s]
constexpr std::size_t kLeastFlight = 6;
constexpr int kEdge = 2;          // frames at either end of a flight
constexpr double kStraight = 4;   // standard deviations of a variance
constexpr double kFloor = 0.005;  // of a radius: scatter that is nothing
constexpr double kStray = 2.5;    // times the usual noise of a pair's middle

double square(double v) { return v * v; }

double median(std::vector<double> v) {
  if (v.empty()) return 0;
  const auto middle = v.begin() + static_cast<long>(v.size() / 2);
  std::nth_element(v.begin(), middle, v.end());
  return *middle;
}

bool is_straight(double scatter, int freedom, double usual, double radius) {
  return square(scatter) < square(usual) * (1 + kStraight * std::sqrt(2.0 / freedom)) + square(kFloor * radius);
}

// A body's places under gravity g (0 for those of one ball against another): velocity in the middle of its times.
struct Path {
  double time = 0, x = 0, y = 0, vx = 0, vy = 0, spread = 0, scatter2 = 0, fall = 0;
  int freedom = 0;

  double px(double t) const { return x + vx * (t - time); }
  double py(double t) const { return y + vy * (t - time) - 0.5 * fall * square(t - time); }
};

struct Place {
  double time, x, y;
};

template <class Chosen>
Path path_of(const std::vector<Place>& places, double fall, const Chosen& chosen) {
  Path p;
  p.fall = fall;
  double n = 0;
  for (std::size_t k = 0; k < places.size(); ++k)
    if (chosen(k)) p.time += places[k].time, n += 1;
  p.time /= n;
  for (std::size_t k = 0; k < places.size(); ++k)
    if (chosen(k)) {
      const Place& at = places[k];
      const double t = at.time - p.time, y = at.y + 0.5 * fall * t * t;
      p.x += at.x / n;
      p.y += y / n;
      p.spread += t * t;
      p.vx += t * at.x;
      p.vy += t * y;
    }
  p.vx /= p.spread;
  p.vy /= p.spread;
  for (std::size_t k = 0; k < places.size(); ++k)
    if (chosen(k))
      p.scatter2 += square(places[k].x - p.px(places[k].time)) + square(places[k].y - p.py(places[k].time));
  p.freedom = 2 * static_cast<int>(n) - 4;
  return p;
}

Path path_of(const std::vector<Place>& places, double fall) {
  return path_of(places, fall, [](std::size_t) { return true; });
}

// Where two paths meet along the normal, and that normal; time NaN where they do not.
struct Kink {
  double time = kNotGiven, nx = 0, ny = 0, distance = 0;
};

Kink kink_of(const Path& before, const Path& after, double guess) {
  Kink k{guess, 0, 0, 0};
  for (int round = 0; round < 6; ++round) {
    const double x = 0.5 * (before.px(k.time) + after.px(k.time)), y = 0.5 * (before.py(k.time) + after.py(k.time));
    k.distance = std::hypot(x, y);
    k.nx = x / k.distance;
    k.ny = y / k.distance;
    const double gap = (after.px(k.time) - before.px(k.time)) * k.nx + (after.py(k.time) - before.py(k.time)) * k.ny;
    const double bend =
        (after.vx - before.vx) * k.nx + (after.vy - before.vy + before.fall * (after.time - before.time)) * k.ny;
    k.time -= gap / bend;
    if (!std::isfinite(k.time)) return {};
  }
  return k;
}

}  // namespace

// The frames about a possible impact in which its bodies are alone with each other.
struct ContactEvents::Piece {
  std::vector<Place> relative, middle;
  std::vector<double> spin_i, spin_j, mill_angle;
};

double mean_radius(std::span<const BallClass> classes) {
  double radii = 0, shares = 0;
  for (const BallClass& b : classes) radii += b.share * b.radius, shares += b.share;
  return radii / shares;
}

ContactEvents::ContactEvents(const Config& config)
    : shape_(make_mill_shape(config)),
      classes_(config.charge.balls),
      mill_speed_(rad_s_from_rpm(speed_rpm(config.mill))),
      mean_radius_(mean_radius(classes_)) {}

double ContactEvents::mass_of(double radius) const {
  const BallClass* nearest = &classes_.front();
  for (const BallClass& b : classes_)
    if (std::abs(b.radius - radius) < std::abs(nearest->radius - radius)) nearest = &b;
  return nearest->mass;
}

const ContactEvents::Body* ContactEvents::find(const Moment& moment, int ball) {
  const auto at = std::lower_bound(moment.bodies.begin(), moment.bodies.end(), ball,
                                   [](const Body& b, int number) { return b.seen.ball < number; });
  return at != moment.bodies.end() && at->seen.ball == ball ? &*at : nullptr;
}

bool ContactEvents::near_lifter(const Sighting& ball, double mill_angle, double reach) const {
  const double place = std::sqrt(ball.x * ball.x + ball.y * ball.y);
  if (place + reach <= shape_.tip_radius) return false;
  if (std::isnan(mill_angle) || shape_.sections.empty()) return shape_.tip_radius < shape_.radius;
  const double turn = std::atan2(ball.y, ball.x) - mill_angle;
  const double nearest = std::round(turn / shape_.pitch());
  for (int side = -1; side <= 1; ++side) {
    const double lifter = nearest + side,
                 number = lifter - shape_.lifter_count * std::floor(lifter / shape_.lifter_count);
    const int section = shape_.section_of[static_cast<std::size_t>(number)];
    if (section < 0) continue;
    const double away = turn - lifter * shape_.pitch();
    if (std::abs(away) > 0.5 * shape_.pitch() + 1.2 * reach / place) continue;  // beyond its share of the shell
    const double u = place * std::cos(away), v = place * std::sin(away);
    const auto& chain = shape_.sections[static_cast<std::size_t>(section)].chain;
    for (std::size_t k = 1; k < chain.size(); ++k) {
      const Eigen::Vector2d along = chain[k] - chain[k - 1], from = Eigen::Vector2d(u, v) - chain[k - 1];
      const double share = std::clamp(from.dot(along) / along.squaredNorm(), 0.0, 1.0);
      if ((from - share * along).norm() < reach) return true;
    }
  }
  return false;
}

ContactEvents::Moment ContactEvents::look(double time, double mill_angle, std::span<const Sighting> balls) const {
  Moment m{time, mill_angle, {}, {}};
  m.bodies.reserve(balls.size());
  m.pairs.reserve(4 * balls.size());
  double widest = 0;
  for (const Sighting& s : balls) {
    Body b{.seen = s};
    if (!(s.radius > 0)) b.seen.radius = mean_radius_;
    widest = std::max(widest, b.seen.radius);
    const double r = b.seen.radius;
    b.wall_gap = shape_.radius - std::sqrt(s.x * s.x + s.y * s.y) - r;
    b.at_plate = b.wall_gap < kWallClearance * r;
    b.at_lifter = near_lifter(b.seen, mill_angle, (1 + kWallClearance) * r);
    b.lonely = !b.at_plate && !b.at_lifter;
    m.bodies.push_back(b);
  }
  std::vector<std::pair<double, std::size_t>> by_x;
  by_x.reserve(m.bodies.size());
  for (std::size_t k = 0; k < m.bodies.size(); ++k) by_x.emplace_back(m.bodies[k].seen.x, k);
  std::sort(by_x.begin(), by_x.end());
  for (std::size_t k = 0; k < by_x.size(); ++k) {
    Body& a = m.bodies[by_x[k].second];
    const double farthest = by_x[k].first + (1 + kFastest) * (a.seen.radius + widest);
    for (std::size_t l = k + 1; l < by_x.size() && by_x[l].first <= farthest; ++l) {
      Body& b = m.bodies[by_x[l].second];
      const double dx = b.seen.x - a.seen.x, dy = b.seen.y - a.seen.y;
      const double touching = a.seen.radius + b.seen.radius, far = (1 + kFastest) * touching;
      if (dx * dx + dy * dy > far * far) continue;
      const double gap = std::sqrt(dx * dx + dy * dy) - touching;
      m.pairs.push_back({by_x[k].second, by_x[l].second, gap});
      a.within_reach = b.within_reach = true;
      if (gap < kWide * touching) a.lonely = b.lonely = false;
      if (gap > kClearance * touching) continue;
      ++a.near;
      ++b.near;
      a.partner = b.seen.ball;
      b.partner = a.seen.ball;
    }
  }
  return m;
}

void ContactEvents::add(double time, double mill_angle, std::span<const Sighting> balls) {
  moments_.push_back(look(time, mill_angle, balls));
  fly(moments_.back());
  if (reach_ == 0) {
    if (moments_.size() < 3) return;
    spacing_ = (moments_.back().time - moments_.front().time) / 2;
    reach_ = std::clamp(static_cast<std::size_t>(std::lround(kReach / spacing_)), kLeastBefore + 1, kMostReach);
  }
  if (moments_.size() < 2 * reach_ + 1) return;
  search();
  moments_.pop_front();
}

// That a ball is alone is seen with the noise of that very frame: the first and last frames of a flight are chosen by
// their noise, and left out.
void ContactEvents::fly(const Moment& now) {
  std::vector<Flight> going_on;
  auto before = open_.begin();
  for (const Body& b : now.bodies) {
    for (; before != open_.end() && before->ball < b.seen.ball; ++before) close(*before, kEdge);
    Flight f{.ball = b.seen.ball, .skip = kEdge, .radius = b.seen.radius};
    if (before != open_.end() && before->ball == b.seen.ball) {
      if (b.lonely && (spacing_ == 0 || now.time - before->last < 1.5 * spacing_))
        f = std::move(*before);
      else
        close(*before, kEdge);
      ++before;
    }
    if (!b.lonely) continue;
    f.last = now.time;
    if (f.skip > 0) {
      --f.skip;
    } else {
      f.t.push_back(now.time);
      f.x.push_back(b.seen.x);
      f.y.push_back(b.seen.y);
      f.spin.push_back(b.seen.spin);
      if (f.t.back() - f.t.front() >= kLongest) {
        close(f, 0);
        f = {.ball = b.seen.ball, .last = now.time, .radius = b.seen.radius};
      }
    }
    going_on.push_back(std::move(f));
  }
  for (; before != open_.end(); ++before) close(*before, kEdge);
  open_ = std::move(going_on);
}

// The parabola by orthogonal polynomials of the times.
void ContactEvents::close(Flight& f, int left_out) {
  const std::size_t n = f.t.size() - std::min(f.t.size(), static_cast<std::size_t>(left_out));
  if (n < kLeastFlight || f.t[n - 1] - f.t.front() < kShortest) return;
  f.t.resize(n);
  const double count = double(n);
  FlightWindow w{.radius = f.radius, .mass = mass_of(f.radius)};
  for (const double t : f.t) w.time += t / count;
  double t2 = 0, t3 = 0;
  for (const double t : f.t) t2 += square(t - w.time), t3 += square(t - w.time) * (t - w.time);
  const double mean2 = t2 / count, skew = t3 / t2;
  const auto quadratic = [&](double t) { return t * t - mean2 - skew * t; };
  double qq = 0, qx = 0, qy = 0, mx = 0, my = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const double t = f.t[k] - w.time, q = quadratic(t);
    mx += f.x[k] / count;
    my += f.y[k] / count;
    w.vx += t * f.x[k] / t2;
    w.vy += t * f.y[k] / t2;
    qq += q * q;
    qx += q * f.x[k];
    qy += q * f.y[k];
  }
  qx /= qq;
  qy /= qq;
  double scatter2 = 0;
  for (std::size_t k = 0; k < n; ++k) {
    const double t = f.t[k] - w.time, q = quadratic(t);
    scatter2 += square(f.x[k] - mx - w.vx * t - qx * q) + square(f.y[k] - my - w.vy * t - qy * q);
  }
  w.x = mx - qx * mean2;
  w.y = my - qy * mean2;
  w.vx -= qx * skew;
  w.vy -= qy * skew;
  w.ax = 2 * qx;
  w.ay = 2 * qy;
  w.information = qq / 4;
  w.half = 0.5 * (f.t.back() - f.t.front());
  double turning = 0;
  for (std::size_t k = 0; k < n; ++k) turning += (f.t[k] - w.time) * f.spin[k] / t2;
  w.spin_slope = turning;
  w.spin_information = t2;
  w.spin = std::accumulate(f.spin.begin(), f.spin.begin() + static_cast<long>(n), 0.0) / count;
  w.freedom = 2 * static_cast<int>(n) - 6;
  w.scatter = std::sqrt(scatter2 / w.freedom);
  flights_.push_back(w);
}

// Pairs that are nearest in the middle of the moments at hand, and balls that are nearest to the shell.
void ContactEvents::search() {
  const Moment &before = moments_[reach_ - 1], &now = moments_[reach_], &after = moments_[reach_ + 1];
  for (const Pair& p : now.pairs) {
    const Body &a = now.bodies[p.a], &b = now.bodies[p.b];
    const auto gap_in = [&](const Moment& m) {
      const Body *i = find(m, a.seen.ball), *j = find(m, b.seen.ball);
      if (!i || !j) return -std::numeric_limits<double>::infinity();
      return std::hypot(j->seen.x - i->seen.x, j->seen.y - i->seen.y) - i->seen.radius - j->seen.radius;
    };
    if (a.near > 1 || b.near > 1 || gap_in(before) <= p.gap || gap_in(after) < p.gap) continue;
    measure(std::min(a.seen.ball, b.seen.ball), std::max(a.seen.ball, b.seen.ball));
  }
  if (std::isnan(now.mill_angle)) return;
  for (const Body& b : now.bodies) {
    if (b.within_reach || b.at_lifter || b.wall_gap > kWallSlack * shape_.radius + kFastest * b.seen.radius) continue;
    const Body *earlier = find(before, b.seen.ball), *later = find(after, b.seen.ball);
    if (!earlier || !later || earlier->wall_gap <= b.wall_gap || later->wall_gap < b.wall_gap) continue;
    if (earlier->within_reach || later->within_reach) continue;
    measure(b.seen.ball, -1);
  }
}

void ContactEvents::measure(int i, int j) {
  const bool at_wall = j < 0;
  // Is a ball alone with its partner in this moment?
  const auto alone = [&](const Body* b, int partner) {
    return b && !b->at_lifter && (b->near == 0 || (b->near == 1 && b->partner == partner)) && (at_wall || !b->at_plate);
  };
  const auto are_free = [&](std::size_t k) {
    return alone(find(moments_[k], i), j) && (at_wall || alone(find(moments_[k], j), i));
  };
  std::size_t first = reach_, last = reach_;
  if (!are_free(reach_)) return;
  while (first > 0 && are_free(first - 1)) --first;
  while (last + 1 < moments_.size() && are_free(last + 1)) ++last;
  if (reach_ - first < kLeastBefore || last - reach_ < kLeastAfter) return;
  const Sighting& one = find(moments_[reach_], i)->seen;
  const Sighting* other = at_wall ? nullptr : &find(moments_[reach_], j)->seen;
  SeenImpact e;
  e.at_wall = at_wall;
  e.radius_i = one.radius;
  e.radius_j = other ? other->radius : 0;
  e.mass_i = mass_of(e.radius_i);
  e.mass_j = other ? mass_of(e.radius_j) : 0;
  Piece piece;
  for (std::size_t k = first; k <= last; ++k) {
    const Moment& m = moments_[k];
    const Sighting& a = find(m, i)->seen;
    piece.spin_i.push_back(a.spin);
    piece.mill_angle.push_back(m.mill_angle);
    if (at_wall) {
      piece.relative.push_back({m.time, a.x, a.y});
      continue;
    }
    const Sighting& b = find(m, j)->seen;
    const double share = e.mass_j / (e.mass_i + e.mass_j);
    piece.relative.push_back({m.time, b.x - a.x, b.y - a.y});
    piece.middle.push_back({m.time, a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)});
    piece.spin_j.push_back(b.spin);
  }

  const double fall = at_wall ? kGravity : 0;
  const double nearest = moments_[reach_].time;
  const std::vector<Place>& r = piece.relative;
  std::vector<Place> before, after;
  Kink kink{nearest, 0, 0, 0};
  // Which frame is before and which is after hangs on the moment of the touch, and that on them.
  for (int round = 0; round < 3; ++round) {
    before.clear();
    after.clear();
    for (const Place& p : r) {
      if (p.time < kink.time - 0.25 * spacing_) before.push_back(p);
      if (p.time > kink.time + 0.25 * spacing_) after.push_back(p);
    }
    if (before.size() < kLeastBefore || after.size() < kLeastAfter) return;
    kink = kink_of(path_of(before, fall), path_of(after, fall), kink.time);
    if (!(std::abs(kink.time - nearest) < 1.5 * spacing_)) return;
  }
  e.time = kink.time;
  const double touching = at_wall ? shape_.radius - e.radius_i : e.radius_i + e.radius_j;
  e.miss = kink.distance - touching;
  if (std::abs(e.miss) > (at_wall ? kWallSlack : kSlack) * touching) return;

  const Path came = path_of(before, fall), went = path_of(after, fall);
  // At the wall body j is the shell: what is seen is the ball, which moves against it with the other sign.
  const double sign = at_wall ? -1 : 1;
  const auto view = [&](const Path& path) {
    SeenImpact::View v;
    const double x = path.px(kink.time), y = path.py(kink.time), d = std::hypot(x, y);
    v.nx = x / d;
    v.ny = y / d;
    v.closing = -sign * (path.vx * v.nx + path.vy * v.ny);
    v.parting = sign * (went.vx * v.nx + went.vy * v.ny);
    v.sliding = sign * (path.vy * v.nx - path.vx * v.ny);
    v.sliding_after = sign * (went.vy * v.nx - went.vx * v.ny);
    v.lag = kink.time - path.time;
    v.spread = path.spread;
    return v;
  };
  e.all = view(came);
  for (std::size_t g = 0; g < 2; ++g)
    e.half[g] = view(path_of(before, fall, [&](std::size_t k) { return k % 2 == g; }));
  e.lag_after = went.time - kink.time;
  e.spread_after = went.spread;
  e.freedom = came.freedom + went.freedom;
  e.scatter = std::sqrt((came.scatter2 + went.scatter2) / e.freedom / (at_wall ? 1 : 2));

  // Away from the touch, for a spin may be the difference of two frames.
  const auto spin_of = [&](const std::vector<double>& spins, bool late, double& lag) {
    double sum = 0, n = 0, away = 0;
    for (std::size_t k = 0; k < r.size(); ++k) {
      const double t = late ? r[k].time - kink.time : kink.time - r[k].time;
      if (t > 1.25 * spacing_ && std::isfinite(spins[k])) sum += spins[k], away += t, n += 1;
    }
    lag = n >= 2 ? away / n : 0;
    return n >= 2 ? sum / n : kNotGiven;
  };
  e.spin_i = spin_of(piece.spin_i, false, e.spin_lag);
  e.spin_i_after = spin_of(piece.spin_i, true, e.spin_lag_after);
  if (at_wall) {
    const double turned = piece.mill_angle.back() - piece.mill_angle.front();
    e.wall_speed = shape_.radius * (turned != 0 ? turned / (r.back().time - r.front().time) : mill_speed_);
  } else {
    e.spin_j = spin_of(piece.spin_j, false, e.spin_lag);
    e.spin_j_after = spin_of(piece.spin_j, true, e.spin_lag_after);
    const auto is_before = [&](std::size_t k) { return r[k].time < kink.time - 0.25 * spacing_; };
    const auto is_after = [&](std::size_t k) { return r[k].time > kink.time + 0.25 * spacing_; };
    const Path pair_came = path_of(piece.middle, kGravity, is_before),
               pair_went = path_of(piece.middle, kGravity, is_after);
    const double fell = kGravity * (pair_went.time - pair_came.time);
    e.stray = std::hypot(pair_went.vx - pair_came.vx, pair_went.vy - pair_came.vy + fell);
  }
  impacts_.push_back(e);
}

std::vector<FlightWindow> ContactEvents::flights() const {
  std::vector<double> scatter;
  for (const FlightWindow& w : flights_) scatter.push_back(w.scatter);
  const double usual = median(scatter);
  std::vector<FlightWindow> kept;
  for (const FlightWindow& w : flights_)
    if (is_straight(w.scatter, w.freedom, usual, w.radius)) kept.push_back(w);
  return kept;
}

// Rate at which spins fade in flight [1/s]; 0 where they are not seen.
double ContactEvents::spin_decay() const {
  double lost = 0, squares = 0;
  for (const FlightWindow& w : flights()) {
    if (!std::isfinite(w.spin)) continue;
    lost -= w.spin_information * w.spin * w.spin_slope;
    squares += w.spin_information * w.spin * w.spin;
  }
  return squares > 0 ? lost / squares : 0;
}

std::vector<SeenImpact> ContactEvents::impacts() const {
  const double fades = spin_decay();
  std::vector<double> scatter;
  for (const SeenImpact& e : impacts_) scatter.push_back(e.scatter);
  const double usual = median(scatter);
  // Where the wall is, the impacts know better than the camera's scale; a ball that turns back before was met by
  // another.
  std::vector<double> misses;
  for (const SeenImpact& e : impacts_)
    if (e.at_wall) misses.push_back(e.miss);
  const double wall = median(misses);
  std::vector<SeenImpact> kept;
  for (const SeenImpact& e : impacts_) {
    if (e.at_wall && std::abs(e.miss - wall) > kSlack * e.radius_i + 2 * usual) continue;
    const double noise = usual * std::sqrt(1 / e.all.spread + 1 / e.spread_after);
    const bool alone = e.at_wall || e.stray < kStray * noise + 0.02 * (e.all.closing + e.all.parting);
    if (alone && is_straight(e.scatter, e.freedom, usual, e.radius_i) && e.all.closing > 0) {
      kept.push_back(e);
      for (double* spin : {&kept.back().spin_i, &kept.back().spin_j}) *spin *= 1 - fades * e.spin_lag;
      for (double* spin : {&kept.back().spin_i_after, &kept.back().spin_j_after}) *spin *= 1 + fades * e.spin_lag_after;
    }
  }
  return kept;
}

}  // namespace tumble::diagnose
