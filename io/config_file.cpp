#include "io/config_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>
#include <sstream>
#include <system_error>

#include "core/effects.h"
#include "core/error.h"
#include "core/units.h"
#include "io/config_keys.h"
#include "io/text_file.h"

namespace tumble::io {
namespace {

constexpr std::size_t kLargestMiB = 1;  // a config is a page, anything near this is a mistake

constexpr std::array kProfiles{LifterProfile::kNone,      LifterProfile::kRectangle, LifterProfile::kTriangle,
                               LifterProfile::kTrapezoid, LifterProfile::kWave,      LifterProfile::kPolygon,
                               LifterProfile::kSwivel};
constexpr std::array kLaws{ContactLaw::kLinear, ContactLaw::kHertz};
const std::vector<std::string> kBallKeys{"radius", "mass", "density", "share"};

std::string article(toml::node_type type) {
  switch (type) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "a list";
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
      return "a whole number";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "a truth value";
    default:
      return "a date or time";
  }
}

// What was found, as a message says it: the string "big", 2.5, a table.
std::string found(const toml::node& node) {
  if (const auto* s = node.as_string()) return "the string \"" + one_line(s->get()) + "\"";
  if (const auto* i = node.as_integer()) return fmt::format("{}", i->get());
  if (const auto* f = node.as_floating_point()) return fmt::format("{}", f->get());
  if (const auto* b = node.as_boolean()) return b->get() ? "true" : "false";
  return article(node.type());
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const auto& n : names) text += (text.empty() ? "" : ", ") + n;
  return text;
}

// Reads one TOML document (the file, or one --set) into a Config.
class Reader {
 public:
  // `line_of_file`: name a line in places; a --set has none.
  Reader(Config& config, std::string name, bool has_lines)
      : config_(config), name_(std::move(name)), has_lines_(has_lines) {}

  void read_table(const std::string& section, const toml::table& table) {
    for (const auto& [name, node] : table) {
      const std::string path = section.empty() ? std::string(name.str()) : section + "." + std::string(name.str());
      read_node(path, node);
    }
    refuse_both_ways(table, section);
  }

  void read_node(const std::string& path, const toml::node& node) {
    if (path == "effects" || path.starts_with("effects.")) return read_effects(path, node);
    if (is_section(path)) {
      if (!node.is_table()) fail(node, path, "found " + found(node) + ", must be a table: [" + path + "]");
      return read_table(path, *node.as_table());
    }
    const Key* key = find_key(path);
    if (!key) refuse_unknown(path, node);
    if (!key->excludes.empty()) {
      clear_field(*find_key(key->excludes), config_);
      config_.origin.erase(key->excludes);
    }
    std::visit([&](const auto& field) { read(*key, field, node); }, key->field);
    config_.origin[path] = place(node);
  }

 private:
  std::string place(const toml::node& node) const {
    return has_lines_ ? fmt::format("{}:{}", name_, node.source().begin.line) : name_;
  }
  [[noreturn]] void fail(const toml::node& node, const std::string& key, const std::string& problem) const {
    throw InputError(place(node) + ": " + one_line(key), problem);
  }
  [[noreturn]] void refuse(const Key& key, const toml::node& node) const {
    fail(node, key.path, "found " + found(node) + ", must be " + key.wanted);
  }

  [[noreturn]] void refuse_unknown(const std::string& path, const toml::node& node) const {
    if (node.is_table()) fail(node, path, "unknown table; did you mean [" + nearest_section(path) + "]?");
    fail(node, path, "unknown key; did you mean " + nearest_key(path) + "?");
  }

