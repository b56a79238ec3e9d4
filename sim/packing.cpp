#include "sim/packing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/random.h"
#include "core/units.h"
#include "sim/ball_order.h"
#include "sim/running_mill.h"

namespace tumble::sim {
namespace {

// Share of the area that discs take in the loose start. Random sizes jam at about 0.84 in the plane, and fall least
// from close to that; far below it they push apart within a few dozen sweeps.
constexpr double kLooseShare = 0.7;

// Height up to which a circle of radius R about the origin must be filled to hold this area.
double level_of_area(double area, double radius) {
  double low = -radius, high = radius;
  for (int k = 0; k < 60; ++k) {
    const double y = (low + high) / 2;
    const double below = radius * radius * (std::asin(y / radius) + kPi / 2) + y * std::sqrt(radius * radius - y * y);
    (below < area ? low : high) = y;
  }
  return high;
}

// Centres of a hexagonal lattice below the level, from the bottom up; empty if fewer than `count` fit.
std::vector<std::pair<double, double>> lattice(double spacing, double radius, double level, std::size_t count) {
  std::vector<std::pair<double, double>> sites;
  const double rise = spacing * std::sqrt(0.75);
  for (int row = 0; sites.size() < count; ++row) {
    const double y = -radius + row * rise;
    if (y > level) return {};
    const double half = std::sqrt(std::max(0.0, radius * radius - y * y));
    const int n = static_cast<int>(half / spacing + 1);
    for (int k = -n; k <= n && sites.size() < count; ++k) {
      const double x = (k + (row % 2) * 0.5) * spacing;
      if (std::abs(x) <= half) sites.emplace_back(x, y);
    }
  }
  return sites;
}

// Pushes the ball out of shell and lifters; returns by how much it was inside.
double clear_of_walls(const Shell& shell, Charge& c, int i, double radius) {
  double worst = 0;
  const double rho = std::hypot(c.x[i], c.y[i]);
  if (rho + radius > shell.radius) {
    worst = rho + radius - shell.radius;
    const double inward = (shell.radius - radius) / rho;
    c.x[i] *= inward;
    c.y[i] *= inward;
  }
  std::vector<NearFeature> near;
  features_near(shell, ShellPose{}, c.x[i], c.y[i], radius, near);
  // Deep in a lifter, only the shortest way out counts.
  const int around = lifter_around(shell, c.x[i], c.y[i]);
  if (around >= 0) {
    near.clear();
    for (int feature = 1; feature < feature_count(shell); ++feature)
      if (lifter_of(shell, feature) == around) near.push_back({feature, 0});
  }
  for (const auto& [feature, ignored] : near) {
    if (feature == 0) continue;
    const WallPoint n = nearest_on_wall(shell, ShellPose{}, feature, c.x[i], c.y[i]);
    const double inside = radius - n.distance;
    if (inside <= 0 || (around >= 0 && n.distance > 0)) continue;
    worst = std::max(worst, inside);
    c.x[i] -= inside * n.nx;
    c.y[i] -= inside * n.ny;
    if (around >= 0) break;
  }
  return worst;
}

// One sweep over all overlaps, each pushed apart by half on either side. Returns the largest that was found [m].
double push_apart(const Shell& shell, Charge& c, double clearance, CellGrid& grid, std::vector<int>& partners) {
  double worst = 0;
  const double largest = *std::max_element(c.radius.begin(), c.radius.end());
  grid.fill(c, 2 * largest + clearance);
  for (int i = 0; i < static_cast<int>(c.size()); ++i) {
    grid.partners_of(c, i, clearance, partners);
    for (const int j : partners) {
      const double dx = c.x[j] - c.x[i], dy = c.y[j] - c.y[i], d = std::hypot(dx, dy);
      const double overlap = c.radius[i] + c.radius[j] + clearance - d;
      if (overlap <= 0) continue;
      worst = std::max(worst, overlap);
      const double nx = d > 0 ? dx / d : 1, ny = d > 0 ? dy / d : 0;
      c.x[i] -= overlap / 2 * nx;
      c.y[i] -= overlap / 2 * ny;
      c.x[j] += overlap / 2 * nx;
      c.y[j] += overlap / 2 * ny;
    }
  }
  for (int i = 0; i < static_cast<int>(c.size()); ++i)
    worst = std::max(worst, clear_of_walls(shell, c, i, c.radius[i] + clearance / 2));
  return worst;
}

// Sweeps until no overlap is larger than the clearance aimed at in vain, so that none is left without it: the last
// overlaps shrink ever more slowly. Gives up when nothing improves any more. Returns the largest overlap.
double push_apart_until(const Shell& shell, Charge& c, double clearance) {
  CellGrid grid;
  std::vector<int> partners;
  double worst = INFINITY, best = INFINITY;
  for (int sweep = 0, last_better = 0; worst > clearance && sweep - last_better < 300; ++sweep) {
    worst = push_apart(shell, c, clearance, grid, partners);
    if (worst < 0.99 * best) {
      best = worst;
      last_better = sweep;
    }
  }
  return worst;
}

}  // namespace

Balls draw_balls(const Config& config) {
  Balls balls;
  const std::vector<int> counts = class_counts(config);
  for (std::size_t k = 0; k < counts.size(); ++k) {
    balls.radius.insert(balls.radius.end(), counts[k], config.charge.balls[k].radius);
    balls.mass.insert(balls.mass.end(), counts[k], config.charge.balls[k].mass);
  }
  Random random(config.run.seed);
  for (std::size_t i = balls.size(); i > 1; --i) {
    const std::size_t j = random.below(i);
    std::swap(balls.radius[i - 1], balls.radius[j]);
    std::swap(balls.mass[i - 1], balls.mass[j]);
  }
  return balls;
}

Charge place_loosely(const Config& config, const MillModel& model, const Balls& balls) {
  Charge c = make_charge(balls);
  const auto [smallest, largest] = std::minmax_element(c.radius.begin(), c.radius.end());
  const char* key = config.charge.count ? "charge.count" : "charge.filling";
  if (*largest >= model.shell.tip_radius)
    throw InputError(place_of(config, "charge.balls"),
                     fmt::format("a ball of radius {:g} m does not fit between the lifter tips (radius {:g} m)",
                                 *largest, model.shell.tip_radius));

  double area = 0;
  for (const double r : c.radius) area += kPi * r * r;
  const double radius = model.shell.tip_radius - std::min(*smallest, model.shell.tip_radius / 2);
  const double whole = kPi * radius * radius;
  const double level = area / kLooseShare < whole ? level_of_area(area / kLooseShare, radius) : radius;
  double low = 0, high = 2 * radius;
  for (int k = 0; k < 40; ++k) {
    const double spacing = (low + high) / 2;
    (lattice(spacing, radius, level, c.size()).empty() ? high : low) = spacing;
  }
  const auto sites = lattice(low, radius, level, c.size());
  Random random(config.run.seed ^ 0x706C616365ull);  // another stream than the shuffle's
  for (std::size_t i = 0; i < c.size(); ++i) {
    c.x[i] = sites[i].first + low * random.uniform(-0.2, 0.2);
    c.y[i] = sites[i].second + low * random.uniform(-0.2, 0.2);
  }

  // First within the circle of the lifter tips: a large ball that is pressed into a pocket too narrow for it never
  // comes out again. Only what does not fit there gets the pockets as well.
  Shell inside_tips;
  inside_tips.radius = inside_tips.tip_radius = model.shell.tip_radius;
  const double clearance = 0.01 * *smallest;
  double worst = push_apart_until(inside_tips, c, clearance);
  if (!(worst <= clearance)) worst = push_apart_until(model.shell, c, clearance);
  if (!(worst <= clearance))
    throw InputError(
        place_of(config, key),
        fmt::format("{} balls do not fit into the mill: pushed apart they still overlap by {:.2g} mm; take a "
                    "smaller charge",
                    c.size(), 1e3 * (worst - clearance)));
  return c;
}

// Some mills rattle on for long without harm to what follows, hence the end after four falls through the mill.
double longest_settling(const MillModel& model) { return 4 * std::sqrt(4 * model.shell.radius / model.gravity); }

Charge settle(const MillModel& model, Charge charge, const Progress& progress) {
  MillModel resting = model;
  resting.speed = 0;
  const int threads = threads_for(charge.size());
  RunningMill mill = start_mill(resting, std::move(charge), threads);
  double scale = 0;  // sum of m g r [J]
  for (std::size_t i = 0; i < mill.charge.size(); ++i)
    scale += mill.charge.mass[i] * model.gravity * mill.charge.radius[i];
  // At rest: a ball's speed is that of a fall through a hundredth of its radius.
  const double longest = longest_settling(model);
  const auto check_every =
      static_cast<std::int64_t>(std::ceil(0.1 * std::sqrt(2 * model.shell.radius / model.gravity) / model.time_step));
  const auto steps_per_report = 1 + 1'000'000 / static_cast<std::int64_t>(mill.charge.size());
  while (double(mill.step) * model.time_step < longest) {
    for (std::int64_t k = 0; k < check_every; ++k) {
      advance(mill);
      if (k % steps_per_report == 0) report(progress, double(mill.step) * model.time_step / longest);
    }
    if (energies_of(mill).kinetic < 1e-2 * scale) break;
  }
  sort_by_number(mill);
  for (auto* v : {&mill.charge.vx, &mill.charge.vy, &mill.charge.spin, &mill.charge.angle})
    std::fill(v->begin(), v->end(), 0.0);
  return std::move(mill.charge);
}

}  // namespace tumble::sim
