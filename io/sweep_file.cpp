#include "io/sweep_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <sstream>

#include "core/error.h"
#include "core/version.h"
#include "io/csv_file.h"
#include "io/hdf5.h"
#include "io/output.h"

namespace tumble::io {
namespace fs = std::filesystem;
namespace {

const char* const kWanted = "a sweep, SWEEP.h5";
constexpr std::size_t kMostErrorText = 1 << 19;  // [bytes]; the CSV has them all

void write_numbers(hid_t file, const std::string& path, std::vector<double> values, const std::string& unit) {
  for (double& v : values)
    if (!std::isfinite(v)) v = kNotGiven;
  hdf5::write_array<double>(file, path, values, {values.size()}, unit);
}

// The value of each varied key; where they are names, their place in the list, which stands beside them.
void write_varied(hid_t file, const Sweep& sweep) {
  for (std::size_t k = 0; k < sweep.varied.size(); ++k) {
    const VariedKey& varied = sweep.varied[k];
    bool names = false;
    std::string list;
    for (const std::string& v : varied.values) {
      names = names || std::isnan(number_of(v));
      list += v + "\n";
    }
    std::vector<double> of_run, of_point;
    for (std::size_t p = 0; p < sweep.points(); ++p) {
      const std::size_t i = sweep.at(p)[k];
      of_point.push_back(names ? double(i) : number_of(varied.values[i]));
      of_run.insert(of_run.end(), sweep.repeats, of_point.back());
    }
    write_numbers(file, "runs/" + varied.key, of_run, {});
    write_numbers(file, "points/" + varied.key, of_point, {});
    hdf5::make_string(file, "varied/" + varied.key, list);
  }
}

void write_points(hid_t file, const Sweep& sweep) {
  for (const RunQuantity& q : run_quantities()) {
    std::vector<double> value, se, within;
    for (std::size_t p = 0; p < sweep.points(); ++p) {
      const auto repeats = at_point(sweep, p, q);
      const Estimate mean = mean_of_repeats(repeats, q.is_direction);
      value.push_back(mean.value);
      se.push_back(mean.se);
      within.push_back(se_within_repeats(repeats));
    }
    write_numbers(file, "points/" + q.name, value, q.unit);
    write_numbers(file, "points/" + q.se_name(), se, q.unit);
    write_numbers(file, "points/" + q.se_name() + "_within", within, q.unit);
  }
}

void write_all(hid_t file, const Sweep& sweep) {
  hdf5::set_attribute(file, "kind", std::string("tumble_sweep"));
  hdf5::set_attribute(file, "schema_version", std::vector<int>{1, 0});
  hdf5::make_string(file, "definition", definition_of(sweep));
  hdf5::make_string(file, "mill_toml", sweep.mill_toml);
  write_varied(file, sweep);
  std::vector<std::uint64_t> seeds;
  for (std::size_t i = 0; i < sweep.runs.size(); ++i) seeds.push_back(sweep.first_seed + i % sweep.repeats);
  hdf5::write_array<std::uint64_t>(file, "runs/seed", seeds, {seeds.size()});
  for (const RunColumn& c : run_columns()) {
    std::vector<double> values;
    for (const RunOutcome& run : sweep.runs) values.push_back(c.of(run));
    write_numbers(file, "runs/" + c.name, values, c.unit);
  }
  std::string errors;
  for (std::size_t i = 0; i < sweep.runs.size() && errors.size() < kMostErrorText; ++i)
    if (!sweep.runs[i].error.empty()) errors += fmt::format("run {}: {}\n", i, sweep.runs[i].error);
  hdf5::make_string(file, "errors", errors);
  write_points(file, sweep);
}

template <typename Read>
auto from_sweep(const fs::path& path, const Read& read) {
  const auto held = hdf5::lock();
  const hdf5::File file = hdf5::open_input(path, kWanted);
  try {
    return read(file);
  } catch (const hdf5::Failure&) {
    throw InputError(path.string(), std::string("is an HDF5 file of another kind; give ") + kWanted);
  }
}

}  // namespace

void write_sweep(const fs::path& path, const Sweep& sweep) {
  StagedFile staged(path);
  try {
    const auto held = hdf5::lock();
    hdf5::File file = hdf5::create_file(staged.path());
    write_all(file, sweep);
    hdf5::close_file(std::move(file));
  } catch (const hdf5::Failure& e) {
    throw WorkError(path.string(), e.what());
  }
  staged.commit();
}

void write_sweep_csv(const fs::path& path, const Sweep& sweep) {
  std::string text;
  for (const VariedKey& v : sweep.varied) text += csv_text(v.key) + ",";
  text += "seed" + csv_header() + "\n";
  for (std::size_t i = 0; i < sweep.runs.size(); ++i) {
    const auto index = sweep.at(i / sweep.repeats);
    for (std::size_t k = 0; k < sweep.varied.size(); ++k) text += csv_text(sweep.varied[k].values[index[k]]) + ",";
    text += fmt::format("{}{}\n", sweep.first_seed + i % sweep.repeats, csv_cells(sweep.runs[i]));
  }
  write_text(path, text);
}

std::string definition_of(const Sweep& sweep) {
  std::string text = fmt::format("tumble {}\nseed {}, {} repeats\n", kVersion, sweep.first_seed, sweep.repeats);
  for (const VariedKey& v : sweep.varied) {
    text += v.key;
    for (std::size_t i = 0; i < v.values.size(); ++i) text += (i == 0 ? " = " : " | ") + v.values[i];
    text += "\n";
  }
  return text + sweep.mill_toml;
}

std::string read_sweep_definition(const fs::path& path) {
  return from_sweep(path, [](hid_t file) { return hdf5::read_string(file, "definition"); });
}

std::vector<RunOutcome> read_sweep_runs(const fs::path& path, const Sweep& definition) {
  const std::size_t count = definition.points() * definition.repeats;
  return from_sweep(path, [&](hid_t file) {
    std::vector<RunOutcome> runs(count);
    const auto read = [&](const std::string& column, const auto& field) {
      const auto values = hdf5::read_array<double>(file, "runs/" + column, count);
      if (values.size() != count) throw hdf5::Failure(column + " is too short");
      for (std::size_t i = 0; i < count; ++i) field(runs[i]) = values[i];
    };
    for (std::size_t q = 0; q < kMotionQuantities.size(); ++q) {
      const std::string name = kMotionQuantities[q].name, se = RunQuantity{name, {}, false, {}}.se_name();
      read(name, [q](RunOutcome& run) -> double& { return run.motion[q].value; });
      if (hdf5::exists(file, "runs/" + se)) read(se, [q](RunOutcome& run) -> double& { return run.motion[q].se; });
    }
    read("power_W", [](RunOutcome& run) -> double& { return run.power.value; });
    read("power_se_W", [](RunOutcome& run) -> double& { return run.power.se; });
    read("slices", [](RunOutcome& run) -> double& { return run.slices; });
    read("energy_error", [](RunOutcome& run) -> double& { return run.energy_error; });
    read("locked_balls", [](RunOutcome& run) -> double& { return run.locked_balls; });
    read("spin_up_revolutions", [](RunOutcome& run) -> double& { return run.spin_up_revolutions; });
    std::vector<double> steady(count);
    read("steady", [&](RunOutcome& run) -> double& { return steady[static_cast<std::size_t>(&run - runs.data())]; });
    std::istringstream errors(hdf5::read_string(file, "errors"));
    std::map<std::size_t, std::string> why;
    std::string word, text;
    for (std::size_t i = 0; errors >> word >> i && std::getline(errors.ignore(2), text);) why[i] = text;
    for (std::size_t i = 0; i < count; ++i) {
      if (std::isnan(steady[i])) runs[i].error = why.contains(i) ? why[i] : "failed; why is not kept";
      runs[i].steady = steady[i] == 1;
    }
    return runs;
  });
}

std::vector<Estimate> at_point(const Sweep& sweep, std::size_t point, const RunQuantity& quantity) {
  std::vector<Estimate> repeats;
  for (std::size_t i = point * sweep.repeats; i < (point + 1) * sweep.repeats; ++i)
    if (const Estimate e = quantity.of(sweep.runs[i]); !std::isnan(e.value)) repeats.push_back(e);
  return repeats;
}

Estimate over_repeats(const Sweep& sweep, std::size_t point, const RunQuantity& quantity) {
  return mean_of_repeats(at_point(sweep, point, quantity), quantity.is_direction);
}

double number_of(const std::string& value) {
  char* end = nullptr;
  const double number = std::strtod(value.c_str(), &end);
  return end != value.c_str() && *end == '\0' ? number : kNotGiven;
}

}  // namespace tumble::io
