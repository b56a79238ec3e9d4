#include "io/experiments_file.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>

#include "core/effects.h"
#include "core/error.h"
#include "io/config_file.h"
#include "io/config_keys.h"
#include "io/csv_file.h"
#include "io/text_file.h"

namespace tumble::io {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kLargestMiB = 4;  // ten thousand experiments
constexpr std::size_t kLongestName = 200;

// "power_W" has "power_uncertainty_W" beside it.
std::string uncertainty_name(const std::string& name) {
  const std::string unit = name.ends_with("_N_m") ? "_N_m" : name.substr(name.rfind('_'));
  return name.substr(0, name.size() - unit.size()) + "_uncertainty" + unit;
}

// No instrument is that good: a slip of the unit, or a number that says how well a mean is computed. A deviation from
// it would outweigh all other data.
constexpr double kLeastUncertainty = 1e-6;  // of the value, of an angle of a full turn

struct FileKey {
  const char* name;
  fs::path Experiment::*path;
};
constexpr std::array kFiles{FileKey{"film", &Experiment::film}, FileKey{"motion", &Experiment::motion},
                            FileKey{"tracks", &Experiment::tracks},
                            FileKey{"torque_series", &Experiment::torque_series}};

const std::vector<std::string>& known_keys() {
  static const std::vector<std::string> keys = [] {
    std::vector<std::string> names{"name", "set", "hold_out"};
    for (const ScalarDatum& d : kScalarData) {
      names.emplace_back(d.name);
      names.push_back(uncertainty_name(d.name));
    }
    for (const FileKey& f : kFiles) names.emplace_back(f.name);
    return names;
  }();
  return keys;
}

// A key of MILL.toml, effects included, that holds a number.
bool is_number_key(const std::string& path) {
  if (const Key* key = find_key(path))
    return std::holds_alternative<double& (*)(Config&)>(key->field) || std::holds_alternative<AutoNumber>(key->field) ||
           std::holds_alternative<std::optional<int>& (*)(Config&)>(key->field) ||
           std::holds_alternative<int& (*)(Config&)>(key->field);
  const auto dot = path.rfind('.');
  if (!path.starts_with("effects.") || dot < 8) return false;
  const Effect* effect = find_effect(path.substr(8, dot - 8));
  const EffectParameter* parameter = effect ? find_parameter(*effect, path.substr(dot + 1)) : nullptr;
  return parameter && !parameter->list;
}

// The nearest key that holds a number: another kind of key is no answer to who wants one.
std::string nearest_number_key(const std::string& path) {
  std::vector<std::string> numbers;
  for (const Key& key : config_keys())
    if (is_number_key(key.path)) numbers.push_back(key.path);
  const std::string nearest = nearest_key(path);
  return is_number_key(nearest) ? nearest : nearest_word(path, numbers);
}

// What a value (or its standard deviation) of a datum must be; empty where it is right.
std::string flaw_of(const ScalarDatum& d, bool is_uncertainty, double x) {
  if (is_uncertainty && !(x > 0)) return fmt::format("found {}, must be > 0 {}", x, d.unit);
  if (!is_uncertainty && d.is_direction && !(x >= 0 && x < 360))
    return fmt::format("found {}, must be an angle in degrees, 0 to below 360", x);
  return "";
}

struct Flaw {
  std::string key;  // where it shows; empty: in the experiment as a whole
  std::string problem;
};

// What is wrong with an experiment's data taken together, from whatever kind of file it comes.
std::optional<Flaw> flaw_of(const Experiment& e) {
  bool any = false;
  for (const ScalarDatum& d : kScalarData) {
    const Estimate& m = e.*d.measured;
    any = any || !std::isnan(m.value);
    if (!std::isnan(m.se) && std::isnan(m.value))
      return Flaw{uncertainty_name(d.name), uncertainty_name(d.name) + " without " + d.name};
    const double whole = d.is_direction ? 360 : std::abs(m.value);
    if (m.se < kLeastUncertainty * whole)
      return Flaw{uncertainty_name(d.name),
                  fmt::format("{} is {}, less than a millionth of {}; give one standard deviation of the measurement, "
                              "such as {:.2g} {}",
                              uncertainty_name(d.name), m.se, d.is_direction ? "a full turn" : d.name,
                              d.is_direction ? 1.0 : 0.01 * whole, d.unit)};
  }
  for (const FileKey& f : kFiles) any = any || !(e.*f.path).empty();
  if (!any)
    return Flaw{"",
                "brings no data; give power_W, torque_N_m, toe_deg, shoulder_deg, film, motion, tracks or "
                "torque_series"};
  if (!std::isnan(e.torque.value) && !std::isnan(e.power.value))
    return Flaw{"torque_N_m", "torque_N_m given beside power_W, which says the same; keep one of the two"};
  if (int(!e.film.empty()) + int(!e.motion.empty()) + int(!e.tracks.empty()) > 1)
    return Flaw{"", "more than one of film, motion and tracks; keep one, or name two experiments"};
  for (const auto& one : e.sets)
    for (const auto& other : e.sets)
      if (one.first == twin_of(other.first))
        return Flaw{"", "sets " + one.first + " and " + other.first + ", which say the same; keep one of the two"};
  return std::nullopt;
}

class Reader {
 public:
  Reader(std::string name, fs::path folder) : name_(std::move(name)), folder_(std::move(folder)) {}

