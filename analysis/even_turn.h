#pragma once
#include <span>

namespace tumble::analysis {

// Whether angles that were read picture by picture can be a drum's. A drum's speed is even over a few pictures,
// whatever pictures are repeated or missing; that of a charge, which slides, surges and is replaced by other balls, is
// not.
struct Evenness {
  bool even = true;    // also where the angles are too few to tell
  double scatter = 0;  // of the speed over a few pictures [rad a picture]
};

// `angles`: by picture [rad; NaN where unknown].
Evenness evenness_of(std::span<const double> angles);

}  // namespace tumble::analysis
