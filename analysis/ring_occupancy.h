#pragma once
#include <array>
#include <span>

namespace tumble::analysis {

// Share of each 1-degree bin of a ring that is covered; bin i = [i, i + 1) degrees; NaN where nothing can be seen.
using RingProfile = std::array<double, 360>;

struct Disc {
  double x = 0, y = 0, radius = 0;  // about the mill's axis, any one unit of length
};

struct Ring {
  double inner = 0, outer = 0;  // radii about the mill's axis, in the discs' unit
};

// The ring that toe and shoulder are read in (contract, section 1): one number-mean ball diameter deep, just inside
// the lifter tips.
inline Ring edge_ring(double tip_radius, double mean_diameter) { return {tip_radius - mean_diameter, tip_radius}; }

// Areal occupancy by the union of the discs: exact along the radius, midpoint rule with kRaysPerBin rays across a bin.
inline constexpr int kRaysPerBin = 5;
RingProfile ring_occupancy(std::span<const Disc> discs, const Ring& ring);

}  // namespace tumble::analysis
