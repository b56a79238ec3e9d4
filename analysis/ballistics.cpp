#include "analysis/ballistics.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/angle.h"
#include "core/quantile.h"
#include "core/random.h"

// Method. Each track is cut into the fewest stretches that are parabolas within the noise (optimal partition by dynamic
// programming: Jackson et al. 2005; pruning by the fit itself). This needs no scale of time, so that 24 and 1000
// frames/s are the same to it. What remains is a cloud of accelerations, one a stretch: flights gather in one point,
// carried and rolling balls are spread. The densest point within the allowed roll is the common acceleration; a robust
// mean with scatter between flights (random effects, Student's t weights) refines it.
namespace tumble::analysis {
namespace {

constexpr int kLeastSightings = 5;        // in a stretch: a parabola and two to judge it by
constexpr std::size_t kLeastFlights = 2;  // two that agree are no accident
constexpr double kLeastAgreement = 0.12;  // relative error of |a| beyond which nothing is said
constexpr double kLargestGap = 6;         // frames; a ball unseen for longer is another ball
constexpr double kLeastSupport = 12;      // log of the odds that so many candidates agree for no reason
constexpr double kHiddenContact = 0.7;  // common error by contacts that hide in the noise at both ends of a flight of n
                                        // sightings: this over sqrt(n) of its error by noise; from films of mills
constexpr double kShortFlight = 0.04;   // the same where the noise is above kPrecise, of |a|: hops within the charge
// Scatter of flights that is tried. Short ones at the far end of either have no common acceleration: they are balls
// that roll down the charge, seen at few frames a second.
constexpr std::array kNoiseFactors = {1.0, 1.3, 1.6, 2.0, 2.5, 3.0};
constexpr std::array kScatters = {0.0, 0.003, 0.01, 0.02, 0.04};
constexpr double kStretchCost = 20;       // of one more stretch, in chi square
constexpr double kSpike = 7;              // sigmas off its neighbours' cubic: a false sighting
constexpr double kLeastSignificance = 6;  // |a| over its error
constexpr double kPrecise = 0.02;         // error of a flight's acceleration by noise, of |a|: a long one
constexpr int kEnoughPrecise = 20;        // long flights that make the others unnecessary
constexpr double kSearchScatter = 0.05;   // of |a|: width of the search for the densest point
constexpr double kUpright_deg = 5;        // cameras stand upright to this; tells where flights are few
constexpr double kReadoutPrior = 0.5;     // standard deviation about 0 of a readout share that nobody gave
constexpr double kLeastNoise = 2e-5;      // of the largest distance from the axis
constexpr int kPasses = 3;                // the flights teach the noise and the readout
constexpr std::size_t kLeastForBootstrap = 8;
constexpr std::size_t kEnoughForScatter = 10;  // candidates whose scatter about the mean can be judged
constexpr int kReplicates = 200;               // of the bootstrap

struct Point {
  int track = 0;
  double frame = 0, row = kNotGiven;
  double t = 0;  // frame, and how much later within it the row was read
  double x = 0, y = 0;
  double sigma = 1, weight = 1;  // weight = 1 / sigma^2
};
using Track = std::vector<Point>;  // without large gaps

// Least squares of x and y on 1, t, t^2 / 2 about a first point, one sighting at a time.
class ParabolaSums {
 public:
  explicit ParabolaSums(const Point& origin) : t0_(origin.t), x0_(origin.x), y0_(origin.y) {}

  void add(const Point& p) {
    const double t = p.t - t0_, x = p.x - x0_, y = p.y - y0_, w = p.weight;
    const double q = 0.5 * t * t;
    s_[0] += w, s_[1] += w * t, s_[2] += w * q, s_[3] += w * t * t, s_[4] += w * t * q, s_[5] += w * q * q;
    bx_[0] += w * x, bx_[1] += w * x * t, bx_[2] += w * x * q;
    by_[0] += w * y, by_[1] += w * y * t, by_[2] += w * y * q;
    squares_ += w * (x * x + y * y);
    ++n_;
  }
  int count() const { return n_; }