  Experiments read(const toml::table& document) const {
    Experiments all;
    all.file = name_;
    for (const auto& [key, node] : document) {
      if (key == "experiment")
        read_list(all, node);
      else if (key == "uncertain")
        read_uncertain(all, node);
      else
        refuse_unknown(std::string(key.str()), "", node, {"experiment", "uncertain"});
    }
    if (all.list.empty()) throw InputError(name_, "holds no experiment; give [[experiment]] tables");
    return all;
  }

 private:
  std::string place(const toml::node& node) const { return fmt::format("{}:{}", name_, node.source().begin.line); }
  [[noreturn]] void fail(const toml::node& node, const std::string& key, const std::string& problem) const {
    throw InputError(place(node) + ": " + one_line(key), problem);
  }
  [[noreturn]] void refuse_unknown(const std::string& key, const std::string& in, const toml::node& node,
                                   const std::vector<std::string>& known) const {
    fail(node, in + key, "unknown key; did you mean " + nearest_word(key, known) + "?");
  }

  void read_list(Experiments& all, const toml::node& node) const {
    const toml::array* list = node.as_array();
    if (!list || !list->is_homogeneous(toml::node_type::table))
      fail(node, "experiment", "must be a list of tables: begin each experiment with [[experiment]]");
    for (const toml::node& entry : *list) {
      Experiment e = read_experiment(*entry.as_table());
      for (const Experiment& before : all.list)
        if (before.name == e.name)
          throw InputError(place(entry), "a second experiment named \"" + one_line(e.name) + "\"; give each its own");
      all.list.push_back(std::move(e));
    }
  }

  Experiment read_experiment(const toml::table& table) const {
    Experiment e;
    const toml::node* name = table.get("name");
    if (!name) throw InputError(place(table), "an experiment without a name; give name = \"...\"");
    e.name = text(*name, "name");
    if (e.name.size() > kLongestName) fail(*name, "name", "is too long; give at most 200 bytes");
    e.place = place(table) + ": " + one_line(e.name);

    for (const auto& [k, node] : table) {
      const std::string key(k.str());
      if (key == "name") continue;
      if (key == "hold_out") {
        if (!node.is_boolean()) fail(node, key, "must be true or false");
        e.hold_out = node.as_boolean()->get();
      } else if (key == "set") {
        if (!node.is_table()) fail(node, key, "must be a table such as { \"mill.speed\" = 0.7 }");
        read_sets(e, "", *node.as_table());
      } else if (!read_scalar(e, key, node) && !read_file(e, key, node)) {
        refuse_unknown(key, e.name + ": ", node, known_keys());
      }
    }
    if (const auto flaw = flaw_of(e)) {
      const toml::node* node = flaw->key.empty() ? nullptr : table.get(flaw->key);
      if (node) fail(*node, e.name, flaw->problem);
      throw InputError(e.place, flaw->problem);
    }
    return e;
  }

