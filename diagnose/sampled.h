#pragma once
#include <string>
#include <vector>

#include "core/charge_motion.h"
#include "core/deviation.h"
#include "diagnose/chance.h"

// What two charge motions have along lines and over the grid, brought to the same places.
namespace tumble::diagnose {

// Share of comparisons of equal mills in which a kind of numbers may show anything beyond chance.
inline constexpr double kFalseAlarms = 0.01;

// Fills difference, se, z, significant, compared, beyond_chance and mean_square from a, a_se, b, b_se. `ratio`: of
// quantities whose errors grow with them, z is that of the ratio's logarithm.
void judge(SampledDifference& d, const Freedoms& freedoms, bool ratio = false);

// How the beds of both lie: `deg` from the axis to the middle of the charge, NaN where there is none.
double common_bed_deg(const ChargeMotion& a, const ChargeMotion& b);

// Share of the area covered, and mean velocity, cell by cell of the same grid in units of the mill's radius.
// `velocities`: they are comparable. Nothing where one has no grid, or another one.
std::vector<SampledDifference> compare_fields(const ChargeMotion& a, const ChargeMotion& b, bool velocities);

// Occupancy of the ring by angle; where `lengths` are comparable: free surface across the bed and velocity along the
// surface through the bed's middle.
std::vector<SampledDifference> compare_lines(const ChargeMotion& a, const ChargeMotion& b, bool lengths);

// Torque over a lifter's passage, where both have the same number of lifters and samples enough on the way.
std::vector<SampledDifference> compare_lifter_passages(const ChargeMotion& a, const ChargeMotion& b);

// Power spectra over time of torque and head, in bands; `se` of each from its scatter over stretches of the series.
std::vector<SampledDifference> compare_spectra(const ChargeMotion& a, const ChargeMotion& b);

}  // namespace tumble::diagnose
