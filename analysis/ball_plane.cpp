#include "analysis/ball_plane.h"

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/quantile.h"

namespace tumble::analysis {
namespace {

constexpr int kBins = 120;
constexpr double kLeastReach = 0.90, kMostReach = 1.05;  // what a camera's first scale may be off by

double normal_above(double x) { return 0.5 * std::erfc(x / std::sqrt(2.0)); }

// Density of (an exponential with mean `length`, above zero) + (a normal with deviation `sigma`).
double blurred_tail(double x, double sigma, double length) {
  const double a = sigma / length, exponent = 0.5 * a * a - x / length;
  return exponent > 60 ? 0.0 : std::exp(exponent) / length * normal_above(a - x / sigma);
}

double normal(double x, double sigma) {
  return std::exp(-0.5 * x * x / (sigma * sigma)) / (sigma * 2.5066282746310002);
}

struct Crowd {
  double edge = 0, sigma = 1, length = 1, at_edge = 0.5, ground = 0.1;
};

class Histogram {
 public:
  Histogram(const std::vector<double>& values, double from, double to, int tail)
      : from_(from), width_((to - from) / kBins), tail_(tail), counts_(kBins, 0.0) {
    for (double v : values)
      if (v > from && v < to) {
        counts_[std::min<std::size_t>(kBins - 1, static_cast<std::size_t>((v - from) / width_))] += 1;
        total_ += 1;
      }
  }
  double total() const { return total_; }

  double log_likelihood(const Crowd& c) const {
    double sum = 0, density = 0;
    std::array<double, kBins> p{};
    for (std::size_t i = 0; i < kBins; ++i) {
      const double x = tail_ * (from_ + (static_cast<double>(i) + 0.5) * width_ - c.edge);
      const double crowd = c.at_edge * normal(x, c.sigma) + (1 - c.at_edge) * blurred_tail(x, c.sigma, c.length);
      p[i] = (1 - c.ground) * crowd * width_ + c.ground / kBins;
      density += p[i];
    }
    for (std::size_t i = 0; i < kBins; ++i)
      if (counts_[i] > 0) sum += counts_[i] * std::log(std::max(1e-12, p[i] / density));
    return sum;
  }