  // A table within is the dotted key's next part: { mill.speed = 0.7 } is { "mill.speed" = 0.7 }.
  void read_sets(Experiment& e, const std::string& prefix, const toml::table& table) const {
    for (const auto& [k, node] : table) {
      const std::string key = prefix + std::string(k.str());
      if (const toml::table* inner = node.as_table()) {
        read_sets(e, key + ".", *inner);
        continue;
      }
      std::ostringstream value;
      if (const auto* number = node.as_floating_point())
        value << fmt::format("{}", number->get());
      else
        node.visit([&](const auto& n) {
          if constexpr (toml::is_table<decltype(n)> || toml::is_array<decltype(n)>)
            value << toml::toml_formatter{n};
          else
            value << n;
        });
      if (key.find('=') != std::string::npos) fail(node, e.name + ": " + key, "is no key of MILL.toml");
      e.sets.emplace_back(key, value.str());
    }
  }

  bool read_scalar(Experiment& e, const std::string& key, const toml::node& node) const {
    for (const ScalarDatum& d : kScalarData) {
      const bool value = key == d.name;
      if (!value && key != uncertainty_name(d.name)) continue;
      const double x = number(node, e.name + ": " + key);
      if (const std::string flaw = flaw_of(d, !value, x); !flaw.empty()) fail(node, e.name + ": " + key, flaw);
      (value ? (e.*d.measured).value : (e.*d.measured).se) = x;
      return true;
    }
    return false;
  }

  bool read_file(Experiment& e, const std::string& key, const toml::node& node) const {
    for (const FileKey& f : kFiles) {
      if (key != f.name) continue;
      const fs::path path = folder_ / text(node, e.name + ": " + key);
      std::error_code error;
      if (!fs::exists(path, error)) fail(node, e.name + ": " + key, "no such file: " + path.string());
      e.*f.path = path;
      return true;
    }
    return false;
  }

  void read_uncertain(Experiments& all, const toml::node& node, const std::string& prefix = "") const {
    const toml::table* table = node.as_table();
    if (!table) fail(node, "uncertain", "must be a table: [uncertain]");
    for (const auto& [k, value] : *table) {
      const std::string key = prefix + std::string(k.str());
      if (value.is_table()) {
        read_uncertain(all, value, key + ".");
        continue;
      }
      if (!is_number_key(key))
        fail(value, "uncertain: " + key,
             "is no key of MILL.toml that holds a number; did you mean " + nearest_number_key(key) + "?");
      const double sd = number(value, "uncertain: " + key);
      if (!(sd > 0)) fail(value, "uncertain: " + key, fmt::format("found {}, must be a standard deviation, > 0", sd));
      all.uncertain.push_back({key, sd, place(value) + ": " + key});
    }
  }

  std::string text(const toml::node& node, const std::string& key) const {
    if (!node.is_string() || node.as_string()->get().empty()) fail(node, key, "must be a text in quotes");
    return node.as_string()->get();
  }

  double number(const toml::node& node, const std::string& key) const {
    double value = kNotGiven;
    if (const auto* f = node.as_floating_point()) value = f->get();
    if (const auto* i = node.as_integer()) value = static_cast<double>(i->get());
    if (!std::isfinite(value)) fail(node, key, "must be a number");
    return value;
  }

  std::string name_;
  fs::path folder_;
};

// What an experiment says of its own speed and filling errs as the mill's [measurement] has it.
Config put_right(Config config, const Experiment& experiment) {
  const double speed = config.measurement.speed_error, filling = config.measurement.filling_error;
  for (const auto& [key, value] : experiment.sets) {
    if (key == "mill.speed" && !std::isnan(speed)) config.mill.speed *= 1 + speed;
    if (key == "mill.speed_rpm" && !std::isnan(speed)) config.mill.speed_rpm *= 1 + speed;
    if (key == "charge.filling" && !std::isnan(filling)) config.charge.filling *= 1 + filling;
    if (key == "charge.count" && !std::isnan(filling))
      config.charge.count = static_cast<int>(std::lround(*config.charge.count * (1 + filling)));
  }
  return config;
}

}  // namespace

