#pragma once
#include <numeric>
#include <set>

#include "sim/packing.h"
#include "sim/running_mill.h"
#include "tests/fuzz/random_mill.h"

// A mill that turns for a while, watched from outside: nothing is taken from the near lists that are watched.
namespace tumble::fuzz {

// What went wrong first; `kind` is empty where nothing did.
struct Outcome {
  std::string kind, what;
  double energy_error = 0;                    // of the energies that flowed
  double momentum_error = 0;                  // of the angular momentum that flowed
  double worst_loss = 0;                      // the most negative loss by any cause, of the energies that flowed
  double deepest_wall = 0, deepest_ball = 0;  // overlap, in radii
  double ball_steps = 0;
};

// 99 of 100 mills keep their energy to 1e-4. What the worst miss (2e-3: a heavy ball that whirls over the crests of a
// wave at 1.5 of critical) is of the first order in how far a contact's tangent turns within a step.
inline constexpr double kEnergyTolerance = 3e-3;
inline constexpr double kLeastFlow = 0.04;          // of m g R, counted as having flowed where next to nothing moves
inline constexpr double kMomentumTolerance = 1e-9;  // nothing but rounding: 1e-10 at worst, with 10^6 steps
inline constexpr double kDeepest = 0.3;             // radii; draw_contact aims at 0.1

struct Finding {
  std::string kind, what;
};

inline sim::Charge start_of(const Case& c, const sim::MillModel& model) {
  sim::Charge charge = sim::place_loosely(c.config, model, sim::draw_balls(c.config));
  if (c.start == Start::kSettled) return sim::settle(model, std::move(charge), {});
  if (c.start == Start::kLoose) return charge;
  Random random(c.config.run.seed);
  const double fast = std::sqrt(2 * kGravity * c.config.mill.diameter / 2);
  for (std::size_t i = 0; i < charge.size(); ++i) {
    const double speed = fast * std::sqrt(random.uniform()), angle = random.uniform(0, 2 * kPi);
    charge.vx[i] = speed * std::cos(angle);
    charge.vy[i] = speed * std::sin(angle);
    charge.spin[i] = speed / charge.radius[i] * random.uniform(-1, 1);
  }
  return charge;
}

// Of all contacts that there are at this moment, is one missing in the lists, or too deep?
inline void look_at_contacts(const sim::RunningMill& mill, Outcome& seen) {
  const sim::Charge& c = mill.charge;
  const sim::Shell& shell = mill.model.shell;
  const auto touching = [&](std::initializer_list<sim::Kind> kinds) {
    std::set<std::pair<int, int>> pairs;
    for (const sim::Kind kind : kinds)
      for (const sim::Contact& k : sim::contacts_of(mill, kind)) pairs.emplace(k.i, k.j);
    return pairs;
  };
  const auto balls = touching({sim::Kind::kBalls}), walls = touching({sim::Kind::kPlate, sim::Kind::kLifters});
  const double angle = sim::mill_angle(mill.model, mill.step);
  const sim::ShellPose pose = sim::pose_of(angle);
  const auto at = [&](std::size_t i) {
    return "step " + std::to_string(mill.step) + ", ball " + std::to_string(i) + " at " + std::to_string(c.x[i]) +
           ", " + std::to_string(c.y[i]);
  };
  for (std::size_t i = 0; i < c.size(); ++i) {
    if (!std::isfinite(c.x[i] + c.y[i] + c.vx[i] + c.vy[i] + c.spin[i] + c.angle[i])) throw Finding{"nan", at(i)};
    const double u = c.x[i] * pose.cos + c.y[i] * pose.sin, v = c.y[i] * pose.cos - c.x[i] * pose.sin;
    if (std::hypot(u, v) >= shell.radius) throw Finding{"outside", at(i)};
    if (sim::lifter_around(shell, u, v) >= 0) throw Finding{"in_steel", at(i)};
    for (int f = 0; f < sim::feature_count(shell); ++f) {
      const double overlap = c.radius[i] - sim::nearest_on_wall(shell, pose, f, c.x[i], c.y[i]).distance;
      if (overlap <= 0) continue;
      seen.deepest_wall = std::max(seen.deepest_wall, overlap / c.radius[i]);
      if (!walls.contains({static_cast<int>(i), f}))
        throw Finding{"missed_wall", at(i) + " overlaps feature " + std::to_string(f) + " unseen"};
    }
    for (std::size_t j = i + 1; j < c.size(); ++j) {
      const double overlap = c.radius[i] + c.radius[j] - std::hypot(c.x[j] - c.x[i], c.y[j] - c.y[i]);
      if (overlap <= 1e-12 * c.radius[i]) continue;
      seen.deepest_ball = std::max(seen.deepest_ball, overlap / std::min(c.radius[i], c.radius[j]));
      if (!balls.contains({static_cast<int>(i), static_cast<int>(j)}))
        throw Finding{"missed_ball", at(i) + " overlaps ball " + std::to_string(j) + " unseen"};
    }
    if (seen.deepest_wall > kDeepest || seen.deepest_ball > kDeepest)
      throw Finding{"deep", at(i) + ": " + std::to_string(seen.deepest_wall) + " radii in the wall, " +
                                std::to_string(seen.deepest_ball) + " in a ball"};
  }
}

// About the axis, where the leapfrog keeps it to the last digit: positions with the velocities half a step later.
inline double angular_momentum(const sim::Charge& c) {
  double l = 0;
  for (std::size_t i = 0; i < c.size(); ++i)
    l += c.mass[i] * (c.x[i] * c.vy[i] - c.y[i] * c.vx[i]) + sim::inertia(c.mass[i], c.radius[i]) * c.spin[i];
  return l;
}

// The accounts at a step's own time, as the leapfrog keeps them. Work and fluid losses are summed over whole steps that
// reach half a step further: half of the last one is taken back. The kinetic energy that belongs to them is the product
// of the velocities half a step before and after; their mean's square, which a frame shows, is more by up to
// (w dt)^2 / 8 of what is in a contact at that moment.
struct Accounts {
  double work = 0, gained = 0;              // [J], angular momentum [N m s]
  std::array<double, sim::kCauses> lost{};  // [J]
  sim::Energies energy;
};

inline Accounts advance_and_count(sim::RunningMill& mill) {
  const sim::Ledger before = mill.ledger;
  sim::advance(mill);
  const sim::Ledger& now = mill.ledger;
  Accounts a;
  a.work = (before.drive_work + now.drive_work) / 2;
  a.lost = now.dissipated;
  for (const sim::Cause fluid : {sim::Cause::kFluidDrag, sim::Cause::kSlurryPool}) {
    const auto k = static_cast<std::size_t>(fluid);
    a.lost[k] = (before.dissipated[k] + now.dissipated[k]) / 2;
  }
  a.gained = mill.model.time_step * (now.torque + now.torque_external - mill.model.gravity * now.mass_moment);
  a.energy = sim::energies_of(mill);
  const sim::Charge& c = mill.charge;
  for (std::size_t i = 0; i < c.size(); ++i)
    a.energy.kinetic -= 0.5 * c.mass[i] * (c.ax[i] * c.ax[i] + c.ay[i] * c.ay[i]) +
                        0.5 * sim::inertia(c.mass[i], c.radius[i]) * c.alpha[i] * c.alpha[i];
  return a;
}

inline void turn(sim::RunningMill& mill, Outcome& seen) {
  const auto steps = static_cast<std::int64_t>(std::ceil(kSeconds / mill.model.time_step));
  const std::int64_t every = std::max<std::int64_t>(1, steps / 40);
  // The shell goes from rest to full speed at once: what it is in touch with gets a blow that takes less than a step,
  // and energies can tell of it only when it is over.
  for (int k = 0; k < 4; ++k) sim::advance(mill);
  const Accounts first = advance_and_count(mill);
  const double momentum = angular_momentum(mill.charge);
  const double mass = std::accumulate(mill.charge.mass.begin(), mill.charge.mass.end(), 0.0);
  const double weight_moment = mass * mill.model.gravity * mill.model.shell.radius;
  double most_kinetic = std::abs(first.energy.kinetic), most_elastic = std::abs(first.energy.elastic);  // < 0: cohesion
  double most_momentum = std::abs(momentum);
  Accounts last = first;
  for (std::int64_t s = 1; s <= steps; ++s) {
    if (s % every != 0 && s != steps) {
      sim::advance(mill);
      continue;
    }
    last = advance_and_count(mill);
    look_at_contacts(mill, seen);
    most_kinetic = std::max(most_kinetic, std::abs(last.energy.kinetic));
    most_elastic = std::max(most_elastic, std::abs(last.energy.elastic));
    const double now = angular_momentum(mill.charge), time = double(s) * mill.model.time_step;
    most_momentum = std::max({most_momentum, std::abs(now), std::abs(last.gained), time * weight_moment});
    seen.momentum_error =
        std::max(seen.momentum_error, std::abs(now - momentum - (last.gained - first.gained)) / most_momentum);
  }

  const double work = last.work - first.work;
  double lost = 0, flowed = std::abs(work) + most_kinetic + most_elastic + kLeastFlow * weight_moment;
  for (std::size_t k = 0; k < sim::kCauses; ++k) {
    lost += last.lost[k] - first.lost[k];
    flowed += std::abs(last.lost[k] - first.lost[k]);
  }
  const auto all = [](const sim::Energies& e) { return e.kinetic + e.potential + e.elastic; };
  const double change = all(last.energy) - all(first.energy);
  if (!std::isfinite(work + change + lost)) throw Finding{"nan", "work, energies or losses"};
  seen.energy_error = std::abs(work - change - lost) / flowed;
  for (std::size_t k = 0; k < sim::kCauses; ++k)
    seen.worst_loss = std::min(seen.worst_loss, (last.lost[k] - first.lost[k]) / flowed);
  const auto number = [](double v) {
    char text[40];
    std::snprintf(text, sizeof text, "%.4g", v);
    return std::string(text);
  };
  if (seen.energy_error > kEnergyTolerance)
    throw Finding{"energy", "work " + number(work) + " J, energies changed by " + number(change) + " J, lost " +
                                number(lost) + " J: missing " + number(seen.energy_error) + " of what flowed"};
  if (seen.worst_loss < -kEnergyTolerance)
    throw Finding{"gain", "a loss is negative by " + number(-seen.worst_loss) + " of what flowed"};
  if (seen.momentum_error > kMomentumTolerance)
    throw Finding{"momentum", "angular momentum is off by " + number(seen.momentum_error)};
}

// Do the balls take so much of the room inside the lifter tips that they may really not fit? Nothing less than an
// attempt to pack them can tell, and so this is the one complaint that comes after the checks.
inline bool crowded(const Config& config) {
  double area = 0, largest = 0;
  for (const double r : sim::draw_balls(config).radius) {
    area += kPi * r * r;
    largest = std::max(largest, r);
  }
  const double tip = sim::make_mill_model(config).shell.tip_radius;
  return area > 0.5 * kPi * tip * tip || largest > 0.3 * tip;
}

// Expects a config that check_complete and make_mill_model let through.
inline Outcome run(const Case& c) {
  Outcome seen;
  try {
    const sim::MillModel model = sim::make_mill_model(c.config);
    sim::RunningMill mill = sim::start_mill(model, start_of(c, model));
    turn(mill, seen);
    seen.ball_steps = double(mill.step) * double(mill.charge.size());
  } catch (const Finding& f) {
    seen.kind = f.kind;
    seen.what = f.what;
  } catch (const InputError& e) {
    seen.kind = crowded(c.config) ? "no_room" : "input_error";
    seen.what = e.what();
  } catch (const WorkError& e) {
    seen.kind = "work_error";
    seen.what = e.what();
  }
  return seen;
}

// The same failure in a simpler mill: one thing after the other is left out, as long as it still fails.
inline Case shrunk(Case failing, const std::string& kind) {
  const auto still_fails = [&](const Case& c) {
    try {
      check_complete(c.config);
      sim::make_mill_model(c.config);
    } catch (const InputError&) {
      return false;
    }
    return run(c).kind == kind;
  };
  const auto try_it = [&](auto&& change) {
    Case simpler = failing;
    if (!change(simpler)) return false;
    if (!still_fails(simpler)) return false;
    failing = simpler;
    return true;
  };
  for (bool better = true; better;) {
    better = false;
    for (const Effect& effect : all_effects())
      better |= try_it([&](Case& c) { return c.config.effects.erase(effect.name) > 0; });
    better |= try_it([](Case& c) {
      const bool had = c.config.mill.lifters.profile != LifterProfile::kNone;
      c.config.mill.lifters = {};
      return had;
    });
    for (std::size_t k = 0; k < failing.config.charge.balls.size(); ++k)
      better |= try_it([&](Case& c) {
        if (c.config.charge.balls.size() < 2 || k >= c.config.charge.balls.size()) return false;
        c.config.charge.balls.erase(c.config.charge.balls.begin() + static_cast<std::ptrdiff_t>(k));
        return true;
      });
    for (const double share : {0.5, 0.8, 0.95})
      better |= try_it([&](Case& c) {
        int balls = 0;
        for (const int n : class_counts(c.config)) balls += n;
        c.config.charge.filling = kNotGiven;
        c.config.charge.count = static_cast<int>(balls * share);
        return *c.config.charge.count >= 1;
      });
    better |= try_it([](Case& c) {
      const WallContact& w = c.config.contact.wall;
      const bool had = !std::isnan(w.friction) || !std::isnan(w.restitution) || !std::isnan(w.normal_stiffness) ||
                       !std::isnan(w.tangential_stiffness);
      c.config.contact.wall = {};
      return had;
    });
    better |=
        try_it([](Case& c) { return std::exchange(c.config.contact.law, ContactLaw::kLinear) == ContactLaw::kHertz; });
    better |= try_it([](Case& c) { return std::exchange(c.config.contact.friction, 0) > 0; });
    better |= try_it([](Case& c) { return std::exchange(c.config.contact.friction_drop_at_critical, 0) > 0; });
  }
  return failing;
}

}  // namespace tumble::fuzz