 private:
  double from_, width_;
  int tail_;
  std::vector<double> counts_;
  double total_ = 0;
};

// One number after the other, each by halving steps, round and round: five numbers on a smooth hill.
Crowd climb(const Histogram& histogram, Crowd c, double span) {
  double best = histogram.log_likelihood(c);
  double step = 0.1;
  for (int round = 0; round < 200 && step > 1e-4; ++round) {
    bool better = false;
    for (int k = 0; k < 5; ++k)
      for (const double sign : {1.0, -1.0}) {
        Crowd t = c;
        if (k == 0) t.edge += sign * step * span;
        if (k == 1) t.sigma *= std::exp(sign * 4 * step);
        if (k == 2) t.length *= std::exp(sign * 4 * step);
        if (k == 3) t.at_edge = std::clamp(t.at_edge + sign * step, 0.02, 0.98);
        if (k == 4) t.ground = std::clamp(t.ground + sign * step, 0.001, 0.9);
        t.sigma = std::clamp(t.sigma, 0.002 * span, 0.3 * span);
        t.length = std::clamp(t.length, 0.005 * span, 2 * span);
        const double value = histogram.log_likelihood(t);
        if (value <= best) continue;
        best = value;
        c = t;
        better = true;
        break;
      }
    if (!better) step *= 0.5;
  }
  return c;
}

}  // namespace

Estimate sharp_edge(const std::vector<double>& values, double from, double to, int tail) {
  const Histogram histogram(values, from, to, tail);
  if (histogram.total() < 100) return {};
  const double span = to - from;
  Crowd best;
  double most = -1e300;
  for (const double at : {0.3, 0.5, 0.7}) {
    const Crowd c = climb(histogram, {from + at * span, 0.05 * span, 0.1 * span, 0.5, 0.1}, span);
    const double value = histogram.log_likelihood(c);
    if (value <= most) continue;
    most = value;
    best = c;
  }
  if (best.edge < from + 0.03 * span || best.edge > to - 0.03 * span || best.ground > 0.85) return {};
  // Sightings of one ball in neighbouring frames say the same: taken as one in ten that is new.
  const double fresh = std::max(10.0, 0.1 * histogram.total() * (1 - best.ground));
  return {best.edge, best.sigma / std::sqrt(fresh)};
}

namespace {

struct Reach {
  double share = 0;  // of the distance at which a ball lies against the shell
  double angle = 0;  // [rad]
};

// Where balls stop in each direction: the size of the circle, and how even it is.
void find_circle(const std::vector<Reach>& reaches, BallPlane& plane) {
  constexpr int kSectors = 12;
  constexpr double kUneven = 0.0015;  // of a true circle [its radius]
  std::vector<std::vector<double>> sectors(kSectors);
  std::vector<double> all;
  for (const Reach& r : reaches) {
    sectors[static_cast<std::size_t>(wrap_360(degrees(r.angle)) / 360 * kSectors) % kSectors].push_back(r.share);
    all.push_back(r.share);
  }
  plane.reach = sharp_edge(all, kLeastReach, kMostReach, -1);
  std::vector<double> edges;
  for (const auto& sector : sectors) {
    const Estimate edge = sharp_edge(sector, kLeastReach, kMostReach, -1);
    if (!std::isnan(edge.value)) edges.push_back(edge.value);
  }
  if (edges.empty()) return;
  // Where balls leave the shell few reach it: such directions have little say.
  plane.uneven = 1e9;
  for (double at = kLeastReach; at < kMostReach; at += 0.0005) {
    double sum = 0;
    for (double edge : edges) sum += std::log1p(std::pow((edge - at) / kUneven, 2));
    plane.uneven = std::min(plane.uneven, sum);
  }
}

}  // namespace

BallPlane measure_ball_plane(const std::vector<SeenFrame>& frames, double mill_radius, const Estimate& prior) {
  std::vector<double> gaps;
  std::vector<Reach> reaches;
  std::vector<double> sides;

  for (const SeenFrame& f : frames)
    for (std::size_t i = 0; i < f.balls.size(); ++i) {
      const Sighting& a = f.balls[i];
      if (a.visible < 0.85 || a.score < 0.5) continue;
      reaches.push_back({std::hypot(a.x, a.y) / (mill_radius - a.radius), std::atan2(a.y, a.x)});
      sides.push_back((std::hypot(a.x, a.y) + a.radius) / mill_radius);
      for (std::size_t j = i + 1; j < f.balls.size(); ++j) {
        const Sighting& b = f.balls[j];
        if (b.visible < 0.85 || b.score < 0.5) continue;
        const double sum = a.radius + b.radius, dx = a.x - b.x, dy = a.y - b.y;
        if (std::abs(dx) < 1.3 * sum && std::abs(dy) < 1.3 * sum) gaps.push_back(std::hypot(dx, dy) / sum);
      }
    }
  BallPlane plane;
  plane.touching = sharp_edge(gaps, 0.85, 1.2, +1);
  find_circle(reaches, plane);
  plane.outermost = quantile_of(std::move(sides), 0.99);
  plane.factor = lengths_factor(plane, prior);
  return plane;
}

Estimate lengths_factor(const BallPlane& plane, const Estimate& prior) {
  double weight = 0, sum = 0, squares = 0, witnesses = 0;
  const auto add = [&](const Estimate& e, double floor) {
    if (std::isnan(e.value)) return;
    const double w = 1 / (e.se * e.se + floor * floor);
    weight += w;
    sum += w * e.value;
    squares += w * e.value * e.value;
    witnesses += 1;
  };
  // What the two can be wrong by beyond their scatter: balls overlap a little, shells are not quite round.
  add({plane.touching.value, plane.touching.se}, 0.003);
  add({plane.reach.value, plane.reach.se}, 0.002);
  if (!std::isnan(prior.value)) add({1 / prior.value, prior.se}, 0.0);
  if (!(weight > 0)) return {};
  // Witnesses that contradict each other know less than they say (Birge 1932).
  const double chi2 = witnesses > 1 ? (squares - sum * sum / weight) / (witnesses - 1) : 1.0;
  return {weight / sum, std::sqrt(std::max(1.0, chi2) / weight)};
}

DepthDoubt depth_doubt(bool one_layer, double length, double radius, double distance, double focal_error) {
  // Balls lie anywhere between both ends of a shallow mill; in deep ones those that nothing hides, within the first
  // layer.
  const double slack = !one_layer ? 2 * radius : length > 2 * radius ? length - 2 * radius : 0.0;
  const double behind = 0.5 * slack / distance;
  DepthDoubt doubt;
  doubt.place_error = behind * std::hypot(2 / std::sqrt(3.0), focal_error);  // of 0 to twice that, all alike
  doubt.glass_error = (behind + radius / distance) * focal_error;
  return doubt;
}

void drop_beyond(SeenFrame& frame, double mill_radius) {
  constexpr double kSlack = 0.2;  // of the radius
  std::erase_if(frame.balls, [&](const Sighting& b) {
    return std::hypot(b.x, b.y) + b.radius > mill_radius + kSlack * b.radius + 2 * b.deviation;
  });
}

bool in_one_layer(const std::vector<SeenFrame>& frames) {
  constexpr double kFewest = 200, kMostCovering = 0.02;
  double touching = 0, covering = 0;
  for (const SeenFrame& f : frames)
    for (std::size_t i = 0; i < f.balls.size(); ++i)
      for (std::size_t j = i + 1; j < f.balls.size(); ++j) {
        const Sighting &a = f.balls[i], &b = f.balls[j];
        if (std::min(a.score, b.score) < 0.7) continue;
        const double gap = std::hypot(a.x - b.x, a.y - b.y) / (a.radius + b.radius);
        touching += gap > 0.9 && gap < 1.1;
        covering += gap > 0.3 && gap < 0.85;  // nearer ones are one ball seen twice
      }
  return touching > kFewest && covering < kMostCovering * touching;
}

void drop_impossible(SeenFrame& frame, double length) {
  constexpr double kSlack = 0.8;  // of the distance: centres are not exact, and balls are seen in perspective
  if (std::isnan(length)) return;
  std::stable_sort(frame.balls.begin(), frame.balls.end(),
                   [](const Sighting& a, const Sighting& b) { return a.score > b.score; });
  std::vector<Sighting> kept;
  for (const Sighting& b : frame.balls) {
    const bool possible = std::none_of(kept.begin(), kept.end(), [&](const Sighting& k) {
      const double sum = b.radius + k.radius, behind = std::max(0.0, length - sum);
      if (behind >= sum) return false;
      return std::hypot(b.x - k.x, b.y - k.y) < kSlack * std::sqrt(sum * sum - behind * behind);
    });
    if (possible) kept.push_back(b);
  }
  frame.balls = std::move(kept);
}

}  // namespace tumble::analysis