Experiments parse_experiments(const std::string& toml, const std::string& name, const fs::path& folder) {
  try {
    return Reader(name, folder).read(toml::parse(toml, name));
  } catch (const toml::parse_error& e) {
    throw InputError(fmt::format("{}:{}", name, e.source().begin.line), "not valid TOML: " + one_line(e.description()));
  }
}

Experiments read_experiments(const fs::path& path) {
  const std::string text = read_text(path, "an EXPERIMENTS.toml", kLargestMiB);
  return parse_experiments(text, path.string(), path.parent_path());
}

Experiments read_measured(const fs::path& path) {
  if (path.extension() != ".csv") return read_experiments(path);
  const CsvTable table = read_csv(path);
  std::vector<std::string> known{"name", "hold_out"};
  for (const ScalarDatum& d : kScalarData) {
    known.emplace_back(d.name);
    known.push_back(uncertainty_name(d.name));
  }
  std::vector<std::string> keys;  // a dot tells a key of MILL.toml
  for (const std::string& column : table.columns())
    if (column.find('.') != std::string::npos) keys.push_back(column);
  known.insert(known.end(), keys.begin(), keys.end());
  table.check_columns(known);

  Experiments all;
  all.file = path.string();
  all.list.resize(table.rows());
  const auto names = table.texts("name", true), hold_out = table.texts("hold_out", true);
  for (std::size_t i = 0; i < all.list.size(); ++i) {
    Experiment& e = all.list[i];
    e.name = names[i].empty() ? fmt::format("row {}", i + 1) : names[i];
    e.place = fmt::format("{}: {}", table.place(), e.name);
    e.hold_out = hold_out[i] == "true";
    if (!e.hold_out && !hold_out[i].empty() && hold_out[i] != "false")
      throw InputError(table.place(i, "hold_out"), "is \"" + hold_out[i] + "\"; give true or false");
  }
  for (const std::string& key : keys) {
    const auto values = table.texts(key, true);
    for (std::size_t i = 0; i < all.list.size(); ++i)
      if (!values[i].empty()) all.list[i].sets.emplace_back(key, values[i]);
  }
  for (const ScalarDatum& d : kScalarData) {
    for (const bool is_uncertainty : {false, true}) {
      const std::string column = is_uncertainty ? uncertainty_name(d.name) : d.name;
      const auto values = table.numbers(column, true);
      for (std::size_t i = 0; i < all.list.size(); ++i) {
        Estimate& measured = all.list[i].*d.measured;
        (is_uncertainty ? measured.se : measured.value) = values[i];
        if (std::isnan(values[i])) continue;
        if (const std::string flaw = flaw_of(d, is_uncertainty, values[i]); !flaw.empty())
          throw InputError(table.place(i, column), column + ": " + flaw);
      }
    }
  }
  for (std::size_t i = 0; i < all.list.size(); ++i)
    if (const auto flaw = flaw_of(all.list[i]))
      throw InputError(table.place(i, flaw->key.empty() ? table.columns().front() : flaw->key), flaw->problem);
  return all;
}

Config config_of(const Config& mill, const Experiment& experiment, const std::vector<std::string>& more) {
  std::vector<std::string> sets;
  for (const auto& [key, value] : experiment.sets) sets.push_back(key + "=" + value);
  try {
    return with_sets(put_right(with_sets(mill, sets), experiment), more);
  } catch (const InputError& e) {
    const std::string said = e.what(), mark = "--set: ";
    if (!said.starts_with(mark)) throw;
    throw InputError(experiment.place, said.substr(mark.size()));
  }
}

}  // namespace tumble::io