  // "effects", "effects.NAME" or "effects.NAME.PARAMETER"
  void read_effects(const std::string& path, const toml::node& node) {
    const auto dot = path.find('.'), second = dot == std::string::npos ? dot : path.find('.', dot + 1);
    if (second == std::string::npos) {
      const auto* table = node.as_table();
      if (!table) fail(node, path, "found " + found(node) + ", must be a table such as [effects.rolling_resistance]");
      if (dot != std::string::npos) config_.effects[effect_of(path.substr(dot + 1), node).name];
      if (dot != std::string::npos) config_.origin[path] = place(node);
      for (const auto& [name, child] : *table) read_effects(path + "." + std::string(name.str()), child);
      return;
    }
    const Effect& effect = effect_of(path.substr(dot + 1, second - dot - 1), node);
    const std::string name = path.substr(second + 1);
    const EffectParameter* parameter = find_parameter(effect, name);
    if (!parameter) {
      std::vector<std::string> known;
      for (const EffectParameter& p : effect.parameters) known.emplace_back(p.name);
      fail(node, path, "unknown key; did you mean " + nearest_word(name, known) + "? known: " + joined(known));
    }
    const std::string unit = *parameter->unit ? std::string(" in ") + parameter->unit : "";
    const std::string wanted = fmt::format("a {}{}, {:g} to {:g}", parameter->whole ? "whole number" : "number", unit,
                                           parameter->least, parameter->most);
    const std::string list_of =
        parameter->is_column() ? "numbers" + unit + " such as [0.1, 0.5]" : "lifter numbers such as [0, 3]";
    std::vector<double> values;
    if (parameter->list) {
      const auto* list = node.as_array();
      if (!list) fail(node, path, "found " + found(node) + ", must be a list of " + list_of);
      for (const toml::node& entry : *list) values.push_back(number(path, list_of, entry));
      if (!parameter->is_column()) {
        std::sort(values.begin(), values.end());
        values.erase(std::unique(values.begin(), values.end()), values.end());
      }
    } else {
      values.push_back(number(path, wanted, node));
    }
    config_.effects[effect.name][name] = std::move(values);
    config_.origin[path] = place(node);
  }

  const Effect& effect_of(const std::string& name, const toml::node& node) const {
    if (const Effect* effect = find_effect(name)) return *effect;
    std::vector<std::string> known;
    for (const Effect& e : all_effects()) known.emplace_back(e.name);
    fail(node, "effects." + name,
         "no such effect; did you mean " + nearest_word(name, known) + "? `tumble effects` lists what there is");
  }

  // One table that gives a thing in both ways contradicts itself, whatever the order of its keys.
  void refuse_both_ways(const toml::table& table, const std::string& section) const {
    for (const Key& key : config_keys()) {
      if (key.excludes.empty() || key.path.substr(0, key.path.rfind('.')) != section) continue;
      const auto* one = table.get(key.path.substr(section.size() + 1));
      const auto* other = table.get(key.excludes.substr(section.size() + 1));
      if (one && other && one->source().begin.line >= other->source().begin.line)
        fail(*one, key.path, "given beside " + key.excludes + "; keep one of the two");
    }
  }

  double number(const std::string& path, const std::string& wanted, const toml::node& node) const {
    double value = kNotGiven;
    if (const auto* f = node.as_floating_point()) value = f->get();
    if (const auto* i = node.as_integer()) value = static_cast<double>(i->get());
    if (!std::isfinite(value)) fail(node, path, "found " + found(node) + ", must be " + wanted);
    return value;
  }

  // 148.0 is taken for 148: programs that write numbers often write it so.
  std::int64_t whole(const Key& key, const toml::node& node) const {
    if (const auto* i = node.as_integer()) return i->get();
    const auto* f = node.as_floating_point();
    if (!f || f->get() != std::floor(f->get()) || std::abs(f->get()) > 9e15) refuse(key, node);
    return static_cast<std::int64_t>(f->get());
  }

