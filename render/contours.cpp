#include "render/contours.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/lifter_section.h"

namespace tumble::render {
namespace {

using Point = Eigen::Vector2d;
constexpr int kNone = -1;

// The grid's edges, each between two neighbouring middles: 2 k to the right of middle k, 2 k + 1 upwards.
struct Edges {
  const Grid& grid;
  double level;

  Point crossing(int edge) const {
    const int k = edge / 2, i = k % grid.n, j = k / grid.n;
    const bool upwards = edge % 2 == 1;
    const double a = grid.at(i, j), b = upwards ? grid.at(i, j + 1) : grid.at(i + 1, j);
    const double share = (level - a) / (b - a) * grid.cell;
    return {grid.place(i) + (upwards ? 0 : share), grid.place(j) + (upwards ? share : 0)};
  }
};

// next[e]: the edge at which a line that comes in through edge e leaves the square again.
std::vector<int> links(const Grid& grid, double level) {
  std::vector<int> next(2 * grid.value.size(), kNone);
  for (int j = 0; j + 1 < grid.n; ++j) {
    for (int i = 0; i + 1 < grid.n; ++i) {
      const std::array<double, 4> corner{grid.at(i, j), grid.at(i + 1, j), grid.at(i + 1, j + 1), grid.at(i, j + 1)};
      const double middle = (corner[0] + corner[1] + corner[2] + corner[3]) / 4;
      if (std::isnan(middle)) continue;
      const int k = j * grid.n + i;
      // Counter-clockwise round the square; side s lies between corners s and s + 1.
      const std::array<int, 4> edge{2 * k, 2 * (k + 1) + 1, 2 * (k + grid.n), 2 * k + 1};
      const auto high = [&](int s) { return corner[static_cast<std::size_t>(s % 4)] >= level; };
      for (int s = 0; s < 4; ++s) {
        if (!high(s) || high(s + 1)) continue;  // a line begins where, going round, high ground ends
        // ... and ends where it begins again. Of two such sides that after the low corner, if the middle is high.
        int end = s + 1;
        if (middle >= level) {
          while (high(end) || !high(end + 1)) ++end;
        } else {
          end = s + 3;
          while (high(end) || !high(end + 1)) --end;
        }
        next[static_cast<std::size_t>(edge[static_cast<std::size_t>(s)])] = edge[static_cast<std::size_t>(end % 4)];
      }
    }
  }
  return next;
}

}  // namespace

std::vector<Contour> contours(const Grid& grid, double level) {
  const Edges edges{grid, level};
  std::vector<int> next = links(grid, level);
  std::vector<bool> has_before(next.size(), false);
  for (const int to : next)
    if (to != kNone) has_before[static_cast<std::size_t>(to)] = true;

  std::vector<Contour> lines;
  const auto walk = [&](std::size_t from) {
    Contour line;
    line.points.push_back(edges.crossing(static_cast<int>(from)));
    for (std::size_t at = from; next[at] != kNone;) {
      const int to = next[at];
      next[at] = kNone;
      at = static_cast<std::size_t>(to);
      line.closed = at == from;
      if (!line.closed) line.points.push_back(edges.crossing(to));
    }
    lines.push_back(std::move(line));
  };
  for (std::size_t e = 0; e < next.size(); ++e)
    if (next[e] != kNone && !has_before[e]) walk(e);  // open lines from their beginning
  for (std::size_t e = 0; e < next.size(); ++e)
    if (next[e] != kNone) walk(e);
  return lines;
}

Contour rounded(const Contour& line, double tolerance) {
  Contour result = line;
  if (line.points.size() < 3) return result;
  for (int round = 0; round < 2; ++round) {
    const std::vector<Point> p = std::move(result.points);
    result.points.clear();
    if (!line.closed) result.points.push_back(p.front());
    for (std::size_t i = 0; i + (line.closed ? 0 : 1) < p.size(); ++i) {
      const Point &a = p[i], &b = p[(i + 1) % p.size()];
      result.points.push_back(0.75 * a + 0.25 * b);
      result.points.push_back(0.25 * a + 0.75 * b);
    }
    if (!line.closed) result.points.push_back(p.back());
  }
  result.points = thinned(result.points, tolerance);
  return result;
}

Grid smoothed(const Grid& grid) {
  Grid result = grid;
  for (int j = 0; j < grid.n; ++j) {
    for (int i = 0; i < grid.n; ++i) {
      if (std::isnan(grid.at(i, j))) continue;
      double sum = 0, weights = 0;
      for (int v = std::max(0, j - 1); v <= std::min(grid.n - 1, j + 1); ++v) {
        for (int u = std::max(0, i - 1); u <= std::min(grid.n - 1, i + 1); ++u) {
          const double weight = (u == i ? 2 : 1) * (v == j ? 2 : 1), value = grid.at(u, v);
          if (std::isnan(value)) continue;
          sum += weight * value;
          weights += weight;
        }
      }
      result.at(i, j) = sum / weights;
    }
  }
  return result;
}

}  // namespace tumble::render
