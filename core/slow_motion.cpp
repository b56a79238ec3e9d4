#include "core/slow_motion.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/units.h"

namespace tumble {
namespace {

constexpr double kOverlap = 0.1;  // of the smaller radius: what nobody sees
constexpr double kUnsure = 0.05;  // of the radius
constexpr int kPasses = 8;        // pushing one pair apart may push another together

double length(double x, double y) { return std::sqrt(x * x + y * y); }  // of what is neither huge nor tiny

double overlap(const Frame& f, const Balls& balls, std::size_t i, std::size_t j) {
  return balls.radius[i] + balls.radius[j] - length(f.x[i] - f.x[j], f.y[i] - f.y[j]);
}

struct Pair {
  std::size_t i, j;
  double allowed = kNotGiven;  // overlap [m], once asked for
};

// Balls that may be shown where they never were: what they did between the frames is no flight, by more than a share of
// their radius. Most balls of a run with frames enough are not.
std::vector<char> unsure_balls(const Frame& a, const Frame& b, const Balls& balls) {
  const double h = b.time - a.time;
  std::vector<char> unsure(a.x.size());
  for (std::size_t i = 0; i < a.x.size(); ++i) {
    const double kick = length(b.vx[i] - a.vx[i], b.vy[i] - a.vy[i] + kGravity * h);
    const double aside = length(b.x[i] - a.x[i] - h / 2 * (a.vx[i] + b.vx[i]),  // 0 for a flight
                                b.y[i] - a.y[i] - h / 2 * (a.vy[i] + b.vy[i]));
    unsure[i] = 4.0 / 27 * h * kick + aside > kUnsure * balls.radius[i];
  }
  return unsure;
}

// Pairs that nearly touch and of which one is unsure, in a fixed order. Balls are sorted into cells, so that each is
// held only against those about it.
std::vector<Pair> near_pairs(const Frame& f, const Balls& balls, const std::vector<char>& unsure) {
  const double cell = 2.2 * *std::max_element(balls.radius.begin(), balls.radius.end());
  const auto [left, right] = std::minmax_element(f.x.begin(), f.x.end());
  const auto [low, high] = std::minmax_element(f.y.begin(), f.y.end());
  // A stray ball must not make the grid larger than the charge needs.
  const auto cells = [&](double from, double to) {
    return std::clamp(static_cast<std::int64_t>((to - from) / cell) + 1, std::int64_t{1}, std::int64_t{4096});
  };
  const std::int64_t columns = cells(*left, *right), rows = cells(*low, *high);
  const auto column_of = [&](std::size_t i) {
    return std::min(static_cast<std::int64_t>((f.x[i] - *left) / cell), columns - 1);
  };
  const auto row_of = [&](std::size_t i) {
    return std::min(static_cast<std::int64_t>((f.y[i] - *low) / cell), rows - 1);
  };
  std::vector<std::size_t> first(static_cast<std::size_t>(columns * rows) + 1), members(f.x.size());
  for (std::size_t i = 0; i < f.x.size(); ++i)
    ++first[static_cast<std::size_t>(row_of(i) * columns + column_of(i)) + 1];
  for (std::size_t c = 1; c < first.size(); ++c) first[c] += first[c - 1];
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (std::size_t i = 0; i < f.x.size(); ++i)
    members[next[static_cast<std::size_t>(row_of(i) * columns + column_of(i))]++] = i;

  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < f.x.size(); ++i) {
    if (!unsure[i]) continue;
    for (std::int64_t row = std::max<std::int64_t>(row_of(i) - 1, 0); row <= std::min(row_of(i) + 1, rows - 1); ++row) {
      const std::int64_t from = std::max<std::int64_t>(column_of(i) - 1, 0),
                         to = std::min(column_of(i) + 1, columns - 1);
      const std::size_t end = first[static_cast<std::size_t>(row * columns + to) + 1];
      for (std::size_t k = first[static_cast<std::size_t>(row * columns + from)]; k < end; ++k) {
        const std::size_t j = members[k];
        const double reach = 1.2 * (balls.radius[i] + balls.radius[j]);
        if (j != i && (j > i || !unsure[j]) && std::abs(f.x[i] - f.x[j]) < reach && std::abs(f.y[i] - f.y[j]) < reach)
          pairs.push_back({i, j});
      }
    }
  }
  return pairs;
}

}  // namespace

Frame slow_motion(const Frame& a, const Frame& b, const Balls& balls, double time) {
  Frame f = between(a, b, time);
  if (f.x.size() < 2 || f.time == a.time || f.time == b.time) return f;
  const std::vector<char> unsure = unsure_balls(a, b, balls);
  if (std::find(unsure.begin(), unsure.end(), 1) == unsure.end()) return f;
  std::vector<Pair> pairs = near_pairs(f, balls, unsure);
  bool has_pushed = true;
  for (int pass = 0; pass < kPasses && has_pushed; ++pass) {
    has_pushed = false;
    for (Pair& p : pairs) {
      const double dx = f.x[p.j] - f.x[p.i], dy = f.y[p.j] - f.y[p.i], apart = length(dx, dy);
      const double unseen = kOverlap * std::min(balls.radius[p.i], balls.radius[p.j]);
      double push = balls.radius[p.i] + balls.radius[p.j] - apart - unseen;
      if (!(push > 0)) continue;
      if (std::isnan(p.allowed))
        p.allowed = std::max({unseen, overlap(a, balls, p.i, p.j), overlap(b, balls, p.i, p.j)});
      push -= p.allowed - unseen;
      if (!(push > 0)) continue;
      has_pushed = true;
      const double ux = apart > 0 ? dx / apart : 1, uy = apart > 0 ? dy / apart : 0;
      const double share = balls.mass[p.j] / (balls.mass[p.i] + balls.mass[p.j]);  // the lighter one gives way
      f.x[p.i] -= push * share * ux;
      f.y[p.i] -= push * share * uy;
      f.x[p.j] += push * (1 - share) * ux;
      f.y[p.j] += push * (1 - share) * uy;
    }
  }
  return f;
}

}  // namespace tumble
