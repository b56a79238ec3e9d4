#include "core/config.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/angle.h"
#include "core/config_checker.h"
#include "core/effects.h"
#include "core/error.h"
#include "core/lifter_check.h"
#include "core/mill_shape.h"

namespace tumble {
namespace {

void check_mill(const ConfigChecker& c, const Mill& m) {
  c.positive("mill.diameter", m.diameter, "m");
  c.positive("mill.length", m.length, "m");
  c.range("mill.speed", m.speed, 0, 5, "of critical speed (for rev/min use mill.speed_rpm)");
  c.positive("mill.critical_speed_rpm", m.critical_speed_rpm, "rev/min");
  c.not_negative("mill.speed_rpm", m.speed_rpm, "rev/min");
  c.range("mill.speed_rpm", m.speed_rpm, 0, 5 * critical_speed_rpm(m), "rev/min (5 times critical)");
  if (!std::isnan(m.speed) && !std::isnan(m.speed_rpm))
    c.fail("mill.speed_rpm", "excludes mill.speed; keep one of the two");
  if (m.slices && *m.slices < 1) c.fail("mill.slices", "is " + std::to_string(*m.slices) + ", must be 1 or more");
}

void check_charge(const ConfigChecker& c, const Config& config) {
  const ChargeMix& charge = config.charge;
  if (!std::isnan(charge.filling) && charge.count)
    c.fail("charge.count", "excludes charge.filling; keep one of the two");
  if (charge.filling <= 0 || charge.filling > 0.8)
    c.fail("charge.filling",
           "is " + shown(charge.filling) +
               ", must be above 0 and at most 0.8 (a fraction of the shell's area; mills run at 0.2 to 0.45)");
  if (charge.count && (*charge.count < 1 || *charge.count > 10'000'000))
    c.fail("charge.count", "is " + std::to_string(*charge.count) + ", must lie between 1 and 10000000");
  c.positive("charge.bulk_density", charge.bulk_density, "kg/m3");
  const double tip = make_mill_shape(config).tip_radius;
  for (const BallClass& ball : charge.balls) {
    c.positive("charge.balls", ball.radius, "m for a radius");
    c.positive("charge.balls", ball.mass, "kg for a mass");
    c.positive("charge.balls", ball.share, "for a share");
    if (ball.radius >= tip)
      c.fail("charge.balls", "a ball of radius " + shown(ball.radius) + " m does not fit into the mill, which leaves " +
                                 shown(tip) + " m inside the lifters; radius and diameter are in metres");
  }
  if (charge.balls.empty() || std::isnan(config.mill.diameter)) return;
  if (std::any_of(charge.balls.begin(), charge.balls.end(), [](const BallClass& b) { return std::isnan(b.radius); }))
    return;  // nothing to add up yet
  if (!charge.count && std::isnan(charge.filling)) return;
  const std::vector<int> counts = class_counts(config);
  const double filling = filling_of(config, counts);
  // A whole number of balls may overshoot the filling that was asked for; a count has no such excuse.
  if (filling > (charge.count ? 0.8 : 0.85))
    c.fail(charge.count ? "charge.count" : "charge.filling",
           std::to_string(std::accumulate(counts.begin(), counts.end(), 0)) + " balls fill " + shown(filling) +
               " of the mill, must be at most 0.8; use fewer or smaller balls");
}

void check_contact(const ConfigChecker& c, const Contact& k) {
  c.positive("contact.normal_stiffness", k.normal_stiffness, "N/m");
  c.not_negative("contact.tangential_stiffness", k.tangential_stiffness, "N/m");
  c.not_negative("contact.friction", k.friction, "");
  c.range("contact.restitution", k.restitution, 0.01, 1, "");
  c.range("contact.friction_drop_at_critical", k.friction_drop_at_critical, 0, 1, "");
  c.positive("contact.wall.normal_stiffness", k.wall.normal_stiffness, "N/m");
  c.not_negative("contact.wall.tangential_stiffness", k.wall.tangential_stiffness, "N/m");
  c.not_negative("contact.wall.friction", k.wall.friction, "");
  c.range("contact.wall.restitution", k.wall.restitution, 0.01, 1, "");
}

// Columns that are given have a row for each of the ascending speeds.
void check_table(const ConfigChecker& c, const std::string& table, const Effect& effect,
                 const EffectSettings& settings) {
  const auto key = std::find_if(effect.parameters.begin(), effect.parameters.end(),
                                [](const EffectParameter& p) { return p.is_column() && !p.strength; });
  if (key == effect.parameters.end()) return;
  const auto given = settings.find(key->name);
  const std::vector<double> rows = given == settings.end() ? std::vector<double>{} : given->second;
  const std::string place = table + "." + key->name;
  if (rows.size() > kMostRows)
    c.fail(place, "has " + std::to_string(rows.size()) + " rows, must have at most " + std::to_string(kMostRows));
  for (std::size_t i = 1; i < rows.size(); ++i)
    if (!(rows[i] > rows[i - 1]))
      c.fail(place, "goes from " + shown(rows[i - 1]) + " to " + shown(rows[i]) + ", must ascend");
  for (const EffectParameter& p : effect.parameters) {
    const auto values = settings.find(p.name);
    if (!p.is_column() || !p.strength || values == settings.end() || values->second.empty()) continue;
    if (values->second.size() != rows.size())
      c.fail(table + "." + p.name, "has " + std::to_string(values->second.size()) + " rows and " + key->name + " " +
                                       std::to_string(rows.size()) + ", must have as many");
  }
}

void check_effects(const ConfigChecker& c, const Config& config) {
  for (const auto& [name, settings] : config.effects) {
    const Effect* effect = find_effect(name);
    const std::string table = "effects." + name;
    if (!effect) c.fail(table, "no such effect; `tumble effects` lists what there is");
    std::string strengths;
    bool any = false;
    for (const EffectParameter& p : effect->parameters) {
      if (p.strength) strengths += (strengths.empty() ? "" : " or ") + std::string(p.name);
      const auto given = settings.find(p.name);
      if (given == settings.end()) continue;
      any = any || p.strength;
      for (const double v : given->second) c.range(table + "." + p.name, v, p.least, p.most, p.unit);
      if (!p.list && given->second.size() != 1) c.fail(table + "." + p.name, "must be one number");
      for (const double v : given->second)
        if (p.whole && v != std::floor(v)) c.fail(table + "." + p.name, "is " + shown(v) + ", must be whole");
      if (!p.list || p.is_column() || config.mill.lifters.count < 1) continue;
      for (const double v : given->second)
        if (v >= config.mill.lifters.count)
          c.fail(table + "." + p.name, "names lifter " + shown(v) + ", the mill's lifters are 0 to " +
                                           std::to_string(config.mill.lifters.count - 1));
    }
    for (const auto& [key, values] : settings)
      if (!find_parameter(*effect, key))
        c.fail(table + "." + key, "no such parameter; see `tumble effects " + name + "`");
    if (!any) c.fail(table, "has no strength; give " + strengths);
    check_table(c, table, *effect, settings);
  }
  if (config.contact.law == ContactLaw::kHertz && config.effects.contains("hertz_contact"))
    c.fail("contact.law", "is \"hertz\", the whole of effects.hertz_contact; keep one of the two");
}

void check_run(const ConfigChecker& c, const RunPlan& run) {
  c.range("run.spin_up", run.spin_up, 0, 1e6, "revolutions");
  c.positive("run.revolutions", run.revolutions, "revolutions");
  c.range("run.revolutions", run.revolutions, 0, 1e6, "revolutions");
  c.range("run.frames_per_second", run.frames_per_second, 0.01, 1e6, "frames per simulated second");
  c.positive("run.time_step", run.time_step, "s");
}

void check_measurement(const ConfigChecker& c, const MeasurementErrors& m) {
  c.range("measurement.camera_scale", m.camera_scale, -0.5, 1, "");
  c.range("measurement.camera_rotation_deg", m.camera_rotation_deg, -180, 180, "degrees");
  c.range("measurement.frame_clock", m.frame_clock, -0.5, 1, "");
  c.range("measurement.torque_offset_N_m", m.torque_offset_N_m, -1e9, 1e9, "N m");
  c.range("measurement.filling_error", m.filling_error, -0.5, 1, "");
  c.range("measurement.speed_error", m.speed_error, -0.5, 1, "");
}

}  // namespace

std::string place_of(const Config& config, const std::string& key) {
  const auto it = config.origin.find(key);
  return (it == config.origin.end() ? config.file : it->second) + ": " + key;
}

void check(const Config& config) {
  const ConfigChecker c{config};
  check_mill(c, config.mill);
  check_effects(c, config);  // the lifters' wear is one of them
  check_lifters(config);
  check_charge(c, config);
  check_contact(c, config.contact);
  check_run(c, config.run);
  check_measurement(c, config.measurement);
}

void check_complete(const Config& config) {
  const ConfigChecker c{config};
  c.given("mill.diameter", config.mill.diameter, "the diameter inside the shell in m");
  if (std::isnan(config.mill.speed) && std::isnan(config.mill.speed_rpm))
    c.fail("mill.speed", "is missing; give the fraction of critical speed, or mill.speed_rpm");
  check_lifters_complete(config);
  if (config.charge.balls.empty())
    c.fail("charge.balls", "is missing; give [ { radius = 0.012, mass = 0.060, share = 1.0 } ], in m and kg");
  for (const BallClass& ball : config.charge.balls) {
    c.given("charge.balls", ball.radius, "each class a radius in m");
    c.given("charge.balls", ball.mass, "each class a mass in kg, or a density in kg/m3");
  }
  if (!config.charge.count && std::isnan(config.charge.filling))
    c.fail("charge.filling", "is missing; give the filling as a fraction, or charge.count");
  check(config);
}

double critical_speed_rpm(const Mill& mill) {
  if (!std::isnan(mill.critical_speed_rpm)) return mill.critical_speed_rpm;
  return rpm_from_rad_s(std::sqrt(kGravity / (mill.diameter / 2)));
}

double speed_rpm(const Mill& mill) {
  return std::isnan(mill.speed_rpm) ? mill.speed * critical_speed_rpm(mill) : mill.speed_rpm;
}

double speed_fraction(const Mill& mill) {
  return std::isnan(mill.speed) ? mill.speed_rpm / critical_speed_rpm(mill) : mill.speed;
}

Contact ball_contact(const Config& config) {
  Contact c = config.contact;
  c.friction *= friction_share(config);
  return c;
}

Contact wall_contact(const Config& config) {
  const auto or_else = [](double wall, double ball) { return std::isnan(wall) ? ball : wall; };
  const Contact& contact = config.contact;
  Contact c = contact;
  c.normal_stiffness = or_else(contact.wall.normal_stiffness, contact.normal_stiffness);
  c.tangential_stiffness = or_else(contact.wall.tangential_stiffness, contact.tangential_stiffness);
  c.friction = or_else(contact.wall.friction, contact.friction);
  c.restitution = or_else(contact.wall.restitution, contact.restitution);
  c.friction *= friction_share(config);
  return c;
}

std::vector<int> class_counts(const Config& config) {
  const auto& balls = config.charge.balls;
  double shares = 0;
  for (const BallClass& b : balls) shares += b.share;

  const auto split = [&](int total) {  // largest remainder
    std::vector<int> counts;
    std::vector<double> remainder;
    for (const BallClass& b : balls) {
      const double exact = total * b.share / shares;
      counts.push_back(static_cast<int>(exact));
      remainder.push_back(exact - counts.back());
    }
    std::vector<std::size_t> order(balls.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return remainder[a] > remainder[b]; });
    const int missing = total - std::accumulate(counts.begin(), counts.end(), 0);
    for (int i = 0; i < missing; ++i) ++counts[order[static_cast<std::size_t>(i)]];
    return counts;
  };
  if (config.charge.count) return split(*config.charge.count);

