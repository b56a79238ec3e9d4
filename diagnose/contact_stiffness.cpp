#include "diagnose/contact_stiffness.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/units.h"
#include "diagnose/student.h"

namespace tumble::diagnose {
namespace {

double energy_of(const LoadCellDrop& d) { return d.ball_mass * kGravity * (d.fall_height + d.max_displacement); }

// Mean of independent values with the standard error of their scatter; NaN for a single one.
template <typename Rows, typename Of>
Estimate mean_of(const Rows& rows, Of of) {
  double sum = 0, squares = 0;
  for (const auto& row : rows) sum += of(row);
  const double n = static_cast<double>(rows.size()), mean = sum / n;
  for (const auto& row : rows) squares += (of(row) - mean) * (of(row) - mean);
  return {mean, n > 1 ? std::sqrt(squares / (n - 1) / n) : kNotGiven};
}

// Balls of nearly one mass: their fall heights alone make the difference.
std::vector<std::vector<LoadCellDrop>> by_mass(std::vector<LoadCellDrop> drops) {
  std::stable_sort(drops.begin(), drops.end(), [](const auto& a, const auto& b) { return a.ball_mass < b.ball_mass; });
  std::vector<std::vector<LoadCellDrop>> classes;
  for (const LoadCellDrop& drop : drops) {
    if (classes.empty() || drop.ball_mass > 1.02 * classes.back().front().ball_mass) classes.emplace_back();
    classes.back().push_back(drop);
  }
  return classes;
}

// n as the quotient of the slopes of ln F and ln d against ln E, within each class of mass: a heavier ball is a larger
// one and touches differently.
void find_exponent_by_height(StiffnessGroup& group) {
  struct Point {
    double z, x, y;  // ln E, ln d, ln F, each about its class's mean
  };
  std::vector<Point> points;
  int classes = 0;
  std::size_t heights = 0;
  for (const auto& drops : by_mass(group.drops)) {
    const auto [low, high] = std::minmax_element(
        drops.begin(), drops.end(), [](const auto& a, const auto& b) { return a.fall_height < b.fall_height; });
    if (high->fall_height < 1.05 * low->fall_height) continue;
    std::vector<double> seen;
    for (const LoadCellDrop& d : drops) seen.push_back(d.fall_height);
    std::sort(seen.begin(), seen.end());
    heights = std::max(heights, static_cast<std::size_t>(std::unique(seen.begin(), seen.end()) - seen.begin()));
    ++classes;
    const double z = mean_of(drops, [](const auto& d) { return std::log(energy_of(d)); }).value;
    const double x = mean_of(drops, [](const auto& d) { return std::log(d.max_displacement); }).value;
    const double y = mean_of(drops, [](const auto& d) { return std::log(d.max_force); }).value;
    for (const LoadCellDrop& d : drops)
      points.push_back({std::log(energy_of(d)) - z, std::log(d.max_displacement) - x, std::log(d.max_force) - y});
  }
  const int freedom = static_cast<int>(points.size()) - classes - 1;
  if (heights < 3 || freedom < 1) return;
  double zx = 0, zy = 0, zz = 0, rest = 0;
  for (const Point& p : points) {
    zx += p.z * p.x;
    zy += p.z * p.y;
    zz += p.z * p.z;
  }
  if (!(zx > 0)) return;
  const double n = zy / zx;
  for (const Point& p : points) rest += (p.y - n * p.x) * (p.y - n * p.x);
  group.exponent_by_height = {n, std::sqrt(rest / freedom * zz) / zx};
  group.freedom_by_height = freedom;
}

// What one way to find n says of the two laws: log of the likelihood of 1 over that of 1.5 (Student's t), and whether
// both lie outside 95 %. Nothing where it has no error.
struct Evidence {
  bool known = false, neither = false;
  double for_linear = 0;
};

Evidence evidence_of(const Estimate& n, int freedom) {
  if (!std::isfinite(n.value) || !std::isfinite(n.se) || freedom < 1) return {};
  const double se = std::max(n.se, 1e-9);  // of exact numbers, the rounding
  const auto t = [&](double exponent) { return std::abs(n.value - exponent) / se; };
  const auto log_likelihood = [&](double exponent) {
    return -0.5 * (freedom + 1) * std::log1p(t(exponent) * t(exponent) / freedom);
  };
  const double limit = student_95(freedom);
  return {true, t(1) > limit && t(1.5) > limit, log_likelihood(1) - log_likelihood(1.5)};
}

void find_law(StiffnessGroup& group) {
  const Evidence height = evidence_of(group.exponent_by_height, group.freedom_by_height);
  const Evidence energy = evidence_of(group.exponent_by_energy, static_cast<int>(group.drops.size()) - 1);
  const double odds = std::log(10.0);  // ten to one is taken as telling
  const double sum = height.for_linear + energy.for_linear;
  using enum FavouredLaw;
  if (!height.known && !energy.known) {
    group.reason = "a single drop";
  } else if (height.neither == height.known && energy.neither == energy.known) {
    group.law = kNeither;
    group.reason = "n is neither 1 nor 1.5 by 95 %";
  } else if (std::min(height.for_linear, energy.for_linear) < -odds &&
             std::max(height.for_linear, energy.for_linear) > odds) {
    group.reason = height.for_linear > 0 ? "heights say linear, energy says Hertz" : "heights say Hertz, energy linear";
  } else if (std::abs(sum) < odds) {
    group.reason = "odds below ten to one";
  } else {
    group.law = sum > 0 ? kLinear : kHertz;
    const double ratio = std::exp(std::min(std::abs(sum), std::log(1e6)));
    group.reason = ratio < 1000 ? "odds " + std::to_string(std::lround(ratio)) + " to 1" : "odds beyond 1000 to 1";
  }
}

void estimate(StiffnessGroup& group) {
  const auto& drops = group.drops;
  const Estimate slope = mean_of(drops, [](const auto& d) { return std::log(stiffness_of(d).by_slope); });
  const Estimate spread = mean_of(drops, [](const auto& d) {
    const DropStiffness k = stiffness_of(d);
    return std::log(k.by_energy / k.by_slope);
  });
  group.half_spread = std::abs(spread.value);
  group.stiffness.value = std::exp(slope.value);
  group.by_energy = std::exp(slope.value + spread.value);
  group.by_force = std::exp(slope.value - spread.value);
  const double scatter = std::isfinite(slope.se) ? slope.se : 0;
  group.stiffness.se = group.stiffness.value * std::hypot(scatter, group.half_spread);
  group.exponent_by_energy =
      mean_of(drops, [](const auto& d) { return d.max_force * d.max_displacement / energy_of(d) - 1; });
  find_exponent_by_height(group);
  find_law(group);

  // F = K d^1.5 with E = (2/5) K d^2.5. Two balls have half the effective radius that a ball has on the flat anvil, and
  // K goes with its root; at 1 m/s they bring E_0 = m / 4 and overlap by d_0 = (5 E_0 / (2 K))^(2/5).
  const double prefactor = std::exp(mean_of(drops, [](const auto& d) {
                                      return std::log(2.5 * energy_of(d) / std::pow(d.max_displacement, 2.5));
                                    }).value);
  double heaviest = 0;
  for (const LoadCellDrop& d : drops) heaviest = std::max(heaviest, d.ball_mass);
  const double brought = heaviest / 4;
  group.hertz_normal_stiffness = 2 * brought / std::pow(2.5 * brought / (prefactor / std::sqrt(2.0)), 0.8);
}

}  // namespace

DropStiffness stiffness_of(const LoadCellDrop& drop) {
  const double f = drop.max_force, d = drop.max_displacement, energy = energy_of(drop);
  return {f / d, 2 * energy / (d * d), f * f / (2 * energy)};
}

std::vector<StiffnessGroup> stiffness_groups(std::span<const LoadCellDrop> drops) {
  std::vector<StiffnessGroup> groups;
  for (const LoadCellDrop& drop : drops) {
    auto group = std::find_if(groups.begin(), groups.end(), [&](const StiffnessGroup& g) {
      return g.particle_layers == drop.particle_layers && g.particle_size == drop.particle_size;
    });
    if (group == groups.end()) {
      groups.emplace_back();
      groups.back().particle_layers = drop.particle_layers;
      groups.back().particle_size = drop.particle_size;
      group = groups.end() - 1;
    }
    group->drops.push_back(drop);
  }
  std::stable_sort(groups.begin(), groups.end(),
                   [](const auto& a, const auto& b) { return a.particle_layers < b.particle_layers; });
  for (StiffnessGroup& group : groups) estimate(group);
  return groups;
}

}  // namespace tumble::diagnose
