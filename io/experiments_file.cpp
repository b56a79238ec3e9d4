#include "io/experiments_file.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "core/effects.h"
#include "core/error.h"
#include "io/config_file.h"
#include "io/config_keys.h"
#include "io/csv_file.h"

namespace tumble::io {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kLargestFile = 4 << 20;  // [bytes]; ten thousand experiments
constexpr std::size_t kLongestName = 200;

std::string one_line(std::string_view text) {
  std::string line(text);
  std::replace_if(
      line.begin(), line.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return line.size() > 300 ? line.substr(0, 300) + " ..." : line;
}

// "power_W" has "power_uncertainty_W" beside it.
std::string uncertainty_name(const std::string& name) {
  const std::string unit = name.ends_with("_N_m") ? "_N_m" : name.substr(name.rfind('_'));
  return name.substr(0, name.size() - unit.size()) + "_uncertainty" + unit;
}

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
    check(e, table);
    return e;
  }

  void check(const Experiment& e, const toml::table& table) const {
    bool any = false;
    for (const ScalarDatum& d : kScalarData) {
      const Estimate& m = e.*d.measured;
      any = any || !std::isnan(m.value);
      if (!std::isnan(m.se) && std::isnan(m.value))
        fail(*table.get(uncertainty_name(d.name)), e.name, uncertainty_name(d.name) + " without " + d.name);
    }
    for (const FileKey& f : kFiles) any = any || !(e.*f.path).empty();
    if (!any)
      throw InputError(e.place,
                       "brings no data; give power_W, torque_N_m, toe_deg, shoulder_deg, film, motion, tracks "
                       "or torque_series");
    if (const auto* node = table.get("torque_N_m"); node && table.contains("power_W"))
      fail(*node, e.name, "torque_N_m given beside power_W, which says the same; keep one of the two");
    if (int(!e.film.empty()) + int(!e.motion.empty()) + int(!e.tracks.empty()) > 1)
      throw InputError(e.place, "more than one of film, motion and tracks; keep one, or name two experiments");
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
      if (value && d.is_direction && !(x >= 0 && x < 360))
        fail(node, e.name + ": " + key, fmt::format("found {}, must be an angle in degrees, 0 to below 360", x));
      if (!value && !(x > 0)) fail(node, e.name + ": " + key, fmt::format("found {}, must be > 0 {}", x, d.unit));
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
             "is no key of MILL.toml that holds a number; did you mean " + nearest_key(key) + "?");
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

}  // namespace

Experiments parse_experiments(const std::string& toml, const std::string& name, const fs::path& folder) {
  try {
    return Reader(name, folder).read(toml::parse(toml, name));
  } catch (const toml::parse_error& e) {
    throw InputError(fmt::format("{}:{}", name, e.source().begin.line), "not valid TOML: " + one_line(e.description()));
  }
}

Experiments read_experiments(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) throw InputError(path.string(), "no such file; give an EXPERIMENTS.toml");
  if (fs::is_directory(path, error)) throw InputError(path.string(), "is a folder; give an EXPERIMENTS.toml");
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  std::string text(kLargestFile + 1, '\0');
  if (file) file.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (!file && !file.eof()) throw InputError(path.string(), std::string("cannot be read: ") + std::strerror(errno));
  text.resize(static_cast<std::size_t>(file.gcount()));
  if (text.size() > kLargestFile)
    throw InputError(path.string(),
                     "is larger than 4 MiB, so hardly an EXPERIMENTS.toml; data go into files of their own");
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
    const auto values = table.numbers(d.name, true), sds = table.numbers(uncertainty_name(d.name), true);
    for (std::size_t i = 0; i < all.list.size(); ++i) {
      all.list[i].*d.measured = {values[i], sds[i]};
      if (!std::isnan(sds[i]) && !(sds[i] > 0))
        throw InputError(table.place(i, uncertainty_name(d.name)), "must be > 0");
    }
  }
  return all;
}

Config config_of(const Config& mill, const Experiment& experiment, const std::vector<std::string>& more) {
  std::vector<std::string> all;
  for (const auto& [key, value] : experiment.sets) all.push_back(key + "=" + value);
  all.insert(all.end(), more.begin(), more.end());
  try {
    return with_sets(mill, all);
  } catch (const InputError& e) {
    const std::string said = e.what(), mark = "--set: ";
    if (!said.starts_with(mark)) throw;
    throw InputError(experiment.place, said.substr(mark.size()));
  }
}

}  // namespace tumble::io
