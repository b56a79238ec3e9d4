#include "analysis/free_surface.h"

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/quantile.h"

namespace tumble::analysis {
namespace {

class Grid {
 public:
  Grid(std::span<const double> occupancy, int n, double cell) : occupancy_(occupancy), n_(n), cell_(cell) {}

  double reach() const { return 0.5 * n_ * cell_; }
  double at(double x, double y) const {  // 0 outside the shell
    const double i = x / cell_ + 0.5 * n_ - 0.5, j = y / cell_ + 0.5 * n_ - 0.5;
    const int i0 = static_cast<int>(std::floor(i)), j0 = static_cast<int>(std::floor(j));
    const double a = i - i0, b = j - j0;
    return (1 - b) * ((1 - a) * of(i0, j0) + a * of(i0 + 1, j0)) +
           b * ((1 - a) * of(i0, j0 + 1) + a * of(i0 + 1, j0 + 1));
  }

 private:
  double of(int i, int j) const {
    if (i < 0 || j < 0 || i >= n_ || j >= n_) return 0;
    const double v =
        occupancy_[static_cast<std::size_t>(j) * static_cast<std::size_t>(n_) + static_cast<std::size_t>(i)];
    return std::isnan(v) ? 0 : v;
  }
  std::span<const double> occupancy_;
  int n_;
  double cell_;
};

}  // namespace

double half_bulk(std::span<const double> occupancy) {
  std::vector<double> covered;
  for (const double o : occupancy)
    if (o > 0.05) covered.push_back(o);
  return 0.5 * quantile_of(std::move(covered), 0.9);
}

std::vector<double> surface_heights(std::span<const double> occupancy, int n, double cell, double level, double bed,
                                    std::span<const double> across) {
  const Grid grid(occupancy, n, cell);
  const double c = std::cos(bed), s = std::sin(bed), step = 0.25 * cell;
  std::vector<double> heights;
  for (const double a : across) {
    // From where it is densest: lifters break the bed towards the shell, from there up it ends once.
    double densest = level, from = kNotGiven;
    const auto at = [&](double h) { return grid.at(-c * h - s * a, -s * h + c * a); };
    for (double h = -grid.reach(); h < grid.reach(); h += step)
      if (at(h) > densest) {
        densest = at(h);
        from = h;
      }
    double height = kNotGiven;
    for (double h = from; h < grid.reach(); h += step) {
      const double here = at(h), next = at(h + step);
      if (here >= level && next < level) {
        height = h + step * (here - level) / (here - next);
        break;
      }
    }
    heights.push_back(height);
  }
  return heights;
}

SurfaceLine free_surface(std::span<const double> occupancy, int n, double cell, double level) {
  SurfaceLine line;
  double x = 0, y = 0;
  for (std::size_t k = 0; k < occupancy.size(); ++k) {
    if (!(occupancy[k] >= level)) continue;
    x += occupancy[k] * (static_cast<double>(k % static_cast<std::size_t>(n)) + 0.5 - 0.5 * n);
    y += occupancy[k] * (static_cast<double>(k / static_cast<std::size_t>(n)) + 0.5 - 0.5 * n);
  }
  if (x == 0 && y == 0) return line;
  line.bed = std::atan2(y, x);
  std::vector<double> across;
  for (int i = 0; i < n; ++i) across.push_back((i + 0.5 - 0.5 * n) * cell);
  const std::vector<double> heights = surface_heights(occupancy, n, cell, level, line.bed, across);
  for (std::size_t i = 0; i < across.size(); ++i) {
    if (std::isnan(heights[i])) continue;
    line.across.push_back(across[i]);
    line.height.push_back(heights[i]);
  }
  return line;
}

double surface_angle_deg(double bed, std::span<const double> across, std::span<const double> height) {
  if (across.size() < 4) return kNotGiven;
  const double middle = 0.5 * (across.front() + across.back()), half = 0.25 * (across.back() - across.front());
  double n = 0, sa = 0, saa = 0, sh = 0, sah = 0;
  for (std::size_t i = 0; i < across.size(); ++i) {
    if (std::isnan(height[i]) || std::abs(across[i] - middle) > half * (1 + 1e-9)) continue;
    const double a = across[i] - middle;
    n += 1;
    sa += a;
    saa += a * a;
    sh += height[i];
    sah += a * height[i];
  }
  const double det = n * saa - sa * sa;
  if (n < 3 || !(det > 0)) return kNotGiven;
  // Along the surface: the bed's direction and a right angle on; heights turn it back.
  return wrap_180(degrees(bed) + 90 + degrees(std::atan((n * sah - sa * sh) / det)));
}

}  // namespace tumble::analysis
