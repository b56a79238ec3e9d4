#pragma once
#include <algorithm>
#include <array>
#include <vector>

namespace tumble::sim {

// Pairs that do not touch but may before they are next searched for: ball and ball, or ball and a feature of the shell.
// They are sorted into tiers by their gap, and a tier is not looked at before its bodies can have closed it.
struct NearPairs {
  static constexpr int kTiers = 4;
  struct Tier {
    std::vector<int> i, j;  // with room for whole batches of lanes
    int count = 0;
    void add(int a, int b) {
      if (count == static_cast<int>(i.size())) {
        const std::size_t room = i.size() + std::max<std::size_t>(1, i.size() / 512) * 64;
        for (std::vector<int>* column : {&i, &j}) {
          column->reserve(room);  // by itself it would double
          column->resize(room);
        }
      }
      i[static_cast<std::size_t>(count)] = a;
      j[static_cast<std::size_t>(count++)] = b;
    }
    void remove(int k) {  // the order means nothing
      --count;
      i[static_cast<std::size_t>(k)] = i[static_cast<std::size_t>(count)];
      j[static_cast<std::size_t>(k)] = j[static_cast<std::size_t>(count)];
    }
  };
  std::array<Tier, kTiers> tiers;
  double per_width = 0;  // tiers per gap [1/m]

  void clear(double skin) {
    per_width = kTiers / skin;
    for (Tier& t : tiers) t.count = 0;
  }
  void add(int i, int j, double gap) {
    tiers[static_cast<std::size_t>(std::clamp(static_cast<int>(gap * per_width), 0, kTiers - 1))].add(i, j);
  }
  // Tiers to look at once two bodies can have come nearer by this much.
  int due(double nearer) const { return std::min(kTiers, 1 + static_cast<int>(nearer * per_width + 1e-6)); }
};

}  // namespace tumble::sim
