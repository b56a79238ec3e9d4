#pragma once
#include <cstdint>

#include "core/config.h"
#include "core/mill_shape.h"
#include "sim/laws/linear_spring_dashpot.h"
#include "sim/shell.h"

// What stays the same during a run, derived from the config once.
namespace tumble::sim {

struct MillModel {
  Shell shell;
  LinearSpringDashpot ball;  // ball on ball
  LinearSpringDashpot wall;  // ball on shell or lifter
  double speed = 0;          // Omega, counter-clockwise > 0 [rad/s]
  double time_step = 0;      // dt [s]
  double gravity = 0;        // g, downwards [m/s2]
  int steps_per_frame = 1;   // the time step divides the frame interval
};

// Expects a complete config. Throws InputError for a time step that is not stable.
MillModel make_mill_model(const Config& config);

// The mill's angle at a step, computed afresh: an angle that is summed up drifts, and walls that are moved step by step
// come out of shape (1992 paper, p. 600).
inline double mill_angle(const MillModel& model, std::int64_t step) {
  return model.speed * (static_cast<double>(step) * model.time_step);
}

// Largest time step that is let through for these contacts and this lightest pair [s].
double largest_time_step(const LinearSpringDashpot& law, double effective_mass);

// Duration of an undamped impact, pi sqrt(m / k_n) [s].
double contact_time(const LinearSpringDashpot& law, double effective_mass);

}  // namespace tumble::sim
