#pragma once
#include <string>
#include <vector>

#include "core/statistics.h"

// Which rate a film was recorded at, from witnesses of unequal worth: what the user says, balls in flight, the file,
// and the mill's nominal speed.
namespace tumble::analysis {

struct TimeWitnesses {             // NaN: silent
  double told_rate = kNotGiven;    // by --recorded-fps [1/s]
  double file_rate = kNotGiven;    // of the film file [1/s]
  Estimate falling_rate;           // by balls in flight (ballistics.h) [1/s]
  double scale_error = 0.01;       // relative error of the metres per pixel behind it
  Estimate turn_per_frame;         // of the drum [rad a recorded frame], > 0
  double nominal_rpm = kNotGiven;  // by MILL.toml [rev/min]
};

struct TimeBase {
  Estimate frames_per_second;        // NaN where nobody knows
  std::vector<std::string> caveats;  // in plain words, where witnesses contradict each other or only a poor one spoke
};

// What is told is believed. Otherwise the file, unless balls in flight contradict it: cameras are good clocks, but slow
// motion is written with the rate it is to be played at. Against the file, flights and nominal speed are put together
// where they agree, and taken as a rate that cameras have where just one is near.
TimeBase judge_time_base(const TimeWitnesses& witnesses);

}  // namespace tumble::analysis
