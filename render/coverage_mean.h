#pragma once
#include <cstddef>
#include <cstdint>
#include <deque>
#include <vector>

#include "core/image.h"
#include "render/palette.h"

namespace tumble::render {

struct CoveredDisc {
  double u = 0, v = 0, radius = 0;  // [px]
};

// What balls cover in two sources, and where one covers more: in a running mean over so many pictures, for single
// pictures of a chaotic motion never agree.
class CoverageMean {
 public:
  CoverageMean(int edge_px, std::size_t pictures);

  void add(const std::vector<CoveredDisc>& first, const std::vector<CoveredDisc>& second);

  // Where only one covers, in its colour, as opaque as it does more often; where both do, in `both`.
  Image picture(Rgba first, Rgba second, Rgba both) const;

  // Area that only the one covers, as a share of what either covers: 0 where both are the same.
  double only_first() const { return share_of(0); }
  double only_second() const { return share_of(1); }
  std::size_t pictures() const { return kept_.size(); }

 private:
  struct Masks {
    std::vector<std::uint8_t> of[2];  // share of each pixel that is covered, over 255
  };
  double share_of(int source) const;

  int edge_;
  std::size_t most_;
  std::deque<Masks> kept_;
  std::vector<std::uint32_t> sum_[2];
};

}  // namespace tumble::render