  int small_whole(const Key& key, const toml::node& node) const {
    const std::int64_t value = whole(key, node);
    if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max()) refuse(key, node);
    return static_cast<int>(value);
  }

  void read(const Key& key, double& (*field)(Config&), const toml::node& node) {
    field(config_) = number(key.path, key.wanted, node);
  }
  void read(const Key& key, int& (*field)(Config&), const toml::node& node) { field(config_) = small_whole(key, node); }
  void read(const Key& key, std::optional<int>& (*field)(Config&), const toml::node& node) {
    field(config_) = small_whole(key, node);
  }
  void read(const Key& key, std::uint64_t& (*field)(Config&), const toml::node& node) {
    const std::int64_t value = whole(key, node);
    if (value < 0) refuse(key, node);
    field(config_) = static_cast<std::uint64_t>(value);
  }
  void read(const Key& key, LifterProfile& (*field)(Config&), const toml::node& node) {
    field(config_) = choice(key, kProfiles, node);
  }
  void read(const Key& key, ContactLaw& (*field)(Config&), const toml::node& node) {
    field(config_) = choice(key, kLaws, node);
  }

  template <typename T, std::size_t N>
  T choice(const Key& key, const std::array<T, N>& values, const toml::node& node) const {
    std::vector<std::string> names;
    for (const T value : values) names.emplace_back(name_of(value));
    if (!node.is_string()) fail(node, key.path, "found " + found(node) + ", must be one of " + joined(names));
    const std::string& name = node.as_string()->get();
    for (const T value : values)
      if (name == name_of(value)) return value;
    fail(node, key.path,
         "found " + found(node) + ", did you mean \"" + nearest_word(name, names) + "\"? available: " + joined(names));
  }

  void read(const Key& key, const AutoNumber& field, const toml::node& node) {
    const bool automatic = node.is_string() && node.as_string()->get() == "auto";
    field.set_auto(config_, automatic);
    if (!automatic) field.value(config_) = number(key.path, key.wanted, node);
  }

  void read(const Key& key, const BallList&, const toml::node& node) {
    const auto* list = node.as_array();
    if (!list || list->empty()) refuse(key, node);
    std::vector<BallClass> balls;
    for (const toml::node& entry : *list) {
      const std::string path = fmt::format("{}[{}]", key.path, balls.size());
      if (!entry.is_table())
        fail(entry, path, "found " + found(entry) + ", must be { radius = ..., mass = ..., share = ... }");
      balls.push_back(read_ball(path, *entry.as_table()));
    }
    config_.charge.balls = std::move(balls);
  }

  void read(const Key& key, const PointList&, const toml::node& node) {
    const auto* list = node.as_array();
    if (!list) refuse(key, node);
    std::vector<std::array<double, 2>> points;
    for (const toml::node& entry : *list) {
      const std::string path = fmt::format("{}[{}]", key.path, points.size());
      const auto* pair = entry.as_array();
      if (!pair || pair->size() != 2) fail(entry, path, "found " + found(entry) + ", must be [height, across] in m");
      points.push_back(
          {number(path, "[height, across] in m", *pair->get(0)), number(path, "[height, across] in m", *pair->get(1))});
    }
    config_.mill.lifters.points = std::move(points);
  }

  BallClass read_ball(const std::string& path, const toml::table& table) const {
    BallClass ball;
    double density = kNotGiven;
    for (const auto& [name, node] : table) {
      const std::string key(name.str()), at = path + "." + key;
      if (key == "radius")
        ball.radius = number(at, "a length in m, > 0", node);
      else if (key == "mass")
        ball.mass = number(at, "a mass in kg, > 0", node);
      else if (key == "share")
        ball.share = number(at, "a number, > 0", node);
      else if (key == "density")
        density = number(at, "a density in kg/m3, > 0", node);
      else
        fail(node, at, "unknown key; did you mean " + nearest_word(key, kBallKeys) + "? known: " + joined(kBallKeys));
    }
    if (const auto* node = table.get("density")) {
      if (table.contains("mass")) fail(*node, path + ".density", "given beside mass; keep one of the two");
      if (!table.contains("radius")) fail(*node, path + ".density", "needs the radius too, to give a sphere's mass");
      if (!(density > 0)) fail(*node, path + ".density", "found " + found(*node) + ", must be a density in kg/m3, > 0");
      ball.mass = density * 4.0 / 3.0 * kPi * ball.radius * ball.radius * ball.radius;
    }
    return ball;
  }

  Config& config_;
  std::string name_;
  bool has_lines_;
};

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

// A word that needs no quotes on the command line: --set run.spin_up=auto.
bool bare_word(const std::string& text) {
  return !text.empty() &&
         std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; }) &&
         std::isalpha(static_cast<unsigned char>(text[0])) && text != "true" && text != "false" && text != "nan" &&
         text != "inf";
}

void apply_set(Config& config, const std::string& assignment) {
  const auto equals = assignment.find('=');
  const std::string path = trimmed(assignment.substr(0, equals));
  if (equals == std::string::npos || path.empty())
    throw InputError("--set", "found \"" + one_line(assignment) + "\", must be KEY=VALUE such as mill.speed=0.7");
  const std::string value = trimmed(assignment.substr(equals + 1));
  if (value.empty())
    throw InputError("--set: " + one_line(path), "has no value; give KEY=VALUE such as mill.speed=0.7");
  try {
    const toml::table document = toml::parse("v = " + (bare_word(value) ? "\"" + value + "\"" : value));
    if (document.size() != 1) throw InputError("--set: " + one_line(path), "more than one value; repeat --set");
    Reader(config, "--set", false).read_node(path, *document.get("v"));
  } catch (const toml::parse_error& e) {
    throw InputError("--set: " + one_line(path),
                     "the value \"" + one_line(value) + "\" is not valid TOML: " + one_line(e.description()));
  }
}

