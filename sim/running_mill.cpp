#include "sim/running_mill.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/error.h"
#include "core/parallel_for.h"
#include "sim/contact_forces.h"
#include "sim/near_search.h"
#include "sim/patches.h"

namespace tumble::sim {
void left_physics(const RunningMill& mill, const std::string& what) {
  throw WorkError("simulation",
                  fmt::format("step {}, time {:.6g} s: {}; take a smaller run.time_step (now {:.3g} s) or a larger "
                              "contact.normal_stiffness",
                              mill.step, double(mill.step) * mill.model.time_step, what, mill.model.time_step));
}

ChargeView view_of(RunningMill& mill) {
  Charge& c = mill.charge;
  return {c.x.data(),
          c.y.data(),
          c.angle.data(),
          c.vx.data(),
          c.vy.data(),
          c.spin.data(),
          c.ax.data(),
          c.ay.data(),
          c.alpha.data(),
          c.radius.data(),
          c.mass.data(),
          c.half_step_per_mass.data(),
          c.half_step_per_inertia.data(),
          c.end_x.data(),
          c.end_y.data(),
          mill.flights.apex.data()};
}

namespace {

// Forces of other shares on the balls of this patch, into the rows of its own share.
void take_over(RunningMill& mill, Share& share, const Patch& patch) {
  const auto at = [](Share& s, int ball) { return s.forces.data() + kRow * (ball & s.mask); };
  for (Share& other : mill.shares) {
    if (&other == &share) continue;
    for (int i = std::max(other.low, patch.first); i < std::min(other.high, patch.last); ++i) {
      double *own = at(share, i), *theirs = at(other, i);
      for (int k = 0; k < kRow; ++k) {
        own[k] += theirs[k];
        theirs[k] = 0;
      }
    }
  }
}

// Adds the time that it lives to `seconds`.
struct Stopwatch {
  using Clock = std::chrono::steady_clock;
  explicit Stopwatch(double& seconds) : seconds_(seconds), start_(Clock::now()) {}
  ~Stopwatch() { seconds_ += std::chrono::duration<double>(Clock::now() - start_).count(); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& seconds_;
  Clock::time_point start_;
};

// Adds what acts from outside to the rows of a patch that is about to be kicked. Rounded as contacts are, so that their
// order goes on to change no bit.
void push_from_outside(const RunningMill& mill, Share& share, const Patch& patch) {
  const MillModel& m = mill.model;
  const Charge& c = mill.charge;
  BallState ball;
  ball.time = double(mill.step) * m.time_step;
  ball.mill_angle = mill_angle(m, mill.step);
  ball.mill_speed = mill_speed(m, mill.step);
  for (int k = patch.first; k < patch.last; ++k) {
    const auto i = static_cast<std::size_t>(k);
    ball.x = c.x[i];
    ball.y = c.y[i];
    ball.vx = c.vx[i] + c.ax[i];
    ball.vy = c.vy[i] + c.ay[i];
    ball.spin = c.spin[i] + c.alpha[i];
    ball.radius = c.radius[i];
    ball.mass = c.mass[i];
    const OutsidePush p = mill.outside(ball);
    const double fx = mill.exact.force(p.fx), fy = mill.exact.force(p.fy), couple = mill.exact.moment(p.couple);
    double* row = share.forces.data() + kRow * (k & share.mask);
    row[0] += fx;
    row[1] += fy;
    row[2] += couple;
    (p.reacts_on_mill ? share.kick.ends_torque : share.kick.external) +=
        mill.exact.torque(ball.x * fy - ball.y * fx + couple);
  }
}

// One step of the balls between two searches. A patch is drifted when the first contacts ask for it and kicked when the
// last ones have been worked out, so that it goes through the cache once. Patches that contacts of several threads
// reach are drifted before all others and kicked after them, while one thread books what began and ended.
void step_balls(RunningMill& mill, const ChargeView& balls, const KickTerms& terms) {
  const double time_step = mill.model.time_step;
  const auto drift = [&](const Patch& p) { mill.kernels->drift(balls, time_step, p.first, p.last); };
  const auto kick = [&](Share& share, const Patch& p) {
    if (mill.outside) push_from_outside(mill, share, p);
    mill.kernels->kick(balls, terms, mill.exact, {share.forces.data(), share.mask}, p.first, p.last, share.kick);
  };
  const bool alone = mill.shares.size() == 1;
  if (!alone)
    for_patches(mill, [&](Patch& patch, Share&) {
      if (!patch.apart) drift(patch);
    });
  for_shares(mill, [&](Share& share) {
    const Stopwatch watch(share.seconds);
    share.at_balls = share.at_wall = {};
    share.kick = {};
    share.begun.clear();
    share.ended.clear();
    int drifted = share.first, kicked = share.first;
    for (int p = share.first; p < share.last; ++p) {
      Patch& patch = patch_at(mill, p);
      for (const int end = std::min(share.last, patch.high_patch + 1); drifted < end; ++drifted)
        if (patch_at(mill, drifted).apart) drift(patch_at(mill, drifted));
      contact_forces(mill, balls, patch, share);
      for (; kicked < patch.done_before; ++kicked)
        if (patch_at(mill, kicked).apart) kick(share, patch_at(mill, kicked));
    }
  });
  if (alone) return book_events(mill);
  parallel_for(mill.shares.size() + 1, 1, [&](std::size_t task, std::size_t) {
    if (task == 0) return book_events(mill);
    Share& share = mill.shares[task - 1];
    for (int p = share.first; p < share.last; ++p) {
      if (patch_at(mill, p).apart) continue;
      take_over(mill, share, patch_at(mill, p));
      kick(share, patch_at(mill, p));
    }
  });
}

void turn_lifters(RunningMill& mill) {
  const ShellPose pose = pose_of(mill_angle(mill.model, mill.step));
  const std::vector<Feature>& features = mill.model.shell.features;
  for (std::size_t f = 0; f < features.size(); ++f) {
    const Direction d = direction_of(features[f], pose);
    mill.lifter_cos[f] = d.cos;
    mill.lifter_sin[f] = d.sin;
  }
  mill.runs = lifter_runs(mill.model.shell);
  mill.runs.cos = mill.lifters.cos = mill.lifter_cos.data();
  mill.runs.sin = mill.lifters.sin = mill.lifter_sin.data();
}

KickTerms kick_terms(const RunningMill& mill) {
  const MillModel& m = mill.model;
  KickTerms terms{.body = &m.body, .time_step = m.time_step, .gravity = m.gravity};
  if (m.body.on()) {
    const ShellPose pose = pose_of(mill_angle(m, mill.step));
    terms.cos = pose.cos;
    terms.sin = pose.sin;
    terms.speed_before = mill_speed_before(m, mill.step);
  }
  return terms;
}

[[noreturn]] void not_a_number(const RunningMill& mill) {
  const Charge& c = mill.charge;
  for (std::size_t i = 0; i < c.size(); ++i)
    if (!std::isfinite(c.x[i] + c.vx[i] + c.vy[i]))
      left_physics(mill, fmt::format("the motion of ball {} is not a number", c.id[i]));
  left_physics(mill, "the motion of the charge is not a number");
}

// The shares' sums into the ledger. One addition a step for each account, so that nothing hangs on the shares.
void book(RunningMill& mill) {
  ContactSums balls, wall;
  KickSums kick;
  for (const Share& s : mill.shares) {
    balls.add(s.at_balls);
    wall.add(s.at_wall);
    kick.add(s.kick);
  }
  if (!kick.finite) not_a_number(mill);
  mill.fastest = std::sqrt(kick.fastest2);
  Ledger& l = mill.ledger;
  const auto lose = [&](Cause cause, double energy) { l.dissipated[static_cast<std::size_t>(cause)] += energy; };
  lose(Cause::kBallBallNormal, balls.normal_loss);
  lose(Cause::kBallBallSliding, balls.sliding_loss);
  lose(Cause::kBallWallNormal, wall.normal_loss);
  lose(Cause::kBallWallSliding, wall.sliding_loss);
  lose(Cause::kRolling, balls.rolling_loss + wall.rolling_loss);
  lose(Cause::kFluidDrag, kick.drag_loss);
  lose(Cause::kSlurryPool, kick.pool_loss);
  lose(Cause::kEndWalls, kick.ends_loss);
  const double torque = wall.torque + kick.ends_torque;
  l.torque += torque;
  l.torque_shear += wall.torque_shear;
  l.torque_external += kick.external;
  l.drive_work += torque * mill_speed(mill.model, mill.step) * mill.model.time_step;
  l.mass_moment += kick.mass_moment;
  ++l.steps;
}

}  // namespace

double shell_speed(const MillModel& m) { return std::abs(m.speed) * (1 + m.ripple.amplitude) * m.shell.radius; }

int threads_for(std::size_t balls) {
  constexpr std::size_t kBallsPerThread = 4000;
  return static_cast<int>(
      std::clamp<std::size_t>(balls / kBallsPerThread, 1, static_cast<std::size_t>(thread_limit())));
}

ExactSums exact_sums(const MillModel& model, const Charge& charge) {
  const double radius = *std::max_element(charge.radius.begin(), charge.radius.end());
  const double heaviest = *std::max_element(charge.mass.begin(), charge.mass.end());
  const double mass = std::accumulate(charge.mass.begin(), charge.mass.end(), 0.0);
  const double stiffness = std::max(model.ball.springs.normal_stiffness, model.wall.springs.normal_stiffness);
  // More than bodies can press that overlap by half a radius; far more than the heaviest blow and all the weight.
  const double fall = 2 * std::abs(model.gravity) * 2 * model.shell.radius;
  const double fast = shell_speed(model) + std::sqrt(fall);
  const double heavy = fast * std::sqrt(stiffness * heaviest) + mass * std::abs(model.gravity) +
                       std::abs(model.ball.cohesion.per_radius) * radius;
  const double force = fast > 0 ? std::min(8 * stiffness * radius, 64 * heavy) : 8 * stiffness * radius;
  const double many = std::max(1.0, double(charge.size()) / 256);
  const double pressed = stiffness * radius * radius / 4 * many, moving = 64 * mass * fast * fast;
  const double energy = fast > 0 ? std::min(pressed, moving) : pressed;
  ExactSums sums;
  sums.force = exact_up_to(force);
  sums.moment = exact_up_to(force * radius);
  sums.torque = exact_up_to(force * model.shell.radius);
  sums.loss = exact_up_to(energy);
  sums.energy = exact_up_to(energy + mass * fall);
  sums.mass_moment = exact_up_to(mass * model.shell.radius);
  return sums;
}

std::vector<Contact> contacts_of(const RunningMill& mill, Kind kind) {
  std::vector<Contact> contacts;
  for_contacts(mill, kind, [&](const Contact& c) { contacts.push_back(c); });
  return contacts;
}

RunningMill start_mill(const MillModel& model, Charge charge, int threads, int balls_per_patch) {
  RunningMill mill;
  mill.model = model;
  mill.damping = {Damping(model.ball.springs, model.time_step), Damping(model.wall.springs, model.time_step)};
  mill.exact = exact_sums(model, charge);
  mill.charge = std::move(charge);
  mill.kernels = &best_kernels();
  mill.lifters = convex_lifters(model.shell);
  mill.lifter_cos.resize(model.shell.features.size());
  mill.lifter_sin.resize(model.shell.features.size());
  Charge& c = mill.charge;
  c.half_step_per_mass.clear();
  c.half_step_per_inertia.clear();
  // Half a step of gravity brings the velocities to their place in the leapfrog.
  const double half_fall = 0.5 * model.gravity * model.time_step;
  for (std::size_t i = 0; i < c.size(); ++i) {
    c.half_step_per_mass.push_back(0.5 * model.time_step / c.mass[i]);
    c.half_step_per_inertia.push_back(0.5 * model.time_step / inertia(c.mass[i], c.radius[i]));
    c.ax[i] = 0;
    c.ay[i] = -half_fall;
    c.alpha[i] = 0;
    c.vy[i] -= half_fall;
    mill.fastest = std::max(mill.fastest, std::hypot(c.vx[i], c.vy[i]));
  }
  mill.mean_radius = std::accumulate(c.radius.begin(), c.radius.end(), 0.0) / static_cast<double>(c.size());
  mill.smallest_radius = *std::min_element(c.radius.begin(), c.radius.end());
  mill.flights.contacts.assign(c.size(), 0);
  mill.flights.apex = c.y;
  const auto lifters = static_cast<std::size_t>(model.shell.lifter_count);
  mill.ledger.impacts.lifter_number.assign(lifters, 0);
  mill.ledger.impacts.lifter_energy.assign(lifters, 0);
  cut_up(mill, threads, balls_per_patch);
  return mill;
}

void advance(RunningMill& mill) {
  const MillModel& m = mill.model;
  if (mill.stale) search_near(mill, false);
  ++mill.step;
  const ChargeView balls = view_of(mill);
  const double shell = shell_speed(m) * m.time_step;
  mill.moved += std::max(mill.fastest * m.time_step, shell);
  const KickTerms terms = kick_terms(mill);

  turn_lifters(mill);
  step_balls(mill, balls, terms);
  book(mill);

  const double next = std::max(mill.fastest * m.time_step, shell);
  if (2 * (mill.moved + next) > 0.999999 * mill.skin) search_near(mill, true);
}

Energies energies_of(const RunningMill& mill) {
  const Charge& c = mill.charge;
  const ExactSum& exact = mill.exact.energy;
  const BodyEffects& body = mill.model.body;
  Energies e;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const double vx = c.vx[i] - c.ax[i], vy = c.vy[i] - c.ay[i], w = c.spin[i] - c.alpha[i];
    e.kinetic += exact(0.5 * c.mass[i] * (vx * vx + vy * vy) + 0.5 * inertia(c.mass[i], c.radius[i]) * w * w);
    e.potential += exact(c.mass[i] * mill.model.gravity * c.y[i]);
    if (body.pool.on()) e.potential += exact(body.pool.potential(c.y[i], c.radius[i]));
    if (body.ends.on())
      e.elastic += exact(0.5 * body.ends.stiffness * (c.end_x[i] * c.end_x[i] + c.end_y[i] * c.end_y[i]));
  }
  for (const Kind kind : {Kind::kBalls, Kind::kPlate, Kind::kLifters}) {
    const ContactModel& law = kind == Kind::kBalls ? mill.model.ball : mill.model.wall;
    for (const Patch& patch : mill.patches) {
      const ContactTable& table = patch.touching[static_cast<std::size_t>(kind)];
      for (int k = 0; k < table.size(); ++k) {
        const Contact contact = contact_at(table, k);
        const double ri = c.radius[contact.i], rj = kind == Kind::kBalls ? c.radius[contact.j] : 0;
        const double effective_radius = kind == Kind::kBalls ? ri * rj / (ri + rj) : ri;
        e.elastic += exact(mill.model.plain() ? elastic_energy(law.springs, contact.state)
                                              : elastic_energy(law, effective_radius, contact.state, contact.terms));
      }
    }
  }
  return e;
}

}  // namespace tumble::sim