  struct Fit {
    double ax = 0, ay = 0, variance = 0;  // variance of ax and of ay
    double chi2 = 0;
  };
  Fit fit() const {  // needs three different times
    // Cholesky of the 3 x 3 normal matrix.
    const double l00 = std::sqrt(s_[0]), l10 = s_[1] / l00, l20 = s_[2] / l00;
    const double l11 = std::sqrt(s_[3] - l10 * l10), l21 = (s_[4] - l20 * l10) / l11;
    const double l22 = std::sqrt(std::max(1e-300, s_[5] - l20 * l20 - l21 * l21));
    const auto forward = [&](const std::array<double, 3>& b) {
      std::array<double, 3> z;
      z[0] = b[0] / l00;
      z[1] = (b[1] - l10 * z[0]) / l11;
      z[2] = (b[2] - l20 * z[0] - l21 * z[1]) / l22;
      return z;
    };
    const auto zx = forward(bx_), zy = forward(by_);
    Fit f;
    f.ax = zx[2] / l22;
    f.ay = zy[2] / l22;
    f.variance = 1 / (l22 * l22);
    f.chi2 = squares_;
    for (int k = 0; k < 3; ++k) {
      const auto i = static_cast<std::size_t>(k);
      f.chi2 -= zx[i] * zx[i] + zy[i] * zy[i];
    }
    f.chi2 = std::max(0.0, f.chi2);
    return f;
  }