// Text of a field that is in force; empty where there is nothing to write.
struct Write {
  const Config& config;
  Config& fields;  // the same values; the table's functions take a mutable config

  static std::string text(double v) { return std::isnan(v) ? "" : fmt::format("{}", v); }
  std::string operator()(double& (*f)(Config&)) const { return text(f(fields)); }
  std::string operator()(int& (*f)(Config&)) const { return std::to_string(f(fields)); }
  std::string operator()(std::optional<int>& (*f)(Config&)) const {
    return f(fields) ? std::to_string(*f(fields)) : "";
  }
  std::string operator()(std::uint64_t& (*f)(Config&)) const { return std::to_string(f(fields)); }
  std::string operator()(LifterProfile& (*f)(Config&)) const { return quoted(name_of(f(fields))); }
  std::string operator()(ContactLaw& (*f)(Config&)) const { return quoted(name_of(f(fields))); }
  std::string operator()(const AutoNumber& f) const { return f.is_auto(config) ? "\"auto\"" : text(f.value(fields)); }
  std::string operator()(const BallList&) const {
    std::string list;
    for (const BallClass& ball : config.charge.balls) {
      std::string entry;
      const auto add = [&](const char* name, double v) {
        if (!std::isnan(v)) entry += fmt::format("{}{} = {}", entry.empty() ? "" : ", ", name, v);
      };
      add("radius", ball.radius);
      add("mass", ball.mass);
      add("share", ball.share);
      list += "  { " + entry + " },\n";
    }
    return list.empty() ? "" : "[\n" + list + "]";
  }
  std::string operator()(const PointList&) const {
    std::string list;
    for (const auto& [height, across] : config.mill.lifters.points)
      list += fmt::format("{}[{}, {}]", list.empty() ? "" : ", ", height, across);
    return list.empty() ? "" : "[" + list + "]";
  }
  static std::string quoted(const char* name) { return std::string("\"") + name + "\""; }
};

}  // namespace

Config parse_config(const std::string& toml, const std::string& name, const std::vector<std::string>& sets) {
  Config config;
  config.file = name;
  try {
    const toml::table document = toml::parse(toml, name);
    Reader(config, name, true).read_table("", document);
  } catch (const toml::parse_error& e) {
    throw InputError(fmt::format("{}:{}", name, e.source().begin.line), "not valid TOML: " + one_line(e.description()));
  }
  return with_sets(std::move(config), sets);
}

Config with_sets(Config config, const std::vector<std::string>& sets) {
  for (const std::string& assignment : sets) apply_set(config, assignment);
  check(config);
  return config;
}

Config read_config(const std::filesystem::path& path, const std::vector<std::string>& sets) {
  return parse_config(read_text(path, "a MILL.toml", kLargestMiB), path.string(), sets);
}

std::string twin_of(const std::string& key) {
  const Key* known = find_key(key);
  return known ? known->excludes : "";
}

std::string to_toml(const Config& config) {
  Config fields = config;
  const Write write{config, fields};
  std::string text, section;
  for (const Key& key : config_keys()) {
    const std::string value = std::visit(write, key.field);
    if (value.empty()) continue;
    const std::string of = key.path.substr(0, key.path.rfind('.'));
    if (of != section) {
      text += fmt::format("{}[{}]\n", text.empty() ? "" : "\n", of);
      section = of;
    }
    text += fmt::format("{} = {}\n", key.path.substr(of.size() + 1), value);
  }
  for (const auto& [name, settings] : config.effects) {
    text += fmt::format("\n[effects.{}]\n", name);
    for (const auto& [key, values] : settings) {
      const bool list = find_parameter(*find_effect(name), key)->list;
      text += fmt::format("{} = {}{}{}\n", key, list ? "[" : "", fmt::join(values, ", "), list ? "]" : "");
    }
  }
  return text;
}

}  // namespace tumble::io
