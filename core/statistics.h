#pragma once
#include <span>

#include "core/config.h"

namespace tumble {

// A quantity with its standard error; NaN where it cannot be had.
struct Estimate {
  double value = kNotGiven;
  double se = kNotGiven;
};

// Mean of a correlated time series. The standard error multiplies that of independent samples by the integrated
// autocorrelation time, summed up to the first non-positive pair (Geyer 1992, initial positive sequence).
// Fewer than 4 samples: se is NaN.
Estimate mean_of_series(std::span<const double> series);

// The same for directions in degrees: circular mean in [0, 360), error of the deviations from it. NaNs are left out.
Estimate mean_direction(std::span<const double> directions_deg);

// How many standard errors the second half's mean lies from the first half's, correlation allowed for.
double drift_z(std::span<const double> series);

// Mean of independent repeats, by their values alone; the standard error is from their scatter, or what the one repeat
// says of itself. Directions as in mean_direction.
Estimate mean_of_repeats(std::span<const Estimate> repeats, bool are_directions = false);
// The same mean's standard error from what the repeats say of themselves: near the other one where both are right.
double se_within_repeats(std::span<const Estimate> repeats);

}  // namespace tumble
