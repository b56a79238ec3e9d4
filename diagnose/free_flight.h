#pragma once
#include <map>
#include <span>
#include <vector>

#include "diagnose/observation.h"

// Gravity as the film shows it: balls that touch nothing for a while. What bends their paths otherwise is drag, a
// turned camera, a wrong scale or a wrong clock (docs/diagnosis.md).
namespace tumble::diagnose {

class FreeFlights {
 public:
  // A ball counts while it is farther from all others and from lifters and shell than `clearance` of its radius.
  explicit FreeFlights(double tip_radius);

  void add(double time, std::span<const Sighting> balls);
  // Fills the observable kFlight: acceleration at rest and its slope on velocity, by least squares, with errors.
  void finish(const ObservationLayout& layout, const Observer& observer, Observation& into) const;

 private:
  struct Window {
    std::vector<double> t, x, y;
  };
  void use(const Window& w);

  double tip_radius_;
  std::map<int, Window> open_;            // by ball
  std::vector<std::array<double, 4>> a_;  // of each window: mean velocity, acceleration
};

}  // namespace tumble::diagnose