 private:
  double t0_, x0_, y0_;
  double s_[6] = {}, squares_ = 0;
  std::array<double, 3> bx_{}, by_{};
  int n_ = 0;
};

ParabolaSums::Fit parabola_of(std::span<const Point> points) {
  ParabolaSums sums(points.front());
  for (const Point& p : points) sums.add(p);
  return sums.fit();
}

// Chi square that a parabola through n points of two coordinates hardly ever exceeds.
double largest_chi2(int n) {
  const double freedom = 2.0 * (n - 3);
  return freedom + 4 * std::sqrt(2 * freedom) + 12;
}

struct Stretch {
  std::size_t from = 0, to = 0;  // of a track's points, [from, to)
};

// The cheapest cut into parabolas.
std::vector<Stretch> partition(const Track& track) {
  const std::size_t n = track.size();
  std::vector<double> cost(n + 1, std::numeric_limits<double>::infinity());
  std::vector<std::size_t> before(n + 1, 0);
  cost[0] = 0;
  for (std::size_t s = 0; s < n; ++s) {
    ParabolaSums sums(track[s]);
    for (std::size_t e = s; e < n; ++e) {
      sums.add(track[e]);
      const int count = sums.count();
      const double chi2 = count > 3 ? sums.fit().chi2 : 0.0;
      if (count > 3 && chi2 > largest_chi2(count)) break;
      const double total = cost[s] + chi2 + kStretchCost;
      if (total < cost[e + 1]) {
        cost[e + 1] = total;
        before[e + 1] = s;
      }
    }
  }
  std::vector<Stretch> stretches;
  for (std::size_t e = n; e > 0; e = before[e]) stretches.push_back({before[e], e});
  std::reverse(stretches.begin(), stretches.end());
  return stretches;
}

// Sightings of other things that a track ran into for a frame.
void drop_spikes(Track& track) {
  if (track.size() < 5) return;
  std::vector<double> off(track.size(), 0.0);
  for (std::size_t i = 2; i + 2 < track.size(); ++i) {
    double dx = track[i].x, dy = track[i].y, variance = track[i].sigma * track[i].sigma;
    for (const int k : {-2, -1, 1, 2}) {  // Lagrange's cubic through the neighbours, at their own times
      const Point& p = track[i + static_cast<std::size_t>(k)];
      double share = 1;
      for (const int m : {-2, -1, 1, 2}) {
        if (m == k) continue;
        const double tm = track[i + static_cast<std::size_t>(m)].t;
        share *= (track[i].t - tm) / (p.t - tm);
      }
      dx -= share * p.x;
      dy -= share * p.y;
      variance += share * share * p.sigma * p.sigma;
    }
    off[i] = std::sqrt((dx * dx + dy * dy) / variance);
  }
  Track kept;
  for (std::size_t i = 0; i < track.size(); ++i) {
    const bool peak =
        off[i] > kSpike && (i == 0 || off[i] >= off[i - 1]) && (i + 1 == track.size() || off[i] > off[i + 1]);
    if (!peak) kept.push_back(track[i]);
  }
  track = std::move(kept);
}

// Noise by third differences: parabolas have none. A share of 40 % of all is taken for quiet.
double noise_factor(const std::vector<Track>& tracks) {
  constexpr double kShare = 0.4;
  std::vector<double> squares;
  double extent = 0;
  for (const Track& k : tracks)
    for (std::size_t i = 0; i < k.size(); ++i) {
      extent = std::max(extent, std::hypot(k[i].x, k[i].y));
      if (i < 3 || k[i].frame - k[i - 1].frame != k[i - 1].frame - k[i - 2].frame ||
          k[i - 1].frame - k[i - 2].frame != k[i - 2].frame - k[i - 3].frame)
        continue;
      const double dx = k[i].x - k[i - 3].x - 3 * (k[i - 1].x - k[i - 2].x);
      const double dy = k[i].y - k[i - 3].y - 3 * (k[i - 1].y - k[i - 2].y);
      const double variance = k[i].sigma * k[i].sigma + k[i - 3].sigma * k[i - 3].sigma +
                              9 * (k[i - 1].sigma * k[i - 1].sigma + k[i - 2].sigma * k[i - 2].sigma);
      squares.push_back((dx * dx + dy * dy) / variance);
    }
  if (squares.empty()) return kNotGiven;
  return std::max(kLeastNoise * extent,
                  std::sqrt(quantile_of(std::move(squares), kShare) / (-2 * std::log(1 - kShare))));
}

// Turning about the axis at one speed says as much as the parabola does: a carried ball.
bool is_carried(std::span<const Point> points, double chi2_of_parabola) {
  double w = 0, wt = 0, wtt = 0, wr = 0, wa = 0, wat = 0;
  std::vector<double> radius, angle;
  for (const Point& p : points) {
    radius.push_back(std::hypot(p.x, p.y));
    double a = std::atan2(p.y, p.x);
    if (!angle.empty()) a += 2 * kPi * std::round((angle.back() - a) / (2 * kPi));
    angle.push_back(a);
    const double t = p.t - points.front().t;
    w += p.weight, wt += p.weight * t, wtt += p.weight * t * t;
    wr += p.weight * radius.back(), wa += p.weight * a, wat += p.weight * a * t;
  }
  const double mean_radius = wr / w, speed = (w * wat - wt * wa) / (w * wtt - wt * wt);
  const double start = (wa - speed * wt) / w;
  double chi2 = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double along = mean_radius * (angle[i] - start - speed * (points[i].t - points.front().t));
    const double across = radius[i] - mean_radius;
    chi2 += points[i].weight * (along * along + across * across);
  }
  return chi2 - chi2_of_parabola < 3 * std::log(2.0 * static_cast<double>(points.size())) + 9;
}

// One stretch at constant acceleration.
struct Candidate {
  std::size_t track = 0;
  Stretch stretch;
  double ax = 0, ay = 0, sigma = 0, chi2 = 0;
  double ax_by_readout = 0, ay_by_readout = 0;  // change of the fitted ax, ay with the readout share
};

Candidate candidate_of(const std::vector<Track>& tracks, std::size_t k, Stretch s) {
  const auto points = std::span(tracks[k]).subspan(s.from, s.to - s.from);
  const auto fit = parabola_of(points);
  return {k, s, fit.ax, fit.ay, std::sqrt(fit.variance), fit.chi2};
}

// What a later time of lower rows does to the fitted acceleration. By the fall with the common acceleration, for the
// candidate's own would share its noise with what is to be explained by it.
void set_readout_slope(const std::vector<Track>& tracks, Candidate& c, double ax, double ay) {
  const auto points = std::span(tracks[c.track]).subspan(c.stretch.from, c.stretch.to - c.stretch.from);
  double w = 0, t = 0, x = 0, y = 0, tt = 0, xt = 0, yt = 0, qt = 0;
  for (const Point& p : points) {
    if (std::isnan(p.row)) return;
    w += p.weight, t += p.weight * p.t, x += p.weight * p.x, y += p.weight * p.y;
  }
  t /= w, x /= w, y /= w;
  for (const Point& p : points) {
    const double d = p.t - t;
    tt += p.weight * d * d, xt += p.weight * d * (p.x - x), yt += p.weight * d * (p.y - y);
    qt += p.weight * 0.5 * d * d * d;
  }
  const double vx = (xt - ax * qt) / tt, vy = (yt - ay * qt) / tt;  // at the mean time
  Track shifted(points.begin(), points.end());
  for (Point& p : shifted) {
    const double late = p.row, d = p.t - t;
    p.x = late * (vx + ax * d);
    p.y = late * (vy + ay * d);
  }
  const auto slope = parabola_of(shifted);
  c.ax_by_readout = -slope.ax;
  c.ay_by_readout = -slope.ay;
}

std::vector<Candidate> candidates_of(const std::vector<Track>& tracks, double most_roll_deg) {
  constexpr double kMargin_deg = 15;  // for the noise of a single one
  std::vector<Candidate> list;
  for (std::size_t k = 0; k < tracks.size(); ++k)
    for (const Stretch& s : partition(tracks[k])) {
      if (s.to - s.from < kLeastSightings) continue;
      const Candidate c = candidate_of(tracks, k, s);
      if (std::hypot(c.ax, c.ay) < kLeastSignificance * c.sigma) continue;
      if (std::abs(degrees(std::atan2(c.ax, -c.ay))) > most_roll_deg + kMargin_deg) continue;
      if (is_carried(std::span(tracks[k]).subspan(s.from, s.to - s.from), c.chi2)) continue;
      list.push_back(c);
    }
  return list;
}

struct Gravity {  // the common acceleration, and how far the candidates scatter about it
  double ax = 0, ay = 0;
  double readout = 0;                         // correction of the readout share in use
  double noise_factor = 1.5, scatter = 0.01;  // variance about it: (noise_factor sigma)^2 + (scatter |a|)^2
  double prior_readout = 0;                   // where `readout` is expected; its error is kReadoutPrior

