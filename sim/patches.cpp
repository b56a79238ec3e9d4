#include "sim/patches.h"

#include <algorithm>
#include <bit>

namespace tumble::sim {
namespace {

// The balls that the patch's contacts can reach until the next search.
void find_reach(Patch& patch) {
  int low = patch.first, high = patch.last;
  const auto widen = [&](const std::vector<int>& balls, int count) {
    for (int k = 0; k < count; ++k) {
      low = std::min(low, balls[static_cast<std::size_t>(k)]);
      high = std::max(high, balls[static_cast<std::size_t>(k)] + 1);
    }
  };
  for (int kind = 0; kind < kKinds; ++kind) {
    const auto k = static_cast<std::size_t>(kind);
    const bool balls = kind == static_cast<int>(Kind::kBalls);
    for (const NearPairs::Tier& t : patch.near[k].tiers) {
      widen(t.i, t.count);
      if (balls) widen(t.j, t.count);
    }
    widen(patch.touching[k].i, patch.touching[k].count);
    if (balls) widen(patch.touching[k].j, patch.touching[k].count);
  }
  patch.low = low;
  patch.high = high;
}

void find_neighbours(RunningMill& mill) {
  const auto patch_of = [&](int ball) {
    const auto behind = std::upper_bound(mill.patches.begin(), mill.patches.end(), ball,
                                         [](int b, const Patch& p) { return b < p.first; });
    return static_cast<int>(behind - mill.patches.begin()) - 1;
  };
  for_patches(mill, [&](Patch& patch, Share&) {
    find_reach(patch);
    patch.low_patch = patch_of(patch.low);
    patch.high_patch = patch_of(patch.high - 1);
    patch.apart = true;
  });
}

// What a step of the patch costs, roughly: a contact twice as much as a ball, a near pair a sixth.
double work_of(const Patch& patch) {
  double work = 6.0 * (patch.last - patch.first);
  for (const ContactTable& table : patch.touching) work += 12.0 * table.size();
  for (const NearPairs& near : patch.near)
    for (const NearPairs::Tier& t : near.tiers) work += t.count;
  return work;
}

// As much work for each thread as it has lately shown that it can do.
void balance(RunningMill& mill) {
  const int patches = static_cast<int>(mill.patches.size()), shares = static_cast<int>(mill.shares.size());
  double all = 0, rates = 0, paces = 0, done = 0, end = 0;
  for (const Patch& patch : mill.patches) all += work_of(patch);
  for (const Share& share : mill.shares) rates += share.seconds > 0 ? share.work / share.seconds : 0;
  for (Share& share : mill.shares) {
    constexpr double kTrust = 0.1;  // in what one interval between searches shows
    if (rates > 0 && share.seconds > 0)
      share.pace += kTrust * (shares * share.work / share.seconds / rates - share.pace);
    paces += share.pace;
  }
  int p = 0;
  for (int s = 0; s < shares; ++s) {
    Share& share = mill.shares[static_cast<std::size_t>(s)];
    share.first = p;
    end += all * share.pace / paces;
    share.work = share.seconds = 0;
    const int most = patches - (shares - 1 - s);  // every share has a patch
    do {
      share.work += work_of(patch_at(mill, p++));
    } while (p < most && (s + 1 == shares || done + share.work + work_of(patch_at(mill, p)) / 2 < end));
    done += share.work;
    share.last = p;
  }
}

// When the patches of a share may be kicked, who else reaches them, and room for forces.
void plan(RunningMill& mill, Share& share) {
  for (int p = share.last - 1, next = share.last; p >= share.first; --p) {
    patch_at(mill, p).done_before = std::min(p + 1, next);
    next = std::min(next, patch_at(mill, p).low_patch);
  }
  share.low = patch_at(mill, share.first).first;
  share.high = patch_at(mill, share.last - 1).last;
  int reached = 0, waiting = share.first, rows = kMostLanes;
  for (int p = share.first; p < share.last; ++p) {
    const Patch& patch = patch_at(mill, p);
    share.low = std::min(share.low, patch.low);
    share.high = std::max(share.high, patch.high);
    for (int q = patch.low_patch; q <= patch.high_patch; ++q)
      if (q < share.first || q >= share.last) patch_at(mill, q).apart = false;
    reached = std::max(reached, patch.high);
    rows = std::max(rows, reached - patch_at(mill, waiting).first);
    waiting = std::max(waiting, patch.done_before);
  }
  // Where threads meet, rows wait until all have come to the end.
  if (mill.shares.size() > 1) rows = share.high - share.low;
  const auto room = std::bit_ceil(static_cast<unsigned>(rows));
  share.mask = static_cast<int>(room) - 1;
  if (share.forces.size() != kRow * room) share.forces.assign(std::size_t{kRow} * room, 0.0);  // else all are zero
}

}  // namespace

void cut_up(RunningMill& mill, int threads, int balls_per_patch) {
  const int balls = static_cast<int>(mill.charge.size());
  constexpr int kPatchesPerThread = 8;  // so that they can be dealt out evenly
  constexpr int kFewBalls = 256;
  if (threads > 1)
    balls_per_patch = std::min(balls_per_patch, std::max(kFewBalls, balls / threads / kPatchesPerThread));
  // Whole batches of lanes, so that no two patches share one.
  const int each = (balls_per_patch + kMostLanes - 1) / kMostLanes * kMostLanes;
  const int patches = std::max(1, (balls + each / 2) / each);
  mill.patches.resize(static_cast<std::size_t>(patches));
  for (int p = 0; p < patches; ++p) {
    patch_at(mill, p).first = p * each;
    patch_at(mill, p).last = p + 1 < patches ? (p + 1) * each : balls;
  }
  mill.shares.resize(static_cast<std::size_t>(std::clamp(threads, 1, patches)));
  balance(mill);
  // One patch stays in the cache, wherever its balls are.
  mill.searches_per_sort = patches == 1 ? 0 : 4;
}

void share_out(RunningMill& mill) {
  find_neighbours(mill);
  balance(mill);
  for (Share& share : mill.shares) plan(mill, share);
}

}  // namespace tumble::sim
