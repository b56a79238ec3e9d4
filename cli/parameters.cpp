#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "cli/findings.h"
#include "cli/options.h"
#include "cli/verbs.h"
#include "core/error.h"
#include "io/csv_file.h"
#include "io/output.h"

namespace tumble::cli {
namespace {

namespace fs = std::filesystem;
using diagnose::Bounce;
using diagnose::BounceKind;
using diagnose::LoadCellDrop;

const std::vector<std::string> kLoadCellColumns{"ball_mass_kg",     "fall_height_m", "particle_layers",
                                                "particle_size_mm", "max_force_N",   "max_displacement_mm",
                                                "stiffness_N_per_m"};
const std::vector<std::string> kDropColumns{
    "fall_height_m", "rebound_height_m", "fall_height_uncertainty_m", "rebound_height_uncertainty_m",
    "ball_mass_kg",  "ball_radius_m"};
const std::vector<std::string> kPendulumColumns{
    "fall_height_m", "rebound_height_m", "fall_height_uncertainty_m", "rebound_height_uncertainty_m",
    "ball_mass_kg",  "ball_radius_m",    "striker_mass_kg",           "target_mass_kg"};

struct Options : CommonOptions {
  std::string experiment;
  fs::path data, output;
  double stiffness = kNotGiven, restitution = kNotGiven;
  int layers = -1;
};

// A column of numbers that are all > 0 (or not given, where they may be).
std::vector<double> positive(const io::CsvTable& table, const std::string& column, bool may_be_empty = false) {
  std::vector<double> values = table.numbers(column, may_be_empty);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i] <= 0) throw InputError(table.place(i, column), column + " must be above 0");
  return values;
}

std::vector<double> uncertainties(const io::CsvTable& table, const std::string& column) {
  std::vector<double> values = table.numbers(column, true);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] < 0) throw InputError(table.place(i, column), column + " must not be negative");
    if (std::isnan(values[i])) values[i] = 0;
  }
  return values;
}

std::vector<LoadCellDrop> read_load_cell(const io::CsvTable& table) {
  table.check_columns(kLoadCellColumns);
  const auto mass = positive(table, "ball_mass_kg"), height = positive(table, "fall_height_m"),
             force = positive(table, "max_force_N"), displacement = positive(table, "max_displacement_mm"),
             given = positive(table, "stiffness_N_per_m", true);
  const auto layers = table.numbers("particle_layers", true);
  const auto size = table.texts("particle_size_mm", true);
  std::vector<LoadCellDrop> drops(table.rows());
  for (std::size_t i = 0; i < drops.size(); ++i) {
    const double count = std::isnan(layers[i]) ? 0 : layers[i];
    if (count < 0 || count > 1000 || count != std::floor(count))
      throw InputError(table.place(i, "particle_layers"), "particle_layers must be a whole number, 0 for bare metal");
    drops[i] = {mass[i], height[i], force[i], displacement[i] * 1e-3, static_cast<int>(count), size[i], given[i]};
    // A spring gives E = F d / 2, any law that stiffens more: far from it, a unit is wrong.
    const diagnose::DropStiffness k = stiffness_of(drops[i]);
    if (k.by_energy > 20 * k.by_slope || k.by_slope > 20 * k.by_energy)
      throw InputError(table.place(i, "max_force_N"),
                       "force x displacement is not near twice the energy of the fall; check the units");
  }
  return drops;
}