  double square() const { return ax * ax + ay * ay; }
  double variance(const Candidate& c) const {
    return noise_factor * noise_factor * c.sigma * c.sigma + scatter * scatter * square();
  }
  double distance2(const Candidate& c) const {
    const double dx = c.ax + readout * c.ax_by_readout - ax, dy = c.ay + readout * c.ay_by_readout - ay;
    return dx * dx + dy * dy;
  }
  // Density of a flight at the candidate over that of anything else, which is taken as even over the directions
  // allowed and over nine e-foldings of |a|.
  double odds(const Candidate& c) const {
    constexpr double kSpread = 10;
    const double v = variance(c);
    return kSpread * square() / (2 * kPi * v) * std::exp(-0.5 * distance2(c) / v);
  }
};

double log_likelihood(const std::vector<Candidate>& list, const Gravity& g) {
  double sum = 0;
  for (const Candidate& c : list) sum += std::log1p(g.odds(c));
  return sum;
}

// Mean of (ax, ay, readout), each candidate weighted by what it says and by how likely it is a flight.
struct Solution {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

Solution weighted_mean(const std::vector<const Candidate*>& list, const Gravity& g, bool with_readout) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  for (const Candidate* c : list) {
    const double odds = g.odds(*c), w = odds / (1 + odds) / g.variance(*c);
    const double jx = -c->ax_by_readout, jy = -c->ay_by_readout;
    m(0, 0) += w, m(1, 1) += w;
    m(0, 2) += w * jx, m(1, 2) += w * jy, m(2, 2) += w * (jx * jx + jy * jy);
    b(0) += w * c->ax, b(1) += w * c->ay, b(2) += w * (c->ax * jx + c->ay * jy);
  }
  const double upright = radians(kUpright_deg);
  m(0, 0) += 1 / (upright * upright * g.square());
  const double prior = with_readout ? kReadoutPrior : 1e-6;
  m(2, 2) += 1 / (prior * prior);
  b(2) += g.prior_readout / (prior * prior);
  m(2, 0) = m(0, 2), m(2, 1) = m(1, 2);
  Solution s;
  s.covariance = m.inverse();
  s.value = s.covariance * b;
  return s;
}

Gravity settle(const std::vector<const Candidate*>& list, Gravity g, bool with_readout, int rounds) {
  for (int i = 0; i < rounds; ++i) {
    const Solution s = weighted_mean(list, g, with_readout);
    g.ax = s.value(0), g.ay = s.value(1), g.readout = s.value(2);
  }
  return g;
}

// The densest point of the candidates' accelerations within the roll allowed, then the likeliest scatter about it.
Gravity find_gravity(const std::vector<Track>& tracks, std::vector<Candidate>& list, const FallOptions& options,
                     bool with_readout, double prior_readout) {
  std::vector<const Candidate*> all;
  for (const Candidate& c : list) all.push_back(&c);
  Gravity best;
  double most = -1;
  for (const Candidate& c : list) {
    if (std::abs(degrees(std::atan2(c.ax, -c.ay))) > options.most_roll_deg) continue;
    Gravity g;
    g.ax = c.ax, g.ay = c.ay, g.scatter = kSearchScatter;
    double support = log_likelihood(list, g);
    // Cameras stand upright to a few degrees: it decides where there are few flights.
    support -= 0.5 * std::pow(std::atan2(c.ax, -c.ay) / radians(kUpright_deg), 2);
    if (support > most) most = support, best = g;
  }
  if (most < kLeastSupport) return {};
  best.prior_readout = prior_readout;
  best = settle(all, best, false, 10);
  best.scatter = Gravity().scatter;
  best = settle(all, best, false, 10);
  if (with_readout)
    for (Candidate& c : list) set_readout_slope(tracks, c, best.ax, best.ay);
  if (list.size() < kEnoughForScatter) return settle(all, best, with_readout, 10);
  Gravity likeliest = best;
  double likelihood = -1;
  for (const double factor : kNoiseFactors)
    for (const double scatter : kScatters) {
      Gravity g = best;
      g.noise_factor = factor, g.scatter = scatter;
      g = settle(all, g, with_readout, 10);
      const double l = log_likelihood(list, g);
      if (l > likelihood) likelihood = l, likeliest = g;
    }
  return likeliest;
}

bool is_flight(const Candidate& c, const Gravity& g) { return g.odds(c) > 1; }

// Stretches of one flight that a false sighting or a hair's excess of noise has parted; then the ends are cut, where a
// contact may hide in the noise.
std::vector<Candidate> join_and_trim(const std::vector<Track>& tracks, const std::vector<Candidate>& list,
                                     const Gravity& g) {
  std::vector<Candidate> joined;
  for (const Candidate& c : list) {
    if (!joined.empty() && joined.back().track == c.track && is_flight(c, g) && is_flight(joined.back(), g) &&
        c.stretch.from - joined.back().stretch.to <= 1) {
      const Candidate both = candidate_of(tracks, c.track, {joined.back().stretch.from, c.stretch.to});
      if (both.chi2 < largest_chi2(static_cast<int>(both.stretch.to - both.stretch.from))) {
        joined.back() = both;
        continue;
      }
    }
    joined.push_back(c);
  }
  for (Candidate& c : joined) {
    const std::size_t n = c.stretch.to - c.stretch.from;
    const double noise = std::sqrt(1 / tracks[c.track][c.stretch.from].weight);
    const auto hidden = static_cast<std::size_t>(std::lround(std::sqrt(4 * noise / std::sqrt(g.square()))));
    const std::size_t cut = std::min(hidden, n / 10);
    c = candidate_of(tracks, c.track, {c.stretch.from + cut, c.stretch.to - cut});
  }
  return joined;
}

std::vector<Track> tracks_of(std::span<const TimedPlace> places, double readout) {
  std::vector<TimedPlace> sorted(places.begin(), places.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const TimedPlace& a, const TimedPlace& b) {
    return a.track != b.track ? a.track < b.track : a.frame < b.frame;
  });
  std::vector<Track> tracks;
  const TimedPlace* last = nullptr;
  for (const TimedPlace& p : sorted) {
    if (last != nullptr && last->track == p.track && p.frame == last->frame) continue;
    if (last == nullptr || last->track != p.track || p.frame - last->frame > kLargestGap) tracks.emplace_back();
    last = &p;
    Point q;
    q.frame = p.frame, q.x = p.x, q.y = p.y, q.row = p.row_share;
    q.t = p.frame + (std::isnan(p.row_share) ? 0.0 : readout * p.row_share);
    q.sigma = std::isnan(p.sigma) ? 1.0 : p.sigma;
    q.track = p.track;
    tracks.back().push_back(q);
  }
  return tracks;
}

