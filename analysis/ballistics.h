#pragma once
#include <span>
#include <vector>

#include "core/statistics.h"

// The clock and the upright of a film from balls that fall: whatever they weigh and wherever they leave the charge, all
// balls in flight share one acceleration. In lengths per frame squared it gives the true frame rate sqrt(g / |a|); its
// direction is straight down, so a camera that was rolled shows too. Nothing needs to be known of the clock beforehand.
namespace tumble::analysis {

struct TimedPlace {              // one ball seen once
  int track = 0;                 // sightings of one ball share it
  double frame = 0;              // recorded frame index: dropped frames count, duplicated ones are left out
  double x = 0, y = 0;           // about the mill's axis, y up, any one unit of length
  double sigma = kNotGiven;      // standard deviation of x and of y; only ratios between sightings count
  double row_share = kNotGiven;  // row of the picture over its height, 0 top to 1 bottom, for a rolling shutter
};

struct FallOptions {
  double most_roll_deg = 30;  // gravity is looked for within this of straight down, (0, 90]
  double readout_share =
      kNotGiven;  // readout time of the picture over the time between frames; NaN: estimated if rows are given
};

struct FreeFlight {  // a stretch of one track at constant acceleration
  int track = 0;
  double first = 0, last = 0;  // frame indices
  int sightings = 0;
  double ax = 0, ay = 0;  // [length / frame^2]
  double sigma = 0;       // error of ax and of ay by the noise of the sightings alone
};

struct FreeFall {
  std::vector<FreeFlight> flights;        // those that share the acceleration; empty where there are too few
  double ax = kNotGiven, ay = kNotGiven;  // common acceleration [length / frame^2]
  Estimate magnitude;                     // |a|
  Estimate roll_deg;         // > 0: the picture is turned counter-clockwise, balls fall towards its lower right
  Estimate readout_share;    // as given (error 0), or as estimated; NaN where there are no rows
  double noise = kNotGiven;  // of a sighting along one axis, from the flights [length]
};

// Fewer than two flights, or flights that do not agree to 12 %: nothing is found, all estimates are NaN.
FreeFall find_free_fall(std::span<const TimedPlace> places, const FallOptions& options = {});

// sqrt(g / |a|); `gravity` in the places' unit of length per second squared.
Estimate frames_per_second(const FreeFall& fall, double gravity);

}  // namespace tumble::analysis
