#pragma once
#include <cstdint>
#include <filesystem>

#include "core/experiments.h"
#include "core/progress.h"
#include "trials/conditions.h"
#include "trials/instruments.h"

// One trial from its key to its folder: simulated, seen through the instruments of the day, written as a laboratory
// would hand it out.
namespace tumble::trials {

struct LabPlan {
  Config mill;  // as handed out, run plan included: revolutions and frames per second are the camera's
  std::vector<Condition> conditions;
  std::vector<UncertainKey> uncertain;
  TrackingErrors tracking;
  // Of the sensor, in shares of M g R of the mill that is handed out: a reading's noise, and one standard deviation of
  // what is wrong with all of its readings alike.
  double torque_noise = 0.005, torque_error = 0.001;
  double angle_error_deg = 1;     // of a toe and a shoulder that are read off
  int width = 720, height = 720;  // of films [px]
};

// Writes `folder`, which must not be there, beside its name first. All of its files bear the same, meaningless time.
void write_trial(const LabPlan& plan, const TrialKey& key, const std::filesystem::path& folder,
                 const Progress& progress);

}  // namespace tumble::trials
