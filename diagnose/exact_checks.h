#pragma once
#include <string>
#include <vector>

#include "diagnose/measurement.h"

// What can be said of a measurement without any simulation, because it holds for every mill: balls in flight fall with
// g, they touch at the sum of their radii and stop at the shell, their number does not change, the torque holds the
// charge's weight, the drum turns as it is set. Each is an estimate of what somebody got wrong, with its error:
// docs/measurements.md.
namespace tumble::diagnose {

struct MovedBy {  // a suspect that moves a number
  std::string suspect;
  double per = kNotGiven;  // strength, in its parameter's units, for each unit that the number is off; NaN: not known
};

struct ExactCheck {
  std::string name;        // "flight_gravity"
  std::string experiment;  // its name
  double found = 0, expected = 0, se = 0;
  double z = 0;  // (found - expected) / se: a standard normal number where nothing is hidden
  std::string unit;
  std::string says;                   // in one sentence
  std::vector<MovedBy> moved_by;      // the likeliest first
  std::vector<std::string> excludes;  // the suspects that it rules out, alone and at full strength
  // Of moved_by.front(), in its parameter's units: what the whole of the difference would come to.
  double strength = kNotGiven, strength_se = kNotGiven;

  bool is_clear() const { return z > kClear || z < -kClear; }  // so far off that it is no chance
  static constexpr double kClear = 3.5;
};

// All that the data allow; empty where they allow none.
std::vector<ExactCheck> exact_checks(const Measurement& m);

struct RippleOrder {             // of the mill's speed, by what its angle does
  int order = 1;                 // ripples per revolution
  double amplitude = 0, se = 0;  // relative to the mean speed; se: of each of its two parts, in and out of phase
  double phase_deg = 0;          // at mill angle 0, as effects.speed_ripple has it
  double p = 1;                  // of a line as strong or stronger where there is none
};

// Orders 1 to 36; empty where frames tell no mill angle, or fewer than three revolutions.
std::vector<RippleOrder> ripple_orders(const Measurement& m);

// Where balls say that the shell is, in the frames' own coordinates [m]; NaN where too few lie against it.
struct SeenShell {
  Estimate centre_x, centre_y;
  Estimate radius;
};
SeenShell seen_shell(const Measurement& m);

}  // namespace tumble::diagnose