  // The number nearest to the filling: start from the mean disc, then step, for rounding moves the mean.
  double mean_area = 0;
  for (const BallClass& b : balls) mean_area += b.share / shares * kPi * b.radius * b.radius;
  const double shell_area = kPi * config.mill.diameter * config.mill.diameter / 4;
  const double guess = config.charge.filling * kSettledAreaShare * shell_area / mean_area;
  if (guess > 1e7)
    throw InputError(place_of(config, "charge.filling"),
                     "needs " + shown(guess) + " balls, must be at most 10000000; radii are in metres");
  int best = std::max(1, static_cast<int>(guess) - 2);
  const auto error = [&](int n) { return std::abs(filling_of(config, split(n)) - config.charge.filling); };
  for (int n = best + 1; n <= static_cast<int>(guess) + 3; ++n)
    if (error(n) < error(best)) best = n;
  return split(best);
}

double filling_of(const Config& config, const std::vector<int>& counts) {
  double area = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const double r = config.charge.balls[i].radius;
    area += counts[i] * kPi * r * r;
  }
  return area / (kSettledAreaShare * kPi * config.mill.diameter * config.mill.diameter / 4);
}

double slice_mass(const Config& config, const std::vector<int>& counts) {
  double mass = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) mass += counts[i] * config.charge.balls[i].mass;
  return mass;
}

