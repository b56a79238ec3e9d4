#pragma once
#include <span>
#include <vector>

#include "analysis/block_sums.h"
#include "core/charge_motion.h"

namespace tumble::analysis {

inline constexpr int kFieldCells =
    40;  // across the shell's diameter: the same grid for truth and film, so that they compare

struct MovingDisc {
  double x = 0, y = 0, radius = 0;        // about the mill's axis
  double vx = kNotGiven, vy = kNotGiven;  // NaN: covers area, but says nothing of the velocity
};

// Time-mean fields on a grid over the shell. A point covered by a ball has that ball's velocity (spin left out).
class FieldStatistics {
 public:
  explicit FieldStatistics(double mill_radius);

  void add(std::span<const MovingDisc> discs);  // one frame
  Field field() const;

  struct Centre {
    Estimate x, y;
  };
  // Zero of the time-mean velocity inside the bulk: root of a plane fitted to the field within `reach` of it, so that
  // single noisy cells do not move it. NaN where no vortex turns with the mill.
  Centre centre_of_circulation(double reach) const;

 private:
  double radius_, cell_;
  BlockSums sums_;
  std::vector<double> row_;  // scratch: one frame's sums
  std::vector<int> owner_;   // scratch: disc that covers each sample point, -1 for none
};

}  // namespace tumble::analysis
