#pragma once
#include <span>
#include <vector>

// How far differences go by chance alone, and how often when there are many of them.
namespace tumble::diagnose {

// Errors of fields are from 16 batches of the run: what chance does with them is Student's t of so many degrees.
inline constexpr double kBatchFreedom = 15;

// Degrees of freedom of a difference whose two errors have `kBatchFreedom` each (Welch 1947).
double welch_freedom(double se_a, double se_b);

// The z of a normal distribution that is as rare as t (Wallace 1959): 0.02 wrong at most for 3 degrees and more.
double normal_z(double t, double freedom);

double two_sided_chance(double normal_z);

// Which of many are beyond chance, so that no more than `rate` of what is named is named by chance (Benjamini and
// Hochberg 1995). Holds for numbers that rise and fall together, as neighbouring cells do (Benjamini and Yekutieli
// 2001), and where nothing differs at all, `rate` is the chance that anything is named. NaNs are left out.
std::vector<char> beyond_chance(std::span<const double> chances, double rate);

}  // namespace tumble::diagnose
