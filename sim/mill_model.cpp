#include "sim/mill_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/units.h"

namespace tumble::sim {
namespace {

// Steps per shortest impact that the automatic time step gives: 20 keep the restitution within 0.008 for any phase of
// an impact within a step, and within 0.003 in the mean (tests/physics/restitution_test.cpp).
constexpr double kStepsPerContact = 20;
constexpr double kMostStepsPerFrame = 1e9;  // more would take weeks; it is a slip of the pen

LinearSpringDashpot law_of(const Contact& contact) {
  return {contact.normal_stiffness, contact.tangential_stiffness, contact.friction, contact.restitution};
}

}  // namespace

double contact_time(const LinearSpringDashpot& law, double effective_mass) {
  return kPi * std::sqrt(effective_mass / law.normal_stiffness);
}

// Central differences are stable for dt < (2 / w) (sqrt(1 + z^2) - z), w the highest natural frequency and z its
// damping ratio (Belytschko 1983). A pair has w^2 = k_n / m along the normal and, as spheres turn about the contact
// too, 3.5 k_t / m across it. In a packed charge each ball hangs on several springs at once: half of the pair's limit.
double largest_time_step(const LinearSpringDashpot& law, double effective_mass) {
  const double z = damping_ratio(law.restitution);
  const double stiffness = std::max(law.normal_stiffness, 3.5 * law.tangential_stiffness);
  return std::sqrt(effective_mass / stiffness) * (std::sqrt(1 + z * z) - z);
}

MillModel make_mill_model(const Config& config) {
  MillModel model;
  model.shell = make_shell(make_mill_shape(config.mill));
  model.ball = law_of(ball_contact(config));
  model.wall = law_of(wall_contact(config));
  model.speed = rad_s_from_rpm(speed_rpm(config.mill));
  model.gravity = kGravity;
  if (!(model.speed > 0))
    throw InputError(place_of(config, std::isnan(config.mill.speed) ? "mill.speed_rpm" : "mill.speed"),
                     "the mill stands still; revolutions can be simulated only at a speed above 0");

  double lightest = INFINITY;
  const std::vector<int> counts = class_counts(config);
  for (std::size_t c = 0; c < counts.size(); ++c)
    if (counts[c] > 0) lightest = std::min(lightest, config.charge.balls[c].mass);
  const double limit = std::min(largest_time_step(model.ball, lightest / 2), largest_time_step(model.wall, lightest));
  double step = config.run.time_step;
  if (std::isnan(step)) {
    step = std::min(contact_time(model.ball, lightest / 2), contact_time(model.wall, lightest)) / kStepsPerContact;
    step = std::min(step, limit / 2);
  } else if (!(step <= limit)) {
    throw InputError(
        place_of(config, "run.time_step"),
        fmt::format("{:g} s is not stable for these balls and springs; at most {:.3g} s, or \"auto\"", step, limit));
  }
  // Frames come at even times: the step is made to divide their interval, never longer than asked for.
  const double interval = 1 / config.run.frames_per_second;
  const double steps = std::ceil(interval / step * (1 - 1e-9));
  if (!(steps <= kMostStepsPerFrame))
    throw InputError(place_of(config, "run.time_step"),
                     fmt::format("{:g} s makes {:.2g} steps from frame to frame; at most {:.0g}, or \"auto\"", step,
                                 steps, kMostStepsPerFrame));
  model.steps_per_frame = std::max(1, static_cast<int>(steps));
  model.time_step = interval / model.steps_per_frame;
  return model;
}

}  // namespace tumble::sim