SliceRule slice_rule(const Config& config) {
  if (config.mill.slices) return SliceRule::kGiven;
  if (std::isnan(config.mill.length)) return SliceRule::kNoLength;
  const std::vector<int> counts = class_counts(config);
  double diameters = 0, balls = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    diameters += counts[i] * 2 * config.charge.balls[i].radius;
    balls += counts[i];
  }
  return config.mill.length < 1.5 * diameters / balls ? SliceRule::kThin : SliceRule::kWeight;
}

double slice_count(const Config& config) {
  const SliceRule rule = slice_rule(config);
  if (rule == SliceRule::kGiven) return *config.mill.slices;
  if (rule != SliceRule::kWeight) return 1;
  const std::vector<int> counts = class_counts(config);
  const double volume = kPi * config.mill.diameter * config.mill.diameter / 4 * config.mill.length;
  return filling_of(config, counts) * volume * config.charge.bulk_density / slice_mass(config, counts);
}

const char* name_of(LifterProfile profile) {
  switch (profile) {
    case LifterProfile::kNone:
      return "none";
    case LifterProfile::kRectangle:
      return "rectangle";
    case LifterProfile::kTriangle:
      return "triangle";
    case LifterProfile::kTrapezoid:
      return "trapezoid";
    case LifterProfile::kWave:
      return "wave";
    case LifterProfile::kPolygon:
      return "polygon";
    case LifterProfile::kSwivel:
      return "swivel";
  }
  return "";
}

const char* name_of(ContactLaw law) { return law == ContactLaw::kHertz ? "hertz" : "linear"; }

}  // namespace tumble
