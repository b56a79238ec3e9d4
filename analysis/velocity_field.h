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

  struct Surface {
    std::vector<SurfacePoint> line;
    Estimate angle_deg;
  };
  Surface surface() const;  // of the charge (free_surface.h)

  // The charge: where more than half of the bulk's occupancy is covered, cell by cell.
  std::vector<bool> charge() const;
  std::size_t cell_at(double x, double y) const;  // past the last one outside the grid
  Estimate granular_temperature() const;          // mean over the charge, weighted by what covers it

 private:
  std::vector<double> occupancy_of(std::span<const double> sums, double frames) const;

  double radius_, cell_;
  BlockSums sums_;
  std::vector<double> row_;  // scratch: one frame's sums
  std::vector<int> owner_;   // scratch: disc that covers each sample point, -1 for none
};

}  // namespace tumble::analysis
