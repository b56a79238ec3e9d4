#include "analysis/lifters.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace tumble::analysis {
namespace {

struct Place {
  double rho = 0, angle = 0;
};

Place place_of(const Detection& d, const MillView& view) {
  const cv::Point2d p = about_axis(d, view);
  return {std::hypot(p.x, p.y), std::atan2(p.y, p.x)};
}

}  // namespace

LifterLattice find_lifters(const std::vector<std::vector<Detection>>& balls, const std::vector<double>& drum_angle,
                           const MillView& view, int count, double guess) {
  LifterLattice lattice{count, guess};
  if (count < 1 || std::isnan(guess) || drum_angle.size() != balls.size()) return lattice;
  const double spacing = 2 * kPi / count;
  struct Folded {
    double angle, half_gap;  // from the guess, in (-spacing / 2, spacing / 2]; the ball's radius as an angle
  };
  std::vector<Folded> folded;
  for (std::size_t f = 0; f < balls.size(); ++f)
    for (const Detection& d : balls[f]) {
      const double r = view.radii[static_cast<std::size_t>(d.size_class)];
      const Place p = place_of(d, view);
      if (p.rho < view.tip_radius - 0.2 * r || p.rho > view.mill.radius) continue;
      folded.push_back({std::remainder(p.angle - drum_angle[f] - guess, spacing), r / p.rho});
    }
  if (folded.size() < 100) return lattice;
  const double step = spacing / 160;
  std::vector<int> intruders;  // balls in the flanks of a lifter supposed at each angle
  for (int k = -48; k <= 48; ++k) {
    int n = 0;
    for (const Folded& b : folded) {
      const double aside = std::abs(std::remainder(b.angle - k * step, spacing)) / b.half_gap;
      n += aside > 0.4 && aside < 0.9;
    }
    intruders.push_back(n);
  }
  const int least = *std::min_element(intruders.begin(), intruders.end());
  const int allowed = least + static_cast<int>(0.01 * static_cast<double>(folded.size())) + 1;
  if (least > static_cast<int>(0.05 * static_cast<double>(folded.size()))) return lattice;
  int best_from = 0, best_length = 0;  // the longest run of nearly empty gaps: its middle is the lifter's
  for (int i = 0, from = 0; i <= static_cast<int>(intruders.size()); ++i) {
    if (i < static_cast<int>(intruders.size()) && intruders[static_cast<std::size_t>(i)] <= allowed) continue;
    if (i - from > best_length) {
      best_length = i - from;
      best_from = from;
    }
    from = i + 1;
  }
  lattice.angle = guess + (best_from + 0.5 * (best_length - 1) - 48) * step;
  return lattice;
}

bool within_lifter(const Detection& d, const MillView& view, const LifterLattice& lifters, double drum_angle) {
  if (lifters.count < 1 || std::isnan(lifters.angle) || !(view.tip_radius < view.mill.radius)) return false;
  const double r = view.radii[static_cast<std::size_t>(d.size_class)];
  const Place p = place_of(d, view);
  if (p.rho < view.tip_radius - 0.5 * r) return false;
  return std::abs(std::remainder(p.angle - lifters.angle - drum_angle, 2 * kPi / lifters.count)) * p.rho < 0.7 * r;
}

}  // namespace tumble::analysis
