#pragma once
#include <vector>

#include "core/statistics.h"
#include "diagnose/measurement.h"

// The charge as a whole, as it is seen frame by frame: where its weight pulls and how fast it goes round. What a torque
// meter reads in a steady state follows from that alone.
namespace tumble::diagnose {

struct SeenCharge {
  std::vector<double> time;              // [s]
  std::vector<double> moment;            // M g x_com [N m], M the mass of all balls that the config has
  std::vector<double> height;            // y_com [m]
  std::vector<double> angular_momentum;  // of the balls' paths about the axis [kg m2/s]; NaN at the ends
  std::vector<double> balls;             // seen
};

// Balls that are not seen in a frame count as lying where those are that are. A ball weighs what the class nearest in
// radius weighs; the mean where its radius is not known.
SeenCharge see_charge(const Measurement& m);

// Index of the class nearest in radius; -1 where there is none or the radius is NaN.
int class_of(const Config& config, double radius);

}  // namespace tumble::diagnose
