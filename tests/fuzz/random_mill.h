#pragma once
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/effects.h"
#include "core/error.h"
#include "core/random.h"
#include "core/units.h"
#include "io/config_file.h"
#include "sim/mill_model.h"

// Random mills that a user might ask for: anything that MILL.toml can say, with springs stiff enough that physics is
// sane, and no more balls and steps than a fuzzer can afford.
namespace tumble::fuzz {

inline constexpr double kSeconds = 0.2;  // that every mill turns

// How the balls come into the turning mill.
enum class Start {
  kSettled,  // as in every run: laid loosely, fallen, at rest
  kLoose,    // laid loosely, at rest
  kThrown    // laid loosely, flying in all directions, as fast as a fall through half the mill
};
inline constexpr const char* kStartNames[] = {"settled", "loose", "thrown"};

struct Case {
  Config config;
  Start start = Start::kSettled;
};

inline double log_uniform(Random& random, double low, double high) {
  return low * std::pow(high / low, random.uniform());
}
inline bool chance(Random& random, double share) { return random.uniform() < share; }

inline void draw_lifters(Random& random, Config& c) {
  Lifters& l = c.mill.lifters;
  const double radius = c.mill.diameter / 2;
  l.profile = static_cast<LifterProfile>(random.below(7));
  if (l.profile == LifterProfile::kNone) return;
  l.count = static_cast<int>(log_uniform(random, 1, 41));
  const double pitch = 2 * kPi * radius / l.count;
  const bool wave = l.profile == LifterProfile::kWave, polygon = l.profile == LifterProfile::kPolygon;
  const double height = radius * log_uniform(random, 0.005, 0.5);
  const double width = std::min(height * log_uniform(random, 0.2, 4), 0.9 * pitch * random.uniform());
  if (!polygon) l.height = height;
  if (!polygon && !wave) l.width = width;
  // 57 and not 57.3 degrees in a radian: faces that just do not meet.
  const double steepest = 57 * std::atan(width / height);
  if (l.profile == LifterProfile::kTriangle && chance(random, 0.3)) l.leading_angle_deg = random.uniform(0, steepest);
  if (l.profile == LifterProfile::kTriangle && std::isnan(l.leading_angle_deg) && chance(random, 0.4))
    l.trailing_angle_deg = random.uniform(0, steepest);
  if (l.profile == LifterProfile::kTrapezoid) {
    l.leading_angle_deg = 57 * std::atan(width / height * random.uniform());
    if (chance(random, 0.7)) l.trailing_angle_deg = 57 * std::atan(width / height * random.uniform() / 2);
  }
  if (l.profile == LifterProfile::kSwivel) l.swivel_angle_deg = random.uniform(-60, 60);
  if (!polygon) return;
  // A wander of the outline from the trailing to the leading foot; what crosses itself is not valid.
  const int between = 1 + static_cast<int>(random.below(6));
  l.points.push_back({0, -width / 2});
  for (int i = 0; i < between; ++i)
    l.points.push_back({height * random.uniform(0.1, 1), width * ((i + 0.5) / between - 0.5) * random.uniform(0.5, 2) +
                                                             width * random.uniform(-.3, .3)});
  l.points.push_back({0, width / 2});
}

inline void draw_balls(Random& random, Config& c) {
  const int classes = 1 + static_cast<int>(random.below(4));
  const double ratio = log_uniform(random, 1, 8);
  const double density = random.uniform(1200, 8300), by_size = random.uniform(0, 3);
  double shares = 0, area = 0;
  for (int k = 0; k < classes; ++k) {
    BallClass b;
    // The first is the smallest, the last the largest, in units of the smallest.
    b.radius = k == 0 ? 1 : k + 1 == classes ? ratio : log_uniform(random, 1, ratio);
    b.mass = density * (chance(random, 0.1) ? random.uniform(0.4, 1) : 1);
    b.share = std::pow(b.radius, -by_size) * random.uniform(0.2, 1);
    shares += b.share;
    area += b.share * b.radius * b.radius;
    c.charge.balls.push_back(b);
  }
  const double filling = log_uniform(random, 0.02, 0.5);
  const int number = static_cast<int>(log_uniform(random, 1, 401));
  const double unit = c.mill.diameter / 2 * std::sqrt(filling * kSettledAreaShare / number / (area / shares));
  for (BallClass& b : c.charge.balls) {
    b.radius *= unit;
    b.mass *= 4.0 / 3 * kPi * b.radius * b.radius * b.radius;
  }
  if (chance(random, 0.5))
    c.charge.filling = filling;
  else
    c.charge.count = number;
}

// Any of the effects, each with the chance `share`, over the range in which it means something for these balls.
inline void draw_effects(Random& random, Config& c, double share) {
  double mean = 0, shares = 0;
  for (const BallClass& b : c.charge.balls) {
    mean += b.share * b.mass;
    shares += b.share;
  }
  const double weight = mean / shares * kGravity, speed = std::sqrt(kGravity * c.mill.diameter);
  const auto lifters = [&] {
    std::vector<double> list;
    for (int k = 0; k < c.mill.lifters.count; ++k)
      if (chance(random, 0.3)) list.push_back(k);
    return list;
  };
  const auto log = [&](double low, double high) { return std::vector{log_uniform(random, low, high)}; };
  const auto even = [&](double low, double high) { return std::vector{random.uniform(low, high)}; };
  const auto draw = [&](const std::string& name) -> EffectSettings {
    if (name == "rolling_resistance") return {{"coefficient", log(1e-3, 1)}};
    if (name == "friction_weakening") return {{"drop", even(0, 1)}, {"sliding_speed", log(1e-3 * speed, speed)}};
    if (name == "wall_friction") return {{"increase", even(-1, 4)}};
    if (name == "fluid_drag")
      return {{"viscosity", log(1e-4, 10)}, {"density", even(0, 3000)}, {"drag_coefficient", even(0, 2)}};
    if (name == "slurry_pool")
      return {{"density", log(10, 5000)},
              {"level", even(-1, 1)},
              {"viscosity", log(1e-4, 10)},
              {"drag_coefficient", even(0, 2)}};
    if (name == "impact_restitution") return {{"drop", even(0, 0.95)}, {"impact_speed", log(1e-3 * speed, speed)}};
    if (name == "end_wall_friction") return {{"coefficient", log(1e-3, 2)}, {"pressure", even(0, 0.5)}};
    if (name == "cohesion") return {{"force", {weight * log_uniform(random, 1e-2, 30)}}};
    if (name == "lifter_wear") {
      EffectSettings wear{{"height_loss", even(0, 0.9)},
                          {"rounding", {c.mill.diameter * log_uniform(random, 1e-4, 1e-1)}}};
      if (chance(random, 0.5)) wear["lifters"] = lifters();
      return wear;
    }
    if (name == "hertz_contact")
      return {{"share", even(0, 1)}, {"reference_speed", {speed * log_uniform(random, 0.1, 1)}}};
    if (name == "speed_ripple")
      return {{"amplitude", even(0, 0.99)}, {"order", {double(1 + random.below(40))}}, {"phase_deg", even(-180, 180)}};
    if (name == "missing_lifters") return {{"lifters", lifters()}};
    const auto column = [&](std::size_t rows, double low, double high) {
      std::vector<double> values;
      for (std::size_t k = 0; k < rows; ++k) values.push_back(random.uniform(low, high));
      return values;
    };
    if (name.starts_with("tabulated")) {
      const std::size_t rows = 1 + random.below(kMostRows);
      std::vector<double> at{random.uniform(0, 0.1) * speed};
      while (at.size() < rows) at.push_back(at.back() + random.uniform(1e-6, 0.2) * speed);
      if (name == "tabulated_friction")
        return {{"speed", at},
                {"friction", column(rows, 0, 1)},
                {"wall_friction", column(chance(random, 0.5) ? rows : 0, 0, 1)}};
      if (name == "tabulated_restitution")
        return {{"speed", at},
                {"restitution", column(rows, 0.01, 1)},
                {"wall_restitution", column(chance(random, 0.5) ? rows : 0, 0.01, 1)}};
      return {
          {"speed", at}, {"coefficient", column(rows, 0, weight / speed)}, {"radius_power", {double(random.below(4))}}};
    }
    throw std::logic_error("the fuzzer does not know the effect " + name);
  };
  for (const Effect& effect : all_effects()) {
    const bool wanted = chance(random, share);
    if (!wanted || (effect.name == std::string("hertz_contact") && c.contact.law == ContactLaw::kHertz)) continue;
    c.effects[effect.name] = draw(effect.name);
  }
}

// `stiffer` 1: the heaviest ball that falls through the mill and is met by its shell overlaps by a tenth of the
// smallest radius, and what sticks by cohesion by a fiftieth.
inline void draw_contact(Random& random, Config& c, double stiffer) {
  double smallest = INFINITY, largest = 0, heaviest = 0, mean = 0, shares = 0;
  for (const BallClass& b : c.charge.balls) {
    smallest = std::min(smallest, b.radius);
    largest = std::max(largest, b.radius);
    heaviest = std::max(heaviest, b.mass);
    mean += b.share * b.radius;
    shares += b.share;
  }
  const double radius = c.mill.diameter / 2;
  const double fastest = 2 * std::sqrt(kGravity * radius) +
                         speed_rpm(c.mill) * kPi / 30 * radius * (1 + effect_value(c, "speed_ripple", "amplitude"));
  const double sticking = effect_value(c, "cohesion", "force") * 2 * largest / (mean / shares);
  Contact& k = c.contact;
  k.normal_stiffness =
      stiffer * std::max(heaviest * std::pow(fastest / (0.1 * smallest), 2), sticking / (0.02 * smallest));
  k.tangential_stiffness = k.normal_stiffness * random.uniform(0.1, 1.2);
  if (chance(random, 0.05) && !c.effects.contains("rolling_resistance") && !c.effects.contains("end_wall_friction"))
    k.tangential_stiffness = 0;
  k.friction = chance(random, 0.1) ? 0 : random.uniform(0, 1.5);
  k.restitution = chance(random, 0.1) ? 1 : random.uniform(0.05, 1);
  if (chance(random, 0.2)) k.friction_drop_at_critical = random.uniform();
  WallContact& w = k.wall;
  if (chance(random, 0.3)) w.normal_stiffness = k.normal_stiffness * log_uniform(random, 1, 10);
  if (chance(random, 0.3)) w.tangential_stiffness = k.normal_stiffness * random.uniform(0.1, 1.2);
  if (chance(random, 0.5)) w.friction = random.uniform(0, 1.5);
  if (chance(random, 0.5)) w.restitution = random.uniform(0.05, 1);
}

// Some random config; most are valid.
inline Config draw_config(Random& random) {
  Config c;
  c.mill.diameter = log_uniform(random, 0.05, 10);
  const double speed = random.uniform(0.05, 1.6);
  if (chance(random, 0.8))
    c.mill.speed = speed;
  else
    c.mill.speed_rpm = speed * critical_speed_rpm(c.mill);
  draw_lifters(random, c);
  draw_balls(random, c);
  if (chance(random, 0.3)) c.contact.law = ContactLaw::kHertz;
  const double effects[] = {0, 0.1, 0.3, 0.7};
  draw_effects(random, c, effects[random.below(4)]);
  draw_contact(random, c, log_uniform(random, 0.3, 100));
  c.run.seed = 1 + random.below(1'000'000);
  return c;
}

struct Tally {
  long drawn = 0, not_valid = 0, too_dear = 0;
};

// The next valid mill that costs at most `most_ball_steps`. A dear one is given fewer balls first; what is dear with
// three is left out.
inline Case random_mill(Random& random, double most_ball_steps, Tally& tally) {
  for (;;) {
    ++tally.drawn;
    Case drawn{draw_config(random), static_cast<Start>(random.below(3))};
    Config& c = drawn.config;
    try {
      check_complete(c);
      c = io::parse_config(io::to_toml(c), "fuzz.toml");
      const double step = sim::make_mill_model(c).time_step;
      const double settling = 2 * std::sqrt(2 * c.mill.diameter / kGravity);
      int balls = 0;
      for (const int n : class_counts(c)) balls += n;
      if (drawn.start == Start::kSettled && balls * (kSeconds + settling) / step > most_ball_steps)
        drawn.start = chance(random, 0.5) ? Start::kLoose : Start::kThrown;
      const double most = most_ball_steps * step / kSeconds;
      if (balls > most) {
        if (most < 3) {
          ++tally.too_dear;
          continue;
        }
        c.charge.filling = kNotGiven;
        c.charge.count = static_cast<int>(most);
        check_complete(c);
        sim::make_mill_model(c);
      }
      return drawn;
    } catch (const InputError&) {
      ++tally.not_valid;
    }
  }
}

}  // namespace tumble::fuzz
