#pragma once
#include <cstdint>

#include "core/config.h"
#include "core/mill_shape.h"
#include "sim/body_effects.h"
#include "sim/effects/speed_ripple.h"
#include "sim/laws/contact_model.h"
#include "sim/ledger.h"
#include "sim/shell.h"

// What stays the same during a run, derived from the config once.
namespace tumble::sim {

struct MillModel {
  Shell shell;
  ContactModel ball;  // ball on ball
  ContactModel wall;  // ball on shell or lifter
  BodyEffects body;
  SpeedRipple ripple;
  double speed = 0;         // Omega, the mean over a revolution, counter-clockwise > 0 [rad/s]
  double time_step = 0;     // dt [s]
  double gravity = 0;       // g, downwards [m/s2]
  int steps_per_frame = 1;  // the time step divides the frame interval

  // Contacts follow the plain law alone, and nobody asks for what presses on a ball.
  bool plain() const { return ball.plain() && wall.plain() && body.ends.pressure == 0; }
};

// Expects a complete config. Throws InputError for a time step that is not stable.
MillModel make_mill_model(const Config& config);

// The causes by which this model can lose energy.
std::vector<Cause> causes_of(const MillModel& model);

// The mill's angle at a step, computed afresh: an angle that is summed up drifts, and walls that are moved step by step
// come out of shape (1992 paper, p. 600).
inline double mill_angle(const MillModel& model, std::int64_t step) {
  return model.ripple.angle(model.speed * (static_cast<double>(step) * model.time_step));
}
inline double mill_speed(const MillModel& model, std::int64_t step) {
  return model.speed * model.ripple.share(model.speed * (static_cast<double>(step) * model.time_step));
}
// In the middle of the step that led there, where the balls' velocities are: what slides or rolls on a wall whose speed
// varies would err in the first order of the time step by that at its end.
inline double mill_speed_before(const MillModel& model, std::int64_t step) {
  return model.speed * model.ripple.share(model.speed * ((static_cast<double>(step) - 0.5) * model.time_step));
}

// Largest time step that is let through for these contacts and this lightest pair [s].
double largest_time_step(const LinearSpringDashpot& law, double effective_mass);

// Duration of an undamped impact, pi sqrt(m / k_n) [s].
double contact_time(const LinearSpringDashpot& law, double effective_mass);

}  // namespace tumble::sim
