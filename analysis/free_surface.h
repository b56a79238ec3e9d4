#pragma once
#include <span>
#include <vector>

#include "core/charge_motion.h"

namespace tumble::analysis {

// Half of what the bulk covers: the 90th percentile of the cells that anything covers. Charge is where more is covered.
double half_bulk(std::span<const double> occupancy);

// The free surface of the charge in a time-mean occupancy (square grid of n x n cells about the axis, rows from the
// lowest y, NaN outside the shell): over points across the bed, going from the shell towards the axis along the
// direction in which the charge lies, where occupancy last is above `level`. Occupancy is linear between cells'
// middles.
struct SurfaceLine {
  double bed = kNotGiven;              // direction from the axis to the charge [rad]
  std::vector<double> across, height;  // along the surface, from toe to shoulder; above the bed, towards the axis [m]
};
SurfaceLine free_surface(std::span<const double> occupancy, int n, double cell, double level);
// The same across a bed that lies in a known direction and at known points; NaN where there is no charge.
std::vector<double> surface_heights(std::span<const double> occupancy, int n, double cell, double level, double bed,
                                    std::span<const double> across);

// Angle of the middle half of the surface against the horizontal [degrees], > 0 where it rises to the right.
double surface_angle_deg(double bed, std::span<const double> across, std::span<const double> height);

}  // namespace tumble::analysis
