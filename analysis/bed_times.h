#pragma once
#include <vector>

#include "core/charge_motion.h"

namespace tumble::analysis {

// How long each ball has lain in the bed. A ball's way through a tumbling mill is a chain of stays in the bed and of
// flights back to its toe. For rotating drums the literature counts a particle's residence from renewal to renewal at
// the free surface (Alizadeh et al. 2013, AIChE J. 59, 1894); in a mill that cataracts a flight is that renewal.
// Flights are those by which departure and impact toe are measured: free fall for 0.06 s at least, so hops within the
// bed end no stay, and neither does cascading down its surface.
class BedTimes {
 public:
  explicit BedTimes(const ChargeMotion& motion);  // of a run file: every ball in every frame

  // Seconds since the ball's last flight ended; 0 in flight. Before its first flight: since the run's first frame, for
  // more is not known. Hangs on the run alone, not on which part of it is looked at.
  double residence(std::size_t ball, double time) const;

  // Lengths of the stays between two flights of a ball [s].
  std::vector<double> stays() const;

 private:
  struct Span {
    double from = 0, to = 0;  // of a flight [s]
  };
  double begin_ = 0;
  std::vector<std::vector<Span>> flights_;  // of each ball, one after the other
};

}  // namespace tumble::analysis