std::vector<Bounce> read_bounces(const io::CsvTable& table, BounceKind kind) {
  const bool drop = kind == BounceKind::kDrop;
  table.check_columns(drop ? kDropColumns : kPendulumColumns);
  const auto fall = positive(table, "fall_height_m");
  const auto rebound = table.numbers("rebound_height_m");
  const auto fall_u = uncertainties(table, "fall_height_uncertainty_m"),
             rebound_u = uncertainties(table, "rebound_height_uncertainty_m");
  const bool two = !drop && (table.has("striker_mass_kg") || table.has("target_mass_kg"));
  if (two && table.has("ball_mass_kg"))
    throw InputError(table.place(),
                     "has ball_mass_kg beside striker_mass_kg and target_mass_kg; give ball_mass_kg where both balls "
                     "have one mass, else the other two");
  const auto mass = positive(table, two ? "striker_mass_kg" : "ball_mass_kg", !two);
  const auto target = positive(table, two ? "target_mass_kg" : "ball_mass_kg", !two);
  const auto radius = positive(table, "ball_radius_m", true);
  std::vector<Bounce> bounces(table.rows());
  for (std::size_t i = 0; i < bounces.size(); ++i) {
    if (rebound[i] < 0) throw InputError(table.place(i, "rebound_height_m"), "rebound_height_m must not be negative");
    bounces[i] = {fall[i], rebound[i], fall_u[i], rebound_u[i], mass[i], radius[i], drop ? kNotGiven : target[i]};
    // Noise may take a value a little out of what can be; more than that is a mistake.
    const double e = impact_of(bounces[i], kind).restitution.value;
    if (e > 1.1 || e < -0.1)
      throw InputError(table.place(i, "rebound_height_m"),
                       fmt::format("gives a restitution of {:.3g}, which no impact has; check both heights{}", e,
                                   drop ? "" : " and which ball was at rest"));
  }
  return bounces;
}

void parameters(const Options& o) {
  const auto names = std::map<std::string, int>{{"load-cell", 0}, {"drop", 1}, {"pendulum", 2}};
  const int experiment = parse_name(o.experiment, "parameters", names);
  const auto only = [&](bool given, const char* option, bool fits, const char* where) {
    if (given && !fits) throw InputError(option, std::string("is for ") + where + " alone; leave it out");
  };
  only(!std::isnan(o.stiffness), "--stiffness", experiment != 0, "drop and pendulum");
  only(!std::isnan(o.restitution), "--restitution", experiment == 0, "load-cell");
  only(o.layers >= 0, "--layers", experiment == 0, "load-cell");
  if (!std::isnan(o.stiffness) && !(o.stiffness > 0 && std::isfinite(o.stiffness)))
    throw InputError("--stiffness", "must be above 0, in N/m");
  if (!std::isnan(o.restitution) && !(o.restitution > 0 && o.restitution <= 1))
    throw InputError("--restitution", "must be above 0 and at most 1");
  if (!o.output.empty()) {
    io::check_not_input(o.output, o.data);
    io::check_output_file(o.output, o.force);
  }

  const io::CsvTable table = io::read_csv(o.data);
  Findings findings;
  if (experiment == 0) {
    const auto groups = diagnose::stiffness_groups(read_load_cell(table));
    if (o.layers >= 0 && std::none_of(groups.begin(), groups.end(),
                                      [&](const auto& group) { return group.particle_layers == o.layers; }))
      throw InputError("--layers", fmt::format("{} has no drops on {} layers of particles", table.place(), o.layers));
    findings = findings_of(groups, o.layers, o.restitution);
  } else {
    const BounceKind kind = experiment == 1 ? BounceKind::kDrop : BounceKind::kPendulum;
    findings =
        findings_of(restitution_from(read_bounces(table, kind), kind, {o.stiffness, kNotGiven}), kind, o.stiffness);
  }
  for (const std::string& caveat : findings.caveats) say(o, "note: " + caveat);
  if (!o.output.empty()) io::write_plot_page(o.output, page_of(findings));
  print(o.json ? findings.json.dump(2) + "\n" : text_of(findings));
}

}  // namespace

void add_parameters(CLI::App& app) {
  auto o = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("parameters", "Stiffness, restitution and damping from the paper's experiments");
  verb->add_option("experiment", o->experiment, "load-cell, drop or pendulum")->required();
  verb->add_option("data", o->data, "DATA.csv; its columns: docs/parameters.md")->required();
  verb->add_option("-o,--output", o->output, "PAGE.html to write: numbers, plots and lines for MILL.toml");
  verb->add_option("--stiffness", o->stiffness, "drop, pendulum: contact stiffness for the damping constant, N/m");
  verb->add_option("--restitution", o->restitution, "load-cell: restitution for the damping constant");
  verb->add_option("--layers", o->layers, "load-cell: layers of particles of the drops that MILL.toml gets");
  add_common(*verb, *o);
  verb->footer("Example: tumble parameters drop examples/experiments/drop.csv -o drop.html --stiffness 4e5");
  verb->callback([o] { parameters(*o); });
}

}  // namespace tumble::cli
