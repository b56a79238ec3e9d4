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

// Means over a block of time: of the torque that was read, and of what it takes to hold the charge and to speed it up,
// M g x_com + dL/dt [N m].
struct TorqueBlock {
  double read = 0, needed = 0;
};
// Blocks of equal duration; none where the torque is no series, or not over the same time as the frames.
std::vector<TorqueBlock> torque_blocks(const SeenCharge& charge, const Measurement& m, int blocks);

// Index of the class nearest in radius; -1 where there is none or the radius is NaN.
int class_of(const Config& config, double radius);

}  // namespace tumble::diagnose
