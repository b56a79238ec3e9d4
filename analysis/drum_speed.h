#pragma once
#include <span>
#include <vector>

#include "analysis/drum_reader.h"
#include "core/statistics.h"

namespace tumble::analysis {

// Slope of a series against time [unit of y per unit of time], its error allowing for residuals that are correlated in
// time. Fewer than 3 values: NaN.
Estimate slope_of_series(std::span<const double> time, std::span<const double> y);

// Turn of the drum per unit of `time`, least squares; only readings that have an error. Three things make its error:
// what is left over in time; by how much parts of the drum, each followed by itself, contradict each other; and what
// none of these knows: a camera that is a little wrong, and light that does not turn, shift what is seen in a direction
// always alike. Round a whole drum that cancels, and after a revolution it comes back; but where only part of the round
// is seen, all that passes there seems to go a little faster or slower. `alike`: by how much directions err at least
// [rad].
Estimate turn_of_drum(std::span<const double> time, std::span<const DrumAngle> angles, double alike);

}  // namespace tumble::analysis
