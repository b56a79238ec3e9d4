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
  constexpr int kPlaces = 160;  // supposed for a lifter, across one spacing
  const double step = spacing / kPlaces;
  std::vector<int> intruders;  // balls in the flanks of a lifter supposed at each place
  for (int k = 0; k < kPlaces; ++k) {
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
  // Runs of nearly empty gaps. A lifter that was taken for a ball sits alone in the middle of one, else the run is
  // long; so may be a run beside balls that are locked between the lifters, but further from the guess.
  double best = 0;
  const auto open = [&](int k) { return intruders[static_cast<std::size_t>((k + 2 * kPlaces) % kPlaces)] <= allowed; };
  for (int k = -kPlaces / 2; k < kPlaces / 2; ++k) {
    if (!open(k) || open(k - 1)) continue;
    int end = k;
    while (end < k + kPlaces && open(end)) ++end;
    const double middle = std::remainder((k + 0.5 * (end - 1 - k)) * step, spacing);
    double alone = 0;
    for (const Folded& b : folded) alone += std::abs(std::remainder(b.angle - middle, spacing)) < 0.4 * b.half_gap;
    const double off = middle / (0.12 * spacing);
    const double worth = std::exp(-off * off) *
                         (alone / static_cast<double>(folded.size()) + 0.5 * static_cast<double>(end - k) / kPlaces);
    if (worth <= best) continue;
    best = worth;
    lattice.angle = guess + middle;
  }
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
