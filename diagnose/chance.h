#pragma once
#include <span>
#include <vector>

// How far differences go by chance alone, and how often when there are many of them.
namespace tumble::diagnose {

// Errors of fields are from 16 batches of the frames, or from as many as there are frames: what chance does with them
// is Student's t of one degree fewer.
inline constexpr double kBatchFreedom = 15;
double batch_freedom(int frames);

// Degrees of freedom of the errors of two sources, and of a difference between them (Welch 1947).
struct Freedoms {
  double a = kBatchFreedom, b = kBatchFreedom;
};
double welch_freedom(double se_a, double se_b, const Freedoms& freedoms);

// The z of a normal distribution that is as rare as t (Wallace 1959): 0.02 wrong at most for 3 degrees and more.
double normal_z(double t, double freedom);

double two_sided_chance(double normal_z);

// Which of many are beyond chance, so that no more than `rate` of what is named is named by chance (Benjamini and
// Hochberg 1995). Holds for numbers that rise and fall together, as neighbouring cells do (Benjamini and Yekutieli
// 2001), and where nothing differs at all, `rate` is the chance that anything is named. NaNs are left out.
std::vector<char> beyond_chance(std::span<const double> chances, double rate);

}  // namespace tumble::diagnose
