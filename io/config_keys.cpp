#include "io/config_keys.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "core/effects.h"

namespace tumble::io {
namespace {

// &reach<&Config::mill, &Mill::diameter> is the function that takes a Config to that field.
template <auto... Members>
auto& reach(Config& config) {
  return (config.*....*Members);
}

const AutoNumber kSpinUp{&reach<&Config::run, &RunPlan::spin_up>, [](const Config& c) { return c.run.spin_up_auto; },
                         [](Config& c, bool automatic) {
                           c.run.spin_up_auto = automatic;
                           if (automatic) c.run.spin_up = RunPlan{}.spin_up;  // unused then; one value, one text
                         }};
const AutoNumber kTimeStep{&reach<&Config::run, &RunPlan::time_step>,
                           [](const Config& c) { return c.run.time_step != c.run.time_step; },
                           [](Config& c, bool automatic) {
                             if (automatic) c.run.time_step = kNotGiven;
                           }};

std::vector<Key> make_keys() {
  using C = Config;
  return {
      {"mill.diameter", "a length in m, > 0", "diameter inside the shell", &reach<&C::mill, &Mill::diameter>},
      {"mill.length", "a length in m, > 0", "length inside the mill, to scale one slice to the mill",
       &reach<&C::mill, &Mill::length>},
      {"mill.speed", "a fraction of critical speed, >= 0", "speed", &reach<&C::mill, &Mill::speed>, "mill.speed_rpm"},
      {"mill.speed_rpm", "a speed in rev/min, >= 0", "speed", &reach<&C::mill, &Mill::speed_rpm>, "mill.speed"},
      {"mill.critical_speed_rpm", "a speed in rev/min, > 0", "critical speed, instead of (30/pi) sqrt(g / R)",
       &reach<&C::mill, &Mill::critical_speed_rpm>},
      {"mill.slices", "a whole number, >= 1", "slices that make up the mill", &reach<&C::mill, &Mill::slices>},
      {"mill.lifters.count", "a whole number, >= 0", "lifters round the shell",
       &reach<&C::mill, &Mill::lifters, &Lifters::count>},
      {"mill.lifters.profile", "a name in quotes", "cross-section of a lifter",
       &reach<&C::mill, &Mill::lifters, &Lifters::profile>},
      {"mill.lifters.height", "a length in m, > 0", "above the shell, along the radius",
       &reach<&C::mill, &Mill::lifters, &Lifters::height>},
      {"mill.lifters.width", "a length in m, > 0", "at the foot, across the radius",
       &reach<&C::mill, &Mill::lifters, &Lifters::width>},
      {"mill.lifters.leading_angle_deg", "an angle in degrees, 0 to 85", "leading face against the radius",
       &reach<&C::mill, &Mill::lifters, &Lifters::leading_angle_deg>},
      {"mill.lifters.trailing_angle_deg", "an angle in degrees, 0 to 85", "trailing face against the radius",
       &reach<&C::mill, &Mill::lifters, &Lifters::trailing_angle_deg>},
      {"mill.lifters.swivel_angle_deg", "an angle in degrees, -60 to 60", "tilt of a swivel bar, > 0 back",
       &reach<&C::mill, &Mill::lifters, &Lifters::swivel_angle_deg>},
      {"mill.lifters.points", "a list of points in m, [ [height above the shell, across], ... ]",
       "outline of a polygon lifter from its trailing foot over the top to its leading foot", PointList{}},
      {"charge.filling", "a fraction, > 0 to 0.8", "share of the mill that the settled charge takes",
       &reach<&C::charge, &ChargeMix::filling>, "charge.count"},
      {"charge.count", "a whole number, >= 1", "balls in the slice", &reach<&C::charge, &ChargeMix::count>,
       "charge.filling"},
      {"charge.bulk_density", "a density in kg/m3, > 0", "of the settled charge, voids included",
       &reach<&C::charge, &ChargeMix::bulk_density>},
      {"charge.balls", "a list of ball classes, [ { radius = 0.012, mass = 0.060, share = 0.7 }, ... ]",
       "classes of balls; share is of the number", BallList{}},
      {"contact.law", "a name in quotes", "force law of a contact", &reach<&C::contact, &Contact::law>},
      {"contact.normal_stiffness", "a stiffness in N/m, > 0", "k_n", &reach<&C::contact, &Contact::normal_stiffness>},
      {"contact.tangential_stiffness", "a stiffness in N/m, >= 0", "k_t",
       &reach<&C::contact, &Contact::tangential_stiffness>},
      {"contact.friction", "a number, >= 0", "mu, ball on ball", &reach<&C::contact, &Contact::friction>},
      {"contact.restitution", "a number, > 0 to 1", "e, ball on ball", &reach<&C::contact, &Contact::restitution>},
      {"contact.friction_drop_at_critical", "a fraction, 0 to 1",
       "share of every friction lost at critical speed, linear in the mill's speed",
       &reach<&C::contact, &Contact::friction_drop_at_critical>},
      {"contact.wall.normal_stiffness", "a stiffness in N/m, > 0", "k_n at the wall",
       &reach<&C::contact, &Contact::wall, &WallContact::normal_stiffness>},
      {"contact.wall.tangential_stiffness", "a stiffness in N/m, >= 0", "k_t at the wall",
       &reach<&C::contact, &Contact::wall, &WallContact::tangential_stiffness>},
      {"contact.wall.friction", "a number, >= 0", "mu, ball on wall",
       &reach<&C::contact, &Contact::wall, &WallContact::friction>},
      {"contact.wall.restitution", "a number, > 0 to 1", "e, ball on wall",
       &reach<&C::contact, &Contact::wall, &WallContact::restitution>},
      {"run.spin_up", "revolutions, >= 0, or \"auto\"", "turned before anything is averaged", kSpinUp},
      {"run.revolutions", "revolutions, > 0", "averaged and written", &reach<&C::run, &RunPlan::revolutions>},
      {"run.frames_per_second", "frames per simulated second, > 0", "rate of the written frames",
       &reach<&C::run, &RunPlan::frames_per_second>},
      {"run.time_step", "a time in s, > 0, or \"auto\"", "step of the integration", kTimeStep},
      {"run.seed", "a whole number from 0 to 9223372036854775807", "of the packing", &reach<&C::run, &RunPlan::seed>},
      {"measurement.camera_scale", "a fraction, -0.5 to 1",
       "lengths in films and tracks are 1 + this times the true ones",
       &reach<&C::measurement, &MeasurementErrors::camera_scale>},
      {"measurement.camera_rotation_deg", "an angle in degrees, -180 to 180",
       "films and tracks are turned by this, counter-clockwise",
       &reach<&C::measurement, &MeasurementErrors::camera_rotation_deg>},
      {"measurement.frame_clock", "a fraction, -0.5 to 1", "times in films and tracks are 1 + this times the true ones",
       &reach<&C::measurement, &MeasurementErrors::frame_clock>},
      {"measurement.torque_offset_N_m", "a torque in N m", "measured torque less the true one, of the whole mill",
       &reach<&C::measurement, &MeasurementErrors::torque_offset_N_m>},
      {"measurement.filling_error", "a fraction, -0.5 to 1",
       "true fillings are 1 + this times those that experiments set",
       &reach<&C::measurement, &MeasurementErrors::filling_error>},
      {"measurement.speed_error", "a fraction, -0.5 to 1", "true speeds are 1 + this times those that experiments set",
       &reach<&C::measurement, &MeasurementErrors::speed_error>},
  };
}

// Levenshtein's distance with swapped neighbours counted once (optimal string alignment).
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) row[j] = std::min(row[j], before[j - 2] + 1);
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

std::string leaf(const std::string& path) { return path.substr(path.rfind('.') + 1); }

// Whole paths compared, or last names with a small fine for the wrong table.
std::size_t key_distance(const std::string& path, const std::string& known) {
  return std::min(edit_distance(path, known), edit_distance(leaf(path), leaf(known)) + 1);
}

std::vector<std::string> sections() {
  std::vector<std::string> found;
  for (const Key& key : config_keys()) {
    std::string section = key.path.substr(0, key.path.rfind('.'));
    if (std::find(found.begin(), found.end(), section) == found.end()) found.push_back(std::move(section));
  }
  return found;
}

struct Clear {
  Config& config;
  void operator()(double& (*field)(Config&)) const { field(config) = kNotGiven; }
  void operator()(std::optional<int>& (*field)(Config&)) const { field(config).reset(); }
  void operator()(const auto&) const {}  // no other kind excludes
};

}  // namespace

