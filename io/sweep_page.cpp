#include "io/sweep_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/angle.h"
#include "core/effects.h"
#include "core/version.h"
#include "io/config_keys.h"
#include "io/experiments_file.h"
#include "io/report/html.h"
#include "io/sweep_file.h"

namespace tumble::io {
namespace {

constexpr std::size_t kMostLines = 12;  // in one plot: more cannot be told apart
constexpr std::size_t kMostRows = 200;  // of the table of points; the CSV has them all
constexpr int kMeasuredColour = 0;

const std::string kMeasured = "measured, ";  // before what else an experiment sets

struct Figure {
  const char* quantity;
  const char* title;
  const char* measured;  // name in EXPERIMENTS.toml; "" where there is none
  bool from_zero;
};
constexpr std::array kFigures{
    Figure{"mill_power_W", "Power of the mill", "power_W", true},
    Figure{"mill_torque_N_m", "Torque of the mill", "torque_N_m", true},
    Figure{"toe_deg", "Toe", "toe_deg", false},
    Figure{"shoulder_deg", "Shoulder", "shoulder_deg", false},
    Figure{"toe_bulk_deg", "Toe of the bulk", "toe_bulk_deg", false},
    Figure{"shoulder_bulk_deg", "Shoulder of the bulk", "shoulder_bulk_deg", false},
    Figure{"head_m", "Head", "", false},
    Figure{"departure_deg", "Departure", "", false},
};

const ScalarDatum* datum(const std::string& name) {
  for (const ScalarDatum& d : kScalarData)
    if (name == d.name) return &d;
  return nullptr;
}

// The varied key whose values are numbers, and most; the first of equals.
std::size_t axis_key(const Sweep& sweep) {
  std::size_t best = sweep.varied.size(), most = 0;
  for (std::size_t k = 0; k < sweep.varied.size(); ++k) {
    const auto& values = sweep.varied[k].values;
    if (std::any_of(values.begin(), values.end(), [](const auto& v) { return std::isnan(number_of(v)); })) continue;
    if (values.size() > most) best = k, most = values.size();
  }
  return best;
}

// "charge.count = 120, contact.friction = 0.2": the others' values.
std::string label_of(const Sweep& sweep, std::size_t point, std::size_t axis) {
  std::string text;
  const auto index = sweep.at(point);
  for (std::size_t k = 0; k < index.size(); ++k)
    if (k != axis)
      text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", sweep.varied[k].key, sweep.varied[k].values[index[k]]);
  return text;
}

// Measured points against the key, by what else the experiments set.
std::vector<PlotSeries> measured_series(const Experiments& measured, const Config& mill, const std::string& key,
                                        const ScalarDatum& d) {
  std::map<std::string, PlotSeries> by_rest;
  for (const Experiment& e : measured.list) {
    const Estimate& m = e.*d.measured;
    if (std::isnan(m.value)) continue;
    std::string rest;
    for (const auto& [k, value] : e.sets) {
      const bool same = k == key || (k.starts_with("mill.speed") && key.starts_with("mill.speed"));
      if (!same) rest += fmt::format("{}{} = {}", rest.empty() ? "" : ", ", k, value);
    }
    PlotSeries& s = by_rest[rest];
    s.label = rest.empty() ? "measured" : kMeasured + rest;
    s.x.push_back(number_at(config_of(mill, e), key));
    s.y.push_back(m.value);
    s.se.push_back(m.se);
  }
  std::vector<PlotSeries> list;
  for (auto& [rest, s] : by_rest) {
    s.mark = PlotMark::kPoints;
    if (by_rest.size() == 1) s.colour = kMeasuredColour;
    list.push_back(std::move(s));
  }
  return list;
}

// Directions to either side of 0 degrees are to lie side by side: -3, not 357.
void unwind(Plot& plot) {
  double c = 0, s = 0;
  for (const PlotSeries& series : plot.series)
    for (const double y : series.y)
      if (!std::isnan(y)) c += std::cos(radians(y)), s += std::sin(radians(y));
  const double middle = degrees(std::atan2(s, c));
  const double origin = middle < -90 ? middle + 360 : middle;
  for (PlotSeries& series : plot.series)
    for (double& y : series.y) y = origin + wrap_180(y - origin);
}

Plot plot_of(const Figure& figure, const Sweep& sweep, const Config& mill, const Experiments& measured,
             std::size_t axis) {
  const RunQuantity& quantity = run_quantity(figure.quantity);
  Plot plot;
  plot.title = figure.title;
  plot.x_label = sweep.varied[axis].key;
  plot.y_label = quantity.unit;
  plot.y_from_zero = figure.from_zero;
  std::vector<std::string> labels;
  for (std::size_t p = 0; p < sweep.points(); ++p) {
    const std::string label = label_of(sweep, p, axis);
    auto at = std::find(labels.begin(), labels.end(), label);
    if (at == labels.end()) {
      if (labels.size() == kMostLines) continue;
      labels.push_back(label);
      plot.series.emplace_back();
      plot.series.back().label = label.empty() ? "simulated" : label;
      at = labels.end() - 1;
    }
    PlotSeries& s = plot.series[static_cast<std::size_t>(at - labels.begin())];
    const Estimate e = over_repeats(sweep, p, quantity);
    s.x.push_back(number_of(sweep.varied[axis].values[sweep.at(p)[axis]]));
    s.y.push_back(e.value);
    s.se.push_back(e.se);
  }
  for (std::size_t i = 0; i < plot.series.size(); ++i) plot.series[i].colour = static_cast<int>(i) + 1;
  if (const ScalarDatum* d = datum(figure.measured))
    for (PlotSeries& s : measured_series(measured, mill, plot.x_label, *d)) {
      const auto at =
          std::find(labels.begin(), labels.end(), s.label.substr(std::min(s.label.size(), kMeasured.size())));
      if (labels.size() > 1 && at != labels.end()) s.colour = static_cast<int>(at - labels.begin()) + 1;
      plot.series.push_back(std::move(s));
    }
  if (quantity.is_direction) unwind(plot);
  return plot;
}

PageTable table_of(const Sweep& sweep) {
  PageTable table;
  table.title = "Points";
  const std::vector<const char*> names{"torque_N_m", "mill_power_W", "toe_deg", "shoulder_deg"};
  for (const VariedKey& v : sweep.varied) table.header.push_back(v.key);
  for (const char* name : names) table.header.emplace_back(name);
  table.header.emplace_back("failed");
  for (std::size_t p = 0; p < std::min(sweep.points(), kMostRows); ++p) {
    std::vector<std::string> row;
    const auto index = sweep.at(p);
    for (std::size_t k = 0; k < index.size(); ++k) row.push_back(sweep.varied[k].values[index[k]]);
    for (const char* name : names) row.push_back(report::with_error(over_repeats(sweep, p, run_quantity(name))));
    std::size_t failed = 0;
    for (std::size_t i = p * sweep.repeats; i < (p + 1) * sweep.repeats; ++i) failed += !sweep.runs[i].error.empty();
    row.push_back(failed ? std::to_string(failed) : "");
    table.rows.push_back(std::move(row));
  }
  table.note = sweep.repeats > 1
                   ? "Mean and standard error over the repeats. torque_N_m is of one slice."
                   : "One run each, with the standard error that the run says of itself. torque_N_m is of one slice.";
  if (sweep.points() > kMostRows) table.note += fmt::format(" The first {} of {} points.", kMostRows, sweep.points());
  return table;
}

}  // namespace

PlotPage sweep_page(const Sweep& sweep, const Config& mill, const Experiments& measured) {
  PlotPage page;
  page.kind = "Sweep";
  page.version = kVersion;
  std::string keys;
  for (const VariedKey& v : sweep.varied) keys += (keys.empty() ? "" : " and ") + v.key;
  page.title = fmt::format("{} runs over {}", sweep.runs.size(), keys);
  page.lead = fmt::format("{} points with {} run{} each. Bars are one standard error.", sweep.points(), sweep.repeats,
                          sweep.repeats == 1 ? "" : "s");
  std::size_t failed = 0, unsteady = 0, locked = 0;
  for (const RunOutcome& run : sweep.runs) {
    failed += !run.error.empty();
    unsteady += run.error.empty() && !run.steady;
    locked += run.locked_balls > 0 && run.motion[motion_index("speed_fraction")].value < 1;
  }
  if (failed) page.caveats.push_back(fmt::format("{} of {} runs failed and do not count.", failed, sweep.runs.size()));
  if (unsteady) page.caveats.push_back(fmt::format("{} runs were not steady over the averaged revolutions.", unsteady));
  if (locked)
    page.caveats.push_back(fmt::format(
        "{} runs end with balls locked between the lifters, which lowers the torque: an artefact of the plane slice.",
        locked));

  const std::size_t axis = axis_key(sweep);
  PageSection figures;
  figures.heading = "Figures";
  if (axis == sweep.varied.size()) {
    figures.paragraphs.push_back("No varied key has numbers for values: the table tells all.");
  } else {
    for (const Figure& figure : kFigures) figures.plots.push_back(plot_of(figure, sweep, mill, measured, axis));
    if (sweep.points() / sweep.varied[axis].values.size() > kMostLines)
      figures.paragraphs.push_back(
          fmt::format("Only the first {} combinations of the other keys are drawn.", kMostLines));
  }
  page.sections.push_back(std::move(figures));
  PageSection table;
  table.heading = "Numbers";
  table.tables.push_back(table_of(sweep));
  page.sections.push_back(std::move(table));
  PageSection config;
  config.heading = "The mill";
  config.paragraphs.push_back("MILL.toml before anything was varied:");
  config.code = sweep.mill_toml;
  page.sections.push_back(std::move(config));
  return page;
}

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