void set_noise(std::vector<Track>& tracks, double factor) {
  for (Track& k : tracks)
    for (Point& p : k) {
      p.sigma *= factor;
      p.weight = 1 / (p.sigma * p.sigma);
    }
}

// What the flights themselves say of the noise, relative to what was assumed.
double noise_of_flights(const std::vector<Candidate>& list, const Gravity& g) {
  double chi2 = 0, freedom = 0;
  for (const Candidate& c : list) {
    if (!is_flight(c, g)) continue;
    chi2 += c.chi2;
    freedom += 2.0 * (static_cast<double>(c.stretch.to - c.stretch.from) - 3);
  }
  return freedom > 0 ? std::sqrt(chi2 / freedom) : 1.0;
}

// The long flights alone, where there are enough of them: in short ones, contacts that hide in the noise at both ends
// take one to three per cent of |a|, and the less the faster the balls are: a rolling shutter would be seen.
bool keep_precise(std::vector<Candidate>& list, const Gravity& g) {
  const auto is_precise = [&](const Candidate& c) { return c.sigma < kPrecise * std::sqrt(g.square()); };
  const auto count =
      std::count_if(list.begin(), list.end(), [&](const Candidate& c) { return is_precise(c) && is_flight(c, g); });
  if (count < kEnoughPrecise) return false;
  std::erase_if(list, [&](const Candidate& c) { return !is_precise(c); });
  return true;
}

}  // namespace

