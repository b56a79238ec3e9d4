#include "sim/mill_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/effects.h"
#include "core/error.h"
#include "core/units.h"
#include "sim/charge.h"
#include "sim/effects/tabulated_friction.h"
#include "sim/effects/tabulated_restitution.h"
#include "sim/effects/wall_friction.h"

namespace tumble::sim {
namespace {

// Steps per shortest impact that the automatic time step gives: 20 keep the restitution within 0.008 for any phase of
// an impact within a step, and within 0.003 in the mean (tests/physics/restitution_test.cpp).
constexpr double kStepsPerContact = 20;
constexpr double kMostStepsPerFrame = 1e9;  // more would take weeks; it is a slip of the pen

struct Mean {
  double radius = 0, mass = 0;  // of the balls, by number
};

Mean mean_ball(const Config& config, const std::vector<int>& counts) {
  Mean mean;
  int balls = 0;
  for (std::size_t c = 0; c < counts.size(); ++c) {
    mean.radius += counts[c] * config.charge.balls[c].radius;
    mean.mass += counts[c] * config.charge.balls[c].mass;
    balls += counts[c];
  }
  return {mean.radius / balls, mean.mass / balls};
}

ContactModel model_of(const Config& config, bool at_wall, const Mean& mean) {
  const Contact contact = at_wall ? wall_contact(config) : ball_contact(config);
  const double friction = at_wall ? friction_at_wall(config, contact.friction) : contact.friction;
  ContactModel m;
  m.springs = {contact.normal_stiffness, contact.tangential_stiffness, friction, contact.restitution};
  m.hertz = make_hertz_contact(config, contact.normal_stiffness, mean.radius, mean.mass);
  m.restitution = make_impact_restitution(config);
  m.cohesion = make_cohesion(config, mean.radius);
  m.friction = make_friction_weakening(config);
  m.rolling = make_rolling_resistance(config);
  m.tabulated_friction = make_tabulated_friction(config, at_wall);
  m.tabulated_restitution = make_tabulated_restitution(config, at_wall);
  return m;
}

// The springs as stiff and as damped as they can become in this mill: what the time step must follow. A Hertzian
// contact is stiffest where the heaviest ball comes in fastest.
LinearSpringDashpot stiffest(const ContactModel& model, const Config& config, double fastest) {
  LinearSpringDashpot s = model.springs;
  if (model.tabulated_restitution.on()) s.restitution = model.tabulated_restitution.least();
  s.restitution *= 1 - model.restitution.drop;
  if (model.hertz.share == 0) return s;
  double largest = 0, heaviest = 0;
  for (const BallClass& b : config.charge.balls) {
    largest = std::max(largest, b.radius);
    heaviest = std::max(heaviest, b.mass);
  }
  const double hertz = model.hertz.stiffness * std::sqrt(largest);  // F = hertz d^(3/2)
  const double overlap = std::pow(1.25 * heaviest * fastest * fastest / hertz, 0.4);
  const double at_most = 1.5 * hertz * std::sqrt(overlap);
  s.normal_stiffness += model.hertz.share * std::max(0.0, at_most - s.normal_stiffness);
  return s;
}

// A drag force taken at the beginning of a step is stable for far longer steps than this, but no longer accurate.
double largest_time_step(const BodyEffects& body, const BallClass& ball, double fastest) {
  double per_mass = 0;
  for (const FluidDrag& fluid : {body.drag, body.pool.slurry})
    per_mass += std::max(fluid.per_velocity(ball.radius, fastest) / ball.mass,
                         fluid.per_spin(ball.radius) / inertia(ball.mass, ball.radius));
  if (body.tabulated.on())
    per_mass += body.tabulated.share_of(ball.radius) * body.tabulated.coefficient.most() / ball.mass;
  return 0.1 / per_mass;
}

void need_tangential_spring(const Config& config, const Contact& wall) {
  const bool ball_rolls = has_effect(config, "rolling_resistance");
  for (const char* name : {"rolling_resistance", "end_wall_friction"})
    if (has_effect(config, name) &&
        !(wall.tangential_stiffness > 0 && (config.contact.tangential_stiffness > 0 || !ball_rolls)))
      throw InputError(place_of(config, std::string("effects.") + name),
                       "its spring follows contact.tangential_stiffness, which is 0; give a stiffness above 0");
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
  const Contact wall = wall_contact(config);
  const std::vector<int> counts = class_counts(config);
  const Mean mean = mean_ball(config, counts);
  need_tangential_spring(config, wall);

  MillModel model;
  model.shell = make_shell(make_mill_shape(config));
  model.ball = model_of(config, false, mean);
  model.wall = model_of(config, true, mean);
  model.gravity = kGravity;
  model.body = {make_fluid_drag(config), make_slurry_pool(config, kGravity),
                make_end_wall_friction(config, wall.tangential_stiffness), make_tabulated_drag(config, mean.radius)};
  model.ripple = make_speed_ripple(config);
  model.speed = rad_s_from_rpm(speed_rpm(config.mill));
  if (!(model.speed > 0))
    throw InputError(place_of(config, std::isnan(config.mill.speed) ? "mill.speed_rpm" : "mill.speed"),
                     "the mill stands still; revolutions can be simulated only at a speed above 0");

  double lightest = INFINITY, limit = INFINITY;
  // By falling through the mill and being met by the shell.
  const double radius = config.mill.diameter / 2, fastest = 2 * std::sqrt(kGravity * radius) + model.speed * radius;
  for (std::size_t c = 0; c < counts.size(); ++c) {
    if (counts[c] == 0) continue;
    lightest = std::min(lightest, config.charge.balls[c].mass);
    limit = std::min(limit, largest_time_step(model.body, config.charge.balls[c], fastest));
  }
  const LinearSpringDashpot between_balls = stiffest(model.ball, config, fastest),
                            at_wall = stiffest(model.wall, config, fastest);
  limit = std::min({limit, largest_time_step(between_balls, lightest / 2), largest_time_step(at_wall, lightest)});
  double step = config.run.time_step;
  if (std::isnan(step)) {
    step = std::min(contact_time(between_balls, lightest / 2), contact_time(at_wall, lightest)) / kStepsPerContact;
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

std::vector<Cause> causes_of(const MillModel& model) {
  std::vector<Cause> causes;
  for (std::size_t c = 0; c < kPlainCauses; ++c) causes.push_back(static_cast<Cause>(c));
  if (model.ball.rolling.coefficient != 0) causes.push_back(Cause::kRolling);
  if (model.body.dragged()) causes.push_back(Cause::kFluidDrag);
  if (model.body.pool.on()) causes.push_back(Cause::kSlurryPool);
  if (model.body.ends.on()) causes.push_back(Cause::kEndWalls);
  return causes;
}

}  // namespace tumble::sim
