#pragma once
#include <map>
#include <span>
#include <vector>

#include "diagnose/observation.h"

// Gravity as the film shows it: balls that touch nothing for a while. What bends their paths otherwise is drag, a
// turned camera, a wrong scale or a wrong clock (docs/diagnosis.md).
namespace tumble::diagnose {

struct FreeFall {                 // a stretch of one ball's flight, and the parabola through it
  double time = 0, x = 0, y = 0;  // of its middle [s], [m]
  double vx = 0, vy = 0;          // there [m/s]
  double ax = 0, ay = 0;          // [m/s2]
  double radius = 0;              // of the ball [m]
  double misfit = 0;              // of the places, per degree of freedom [m]: their noise, unless something was hit
  double velocity_error = 0;      // of vx and of vy, times the noise of places [1/s]
};

class FreeFlights {
 public:
  // A ball counts while it is farther from all others and from lifters and shell than `clearance` of its radius.
  explicit FreeFlights(double tip_radius);

  void add(double time, std::span<const Sighting> balls);
  // Fills the observable kFlight: acceleration at rest and its slope on velocity, by least squares, with errors.
  void finish(const ObservationLayout& layout, const Observer& observer, Observation& into) const;
  const std::vector<FreeFall>& windows() const { return windows_; }

 private:
  struct Window {
    std::vector<double> t, x, y;
    double radius = 0;
  };
  void use(const Window& w);

  double tip_radius_;
  std::map<int, Window> open_;  // by ball
  std::vector<FreeFall> windows_;
};

}  // namespace tumble::diagnose
