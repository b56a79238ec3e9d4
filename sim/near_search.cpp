#include "sim/near_search.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "sim/ball_order.h"
#include "sim/kernels/meeting.h"
#include "sim/patches.h"

namespace tumble::sim {
namespace {

// Contacts of one kind, for asking whether a pair is among them.
class Known {
 public:
  Known(const RunningMill& mill, Kind kind) {
    for (const Patch& patch : mill.patches) {
      const ContactTable& table = patch.touching[static_cast<std::size_t>(kind)];
      for (int k = 0; k < table.size(); ++k) {
        std::pair<int, int> pair(table.i[k], table.j[k]);
        if (kind == Kind::kBalls) pair = std::minmax(pair.first, pair.second);
        keys_.push_back(key(pair.first, pair.second));
      }
    }
    std::sort(keys_.begin(), keys_.end());
  }
  bool has(int i, int j) const { return std::binary_search(keys_.begin(), keys_.end(), key(i, j)); }

 private:
  static std::uint64_t key(int i, int j) {
    return (static_cast<std::uint64_t>(i) << 32) | static_cast<std::uint32_t>(j);
  }
  std::vector<std::uint64_t> keys_;
};

constexpr int kPairsAtATime = 512;

// Pairs are found from the larger of the two balls, so that a few large ones do not make all the others look far; of
// equal ones from that which comes first in the grid. `known`: contacts that there are already; null, where all that
// touches is one.
void near_balls(const RunningMill& mill, Patch& patch, Share& share, const Known* known) {
  const CellGrid& grid = mill.grid;
  const GridView view{grid.x(), grid.y(), grid.radius()};
  const Kernels& kernels = *mill.kernels;
  NearPairs& near = patch.near[static_cast<std::size_t>(Kind::kBalls)];
  near.clear(mill.skin);
  std::vector<int>&found_p = share.found_p, &found_q = share.found_q;
  std::vector<double>& gap = share.gaps;
  int found = 0;
  const auto take_in = [&] {
    gap.resize(found_p.size());
    kernels.gaps(view, found_p.data(), found_q.data(), found, gap.data());
    for (int f = 0; f < found; ++f) {
      const auto k = static_cast<std::size_t>(f);
      const int i = grid.balls()[static_cast<std::size_t>(found_p[k])],
                j = grid.balls()[static_cast<std::size_t>(found_q[k])];
      if (gap[k] >= 0 || (known && !known->has(std::min(i, j), std::max(i, j)))) near.add(i, j, gap[k]);
    }
    found = 0;
  };
  for (int p = patch.first; p < patch.last; ++p) {
    const double radius = view.radius[p];
    grid.for_ranges(p, 2 * radius + mill.skin, radius > mill.smallest_radius, [&](int from, int to, bool later) {
      const auto room = static_cast<std::size_t>(found + std::max(0, to - from) + 2 * kMostLanes);
      if (room > found_p.size()) {
        found_p.resize(2 * room);
        found_q.resize(2 * room);
      }
      found += kernels.near_of(view, p, from, to, mill.skin, !later, found_p.data() + found, found_q.data() + found);
    });
    if (found >= kPairsAtATime) take_in();
  }
  take_in();
}

void near_wall(const RunningMill& mill, Patch& patch, const Known* known_plate, const Known* known_lifters) {
  const Charge& c = mill.charge;
  const Shell& shell = mill.model.shell;
  NearPairs& plate = patch.near[static_cast<std::size_t>(Kind::kPlate)];
  NearPairs& lifters = patch.near[static_cast<std::size_t>(Kind::kLifters)];
  plate.clear(mill.skin);
  lifters.clear(mill.skin);
  const ShellPose pose = pose_of(mill_angle(mill.model, mill.step));
  std::vector<NearFeature> found;
  for (int i = patch.first; i < patch.last; ++i) {
    const double x = c.x[i], y = c.y[i], radius = c.radius[i];
    const double inside = shell.tip_radius - radius - mill.skin;
    if (inside > 0 && x * x + y * y < inside * inside) continue;
    found.clear();
    features_near(shell, pose, x, y, radius + mill.skin, found);
    for (const NearFeature& f : found) {
      const bool is_plate = f.feature == 0;
      if (f.distance < radius) {
        const bool touches = nearest_on_wall(shell, pose, f.feature, x, y).distance < radius;
        const Known* known = is_plate ? known_plate : known_lifters;
        if (touches && (!known || known->has(i, f.feature))) continue;
      }
      (is_plate ? plate : lifters).add(i, f.feature, f.distance - radius);
    }
  }
}

// Steps between two searches are won with a larger skin, and paid for with pairs to look at in each of them: with u the
// way of the fastest ball in a step, the sum is least for a skin that goes with sqrt(u r). The factor is measured, see
// docs/performance.md.
double best_skin(const RunningMill& mill) {
  const double mean_radius = mill.mean_radius;
  const double way = std::max(mill.fastest, shell_speed(mill.model)) * mill.model.time_step;
  return std::clamp(7 * std::sqrt(way * mean_radius), 0.1 * mean_radius, 2 * mean_radius);
}

}  // namespace

void search_near(RunningMill& mill, bool settled) {
  const Charge& c = mill.charge;
  const double radius = mill.model.shell.radius;
  for (std::size_t i = 0; i < c.size(); ++i)
    if (!(c.x[i] * c.x[i] + c.y[i] * c.y[i] < radius * radius))
      left_physics(mill, fmt::format("ball {} is outside the shell", c.id[i]));
  mill.skin = best_skin(mill);
  mill.grid.fill(c, 2 * mill.mean_radius + mill.skin);
  if (mill.searches_per_sort > 0 && mill.searches++ % mill.searches_per_sort == 0) sort_by_cell(mill);
  std::vector<Known> known;
  if (!settled)
    for (const Kind kind : {Kind::kBalls, Kind::kPlate, Kind::kLifters}) known.emplace_back(mill, kind);
  for_patches(mill, [&](Patch& patch, Share& share) {
    near_balls(mill, patch, share, settled ? nullptr : &known[0]);
    near_wall(mill, patch, settled ? nullptr : &known[1], settled ? nullptr : &known[2]);
  });
  share_out(mill);
  mill.moved = 0;
  mill.stale = false;
}

}  // namespace tumble::sim
