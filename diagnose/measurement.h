#pragma once
#include <string>
#include <vector>

#include "core/charge_motion.h"
#include "core/config.h"
#include "core/experiments.h"
#include "diagnose/observation.h"

// What one experiment brought, read and checked, ready to be compared with simulations.
namespace tumble::diagnose {

struct SeenFrame {                // balls seen at one moment, by number
  double time = 0;                // [s], grows
  double mill_angle = kNotGiven;  // [rad], unwrapped; NaN where nothing tells it
  std::vector<Sighting> balls;
};

struct TorqueSample {
  double time = 0;    // [s]
  double torque = 0;  // [N m] of one slice
};

struct Measurement {
  Experiment experiment;          // name, place, hold_out, numbers (filled in from the files where those bring them)
  Config config;                  // the mill as MILL.toml and the experiment's `set` have it
  std::vector<SeenFrame> frames;  // of film, tracks or motion file, without repeated pictures; empty without
  std::string frames_file;        // where they come from, for messages
  bool is_film = false;           // frames were found in pictures: see motion
  ChargeMotion motion;            // of film, tracks or motion file; of the first also circle, rates, repeats
  std::vector<TorqueSample> torque_series;  // empty without
  Estimate torque;                          // mean, of one slice [N m], however it was measured; NaN without
  double torque_error = 0;                  // of that, what the instrument is said to err by; 0 where it is not said
  double revolutions = 0;                   // of the mill that frames or, without, the torque series cover; 0 without
};

}  // namespace tumble::diagnose