FreeFall find_free_fall(std::span<const TimedPlace> places, const FallOptions& options) {
  FreeFall fall;
  const bool rows = std::any_of(places.begin(), places.end(), [](const auto& p) { return !std::isnan(p.row_share); });
  const bool readout_unknown = rows && std::isnan(options.readout_share);
  double readout = rows && !readout_unknown ? options.readout_share : 0.0;

  double noise = kNotGiven;
  std::vector<Candidate> list;
  std::vector<Track> tracks;
  Gravity gravity;
  bool with_readout = false, precise = false;
  for (int pass = 1; pass <= kPasses; ++pass) {
    tracks = tracks_of(places, readout);
    if (std::isnan(noise)) noise = noise_factor(tracks);
    if (std::isnan(noise)) return fall;
    set_noise(tracks, noise);
    for (Track& k : tracks) drop_spikes(k);
    list = candidates_of(tracks, options.most_roll_deg);
    if (list.size() < kLeastFlights) return fall;
    gravity = find_gravity(tracks, list, options, false, 0);
    if (!(gravity.square() > 0)) return fall;
    const double relative_noise = noise_of_flights(list, gravity);
    list = join_and_trim(tracks, list, gravity);
    precise = keep_precise(list, gravity);
    with_readout = precise && readout_unknown;
    gravity = find_gravity(tracks, list, options, with_readout, -readout);
    if (pass == kPasses || (!with_readout && std::abs(relative_noise - 1) < 0.03)) break;
    if (with_readout) readout += gravity.readout;
    noise *= std::clamp(relative_noise, 0.5, 2.0);
  }

  std::vector<const Candidate*> all;
  std::size_t count = 0;
  double hidden = 0, weights = 0;
  for (const Candidate& c : list) {
    if (gravity.odds(c) < 1e-3) continue;
    all.push_back(&c);
    if (!is_flight(c, gravity)) continue;
    ++count;
    const double w = 1 / gravity.variance(c);
    const double size = std::sqrt(gravity.square());
    hidden += w * kHiddenContact * c.sigma / std::sqrt(static_cast<double>(c.stretch.to - c.stretch.from));
    if (c.sigma > kPrecise * size) hidden += w * kShortFlight * size;
    weights += w;
  }
  if (count < kLeastFlights) return fall;
  if (!precise && (gravity.noise_factor >= kNoiseFactors.back() || gravity.scatter >= kScatters.back())) return fall;
  hidden /= weights;
  const Solution mean = weighted_mean(all, gravity, with_readout);
  const double a = std::sqrt(gravity.square());
  const Eigen::Vector2d along(gravity.ax / a, gravity.ay / a), across(-gravity.ay / a, gravity.ax / a);
  const Eigen::Matrix2d formal = mean.covariance.topLeftCorner<2, 2>();
  double magnitude_se = std::sqrt(along.dot(formal * along)), across_se = std::sqrt(across.dot(formal * across));
  if (count >= kLeastForBootstrap) {
    // Over flights: what the weights do not know of, such as contacts that hide in the noise.
    Random random(3);
    double s = 0, ss = 0, c = 0, cc = 0;
    for (int r = 0; r < kReplicates; ++r) {
      std::vector<const Candidate*> sample;
      for (std::size_t i = 0; i < all.size(); ++i) sample.push_back(all[random.below(all.size())]);
      const Gravity g = settle(sample, gravity, with_readout, 5);
      const Eigen::Vector2d off(g.ax - gravity.ax, g.ay - gravity.ay);
      s += along.dot(off), ss += along.dot(off) * along.dot(off);
      c += across.dot(off), cc += across.dot(off) * across.dot(off);
    }
    magnitude_se = std::max(magnitude_se, std::sqrt(std::max(0.0, ss - s * s / kReplicates) / (kReplicates - 1)));
    across_se = std::max(across_se, std::sqrt(std::max(0.0, cc - c * c / kReplicates) / (kReplicates - 1)));
  }
  magnitude_se = std::hypot(magnitude_se, hidden);
  across_se = std::hypot(across_se, hidden);
  if (magnitude_se > kLeastAgreement * a) return fall;

  fall.ax = gravity.ax;
  fall.ay = gravity.ay;
  fall.magnitude = {a, magnitude_se};
  fall.roll_deg = {degrees(std::atan2(gravity.ax, -gravity.ay)), degrees(across_se / a)};
  if (rows)
    fall.readout_share = with_readout ? Estimate{readout + gravity.readout, std::sqrt(mean.covariance(2, 2))}
                                      : Estimate{options.readout_share, readout_unknown ? kNotGiven : 0.0};
  fall.noise = noise;
  for (const Candidate* c : all) {
    if (!is_flight(*c, gravity)) continue;
    const Point &first = tracks[c->track][c->stretch.from], &last = tracks[c->track][c->stretch.to - 1];
    fall.flights.push_back({first.track, first.frame, last.frame, static_cast<int>(c->stretch.to - c->stretch.from),
                            c->ax, c->ay, c->sigma});
  }
  return fall;
}

Estimate frames_per_second(const FreeFall& fall, double gravity) {
  const double rate = std::sqrt(gravity / fall.magnitude.value);
  return {rate, 0.5 * rate * fall.magnitude.se / fall.magnitude.value};
}

}  // namespace tumble::analysis