std::span<const Key> config_keys() {
  static const std::vector<Key> keys = make_keys();
  return keys;
}

const Key* find_key(const std::string& path) {
  for (const Key& key : config_keys())
    if (key.path == path) return &key;
  return nullptr;
}

bool is_section(const std::string& path) {
  const auto all = sections();
  return std::find(all.begin(), all.end(), path) != all.end();
}

std::string nearest_key(const std::string& path) {
  const auto keys = config_keys();
  return std::min_element(
             keys.begin(), keys.end(),
             [&](const Key& a, const Key& b) { return key_distance(path, a.path) < key_distance(path, b.path); })
      ->path;
}

std::string nearest_section(const std::string& path) {
  const auto all = sections();
  return nearest_word(path, all);
}

std::string nearest_word(const std::string& word, std::span<const std::string> words) {
  return *std::min_element(words.begin(), words.end(), [&](const std::string& a, const std::string& b) {
    return edit_distance(word, a) < edit_distance(word, b);
  });
}

void clear_field(const Key& key, Config& config) { std::visit(Clear{config}, key.field); }

double number_at(const Config& config, const std::string& key) {
  if (key == "mill.speed") return speed_fraction(config.mill);
  if (key == "mill.speed_rpm") return speed_rpm(config.mill);
  if (key == "charge.filling") return filling_of(config, class_counts(config));
  if (key == "charge.count") {
    double balls = 0;
    for (const int n : class_counts(config)) balls += n;
    return balls;
  }
  Config copy = config;  // the table's functions take a mutable config
  if (const Key* k = find_key(key)) {
    if (const auto* f = std::get_if<double& (*)(Config&)>(&k->field)) return (*f)(copy);
    if (const auto* f = std::get_if<int& (*)(Config&)>(&k->field)) return (*f)(copy);
    if (const auto* f = std::get_if<std::optional<int>& (*)(Config&)>(&k->field)) return (*f)(copy).value_or(kNotGiven);
    if (const auto* f = std::get_if<AutoNumber>(&k->field)) return f->value(copy);
    return kNotGiven;
  }
  const auto dot = key.rfind('.');
  if (!key.starts_with("effects.") || dot < 8) return kNotGiven;
  const std::string name = key.substr(8, dot - 8);
  const Effect* effect = find_effect(name);
  if (!effect || !find_parameter(*effect, key.substr(dot + 1))) return kNotGiven;
  return effect_value(config, name, key.substr(dot + 1));
}

}  // namespace tumble::io
