#include "analysis/ball_plane.h"

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/quantile.h"

namespace tumble::analysis {
namespace {

constexpr double kLeastReach = 0.90, kMostReach = 1.05;  // what a camera's first scale may be off by
// What the two can be wrong by beyond their scatter: balls overlap a little, shells are not quite round.
constexpr double kTouchingError = 0.003, kReachError = 0.002;

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

Estimate shell_by_balls(const BallPlane& plane) {
  const double touching = std::hypot(plane.touching.se, kTouchingError),
               reach = std::hypot(plane.reach.se, kReachError);
  return {plane.reach.value / plane.touching.value, std::hypot(touching, reach)};
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
  add(plane.touching, kTouchingError);
  add(plane.reach, kReachError);
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
