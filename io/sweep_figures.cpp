#include "io/sweep_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "core/angle.h"
#include "core/morrell.h"
#include "io/config_file.h"
#include "io/config_keys.h"
#include "io/csv_file.h"
#include "io/experiments_file.h"
#include "io/figure_file.h"
#include "io/output.h"
#include "io/sweep_file.h"

namespace tumble::io {
namespace fs = std::filesystem;
namespace {

constexpr int kMeasuredColour = 0;
constexpr std::size_t kFewestOfAxis = 3;  // values of a key that is worth a figure of its own
constexpr int kCurvePlaces = 80;          // at which a formula is drawn

const std::string kMeasured = "measured", kMorrell = "Morrell (1996)";

struct Quantity {
  const char* name;
  const char* title;
  const char* unit;      // for a reader
  const char* measured;  // name in EXPERIMENTS.toml; "" where there is none
  bool from_zero;
  double ToeAndShoulder::*morrell;
};
constexpr std::array kQuantities{
    Quantity{"mill_power_W", "Power of the mill", "W", "power_W", true, nullptr},
    Quantity{"mill_torque_N_m", "Torque of the mill", "N m", "torque_N_m", true, nullptr},
    Quantity{"toe_deg", "Toe", "degrees", "toe_deg", false, &ToeAndShoulder::toe_deg},
    Quantity{"shoulder_deg", "Shoulder", "degrees", "shoulder_deg", false, &ToeAndShoulder::shoulder_deg},
    Quantity{"toe_bulk_deg", "Toe of the bulk", "degrees", "toe_bulk_deg", false, nullptr},
    Quantity{"shoulder_bulk_deg", "Shoulder of the bulk", "degrees", "shoulder_bulk_deg", false, nullptr},
    Quantity{"head_m", "Head", "m", "", false, nullptr},
    Quantity{"departure_deg", "Departure", "degrees", "", false, nullptr},
};

struct Paper {
  const char* name;
  double width_mm;
  std::vector<std::size_t> panels;  // of kQuantities
};
const std::array<Paper, 3> kPapers{{{"power", 85, {0}}, {"torque", 85, {1}}, {"toe_shoulder", 170, {2, 3}}}};

// What people call the keys that are varied most: along an axis, and one value in a legend.
struct KeyWords {
  const char* key;
  const char* axis;
  const char *before, *after;
};
constexpr KeyWords kKeyWords[] = {
    {"mill.speed", "Speed, fraction of critical", "", " of critical speed"},
    {"mill.speed_rpm", "Speed, rev/min", "", " rev/min"},
    {"mill.lifters.count", "Lifters", "", " lifters"},
    {"mill.lifters.profile", "Lifters", "lifters: ", ""},
    {"mill.lifters.height", "Height of the lifters, m", "lifters ", " m high"},
    {"charge.filling", "Filling", "filling ", ""},
    {"charge.count", "Balls in a slice", "", " balls"},
    {"contact.friction", "Coefficient of friction", "friction ", ""},
    {"contact.restitution", "Coefficient of restitution", "restitution ", ""},
};

const KeyWords* words_for_key(const std::string& key) {
  for (const KeyWords& words : kKeyWords)
    if (key == words.key) return &words;
  return nullptr;
}

std::string axis_words(const std::string& key) {
  const KeyWords* words = words_for_key(key);
  return words ? words->axis : key;
}

void add_value(std::string& label, const std::string& key, const std::string& value) {
  const KeyWords* words = words_for_key(key);
  label += label.empty() ? "" : ", ";
  label += words ? words->before + value + words->after : key + " = " + value;
}

const ScalarDatum* datum(const std::string& name) {
  for (const ScalarDatum& d : kScalarData)
    if (name == d.name) return &d;
  return nullptr;
}

bool has_numbers(const VariedKey& varied) {
  return std::none_of(varied.values.begin(), varied.values.end(),
                      [](const auto& v) { return std::isnan(number_of(v)); });
}

// The others' values at a point: "120 balls, friction 0.2".
std::string label_of(const Sweep& sweep, std::size_t point, std::size_t axis) {
  std::string text;
  const auto index = sweep.at(point);
  for (std::size_t k = 0; k < index.size(); ++k)
    if (k != axis) add_value(text, sweep.varied[k].key, sweep.varied[k].values[index[k]]);
  return text;
}

// One line of a plot: the points that differ in the axis' key alone.
struct Line {
  std::string label;
  std::vector<std::size_t> points;
};
std::vector<Line> lines_of(const Sweep& sweep, std::size_t axis) {
  std::vector<Line> lines;
  for (std::size_t p = 0; p < sweep.points(); ++p) {
    const std::string label = label_of(sweep, p, axis);
    auto at = std::find_if(lines.begin(), lines.end(), [&](const Line& line) { return line.label == label; });
    if (at == lines.end()) {
      if (lines.size() == kMostSweepLines) continue;
      at = lines.insert(at, {label, {}});
    }
    at->points.push_back(p);
  }
  return lines;
}

double place_of(const Sweep& sweep, std::size_t point, std::size_t axis) {
  return number_of(sweep.varied[axis].values[sweep.at(point)[axis]]);
}

// --- the three kinds of series

PlotSeries simulated(const Sweep& sweep, const Line& line, std::size_t axis, const RunQuantity& quantity) {
  PlotSeries s{.label = line.label.empty() ? "simulated" : line.label};
  for (const std::size_t p : line.points) {
    const Estimate e = over_repeats(sweep, p, quantity);
    s.x.push_back(place_of(sweep, p, axis));
    s.y.push_back(e.value);
    s.se.push_back(e.se);
  }
  return s;
}

// Against the key, by what else the experiments set.
std::vector<PlotSeries> measured_series(const Experiments& measured, const Config& mill, const std::string& key,
                                        const ScalarDatum& d) {
  std::map<std::string, PlotSeries> by_rest;
  for (const Experiment& e : measured.list) {
    const Estimate& m = e.*d.measured;
    if (std::isnan(m.value)) continue;
    std::string rest;
    for (const auto& [k, value] : e.sets)
      if (k != key && k != twin_of(key)) add_value(rest, k, value);
    PlotSeries& s = by_rest[rest];
    s.label = rest.empty() ? kMeasured : kMeasured + ", " + rest;
    s.x.push_back(number_at(config_of(mill, e), key));
    s.y.push_back(m.value);
    s.se.push_back(m.se);
  }
  std::vector<PlotSeries> list;
  for (auto& [rest, s] : by_rest) {
    s.mark = PlotMark::kPoints;
    list.push_back(std::move(s));
  }
  return list;
}

// Between the values of speed and filling too, which he takes; of another key at its values.
PlotSeries morrell(const Sweep& sweep, const Config& mill, const Line& line, std::size_t axis,
                   double ToeAndShoulder::*angle) {
  const VariedKey& varied = sweep.varied[axis];
  std::vector<std::string> places = varied.values;
  if (varied.key.starts_with("mill.speed") || varied.key == "charge.filling") {
    const double from = number_of(places.front()), to = number_of(places.back());
    places.clear();
    for (int i = 0; i <= kCurvePlaces; ++i) places.push_back(fmt::format("{}", from + (to - from) * i / kCurvePlaces));
  }
  std::vector<std::string> sets{""};
  const auto index = sweep.at(line.points.front());
  for (std::size_t k = 0; k < index.size(); ++k)
    if (k != axis) sets.push_back(sweep.varied[k].key + "=" + sweep.varied[k].values[index[k]]);
  PlotSeries s{.dashed = true};
  for (const std::string& place : places) {
    sets[0] = varied.key + "=" + place;
    const Config c = with_sets(mill, sets);
    // As it is given: a filling of whole balls would go up in steps.
    const double filling = std::isnan(c.charge.filling) ? number_at(c, "charge.filling") : c.charge.filling;
    s.x.push_back(number_of(place));
    s.y.push_back(morrell_toe_and_shoulder(filling, speed_fraction(c.mill)).*angle);
  }
  return s;
}

// A curve for each filling and speed that the lines have; what differs in other keys has the same one.
std::vector<PlotSeries> morrell_series(const Sweep& sweep, const Config& mill, const std::vector<Line>& lines,
                                       std::size_t axis, double ToeAndShoulder::*angle) {
  std::vector<PlotSeries> list;
  const auto same = [](const std::vector<double>& a, const std::vector<double>& b) {
    return std::equal(a.begin(), a.end(), b.begin(),
                      [](double p, double q) { return p == q || (std::isnan(p) && std::isnan(q)); });
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    PlotSeries s = morrell(sweep, mill, lines[i], axis, angle);
    if (std::any_of(list.begin(), list.end(), [&](const PlotSeries& known) { return same(known.y, s.y); })) continue;
    s.label = kMorrell + ", " + lines[i].label;
    s.colour = static_cast<int>(i) + 1;
    list.push_back(std::move(s));
  }
  if (list.size() == 1) list[0].label = kMorrell, list[0].colour = kMeasuredColour;
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

Plot plot_of(const Quantity& q, const Sweep& sweep, const Config& mill, const Experiments& measured, std::size_t axis) {
  const RunQuantity& quantity = run_quantity(q.name);
  const std::string& key = sweep.varied[axis].key;
  Plot plot{.title = q.title,
            .x_label = axis_words(key),
            .y_label = fmt::format("{}, {}", q.title, q.unit),
            .y_from_zero = q.from_zero,
            .y_is_direction = quantity.is_direction};
  const std::vector<Line> lines = lines_of(sweep, axis);
  for (std::size_t i = 0; i < lines.size(); ++i) {
    plot.series.push_back(simulated(sweep, lines[i], axis, quantity));
    plot.series.back().colour = static_cast<int>(i) + 1;
  }
  if (const ScalarDatum* d = datum(q.measured)) {
    int next = static_cast<int>(lines.size()) + 1;
    std::vector<PlotSeries> list = measured_series(measured, mill, key, *d);
    for (PlotSeries& s : list) {
      const auto at = std::find_if(lines.begin(), lines.end(),
                                   [&](const Line& line) { return s.label == kMeasured + ", " + line.label; });
      const bool one = list.size() == 1 && lines.size() == 1;
      s.colour = one ? kMeasuredColour : at != lines.end() ? static_cast<int>(at - lines.begin()) + 1 : next++;
      plot.series.push_back(std::move(s));
    }
  }
  if (q.morrell)
    for (PlotSeries& s : morrell_series(sweep, mill, lines, axis, q.morrell)) plot.series.push_back(std::move(s));
  if (quantity.is_direction) unwind(plot);
  return plot;
}

// --- for papers

struct Figure {
  std::string name;
  const Paper* paper;
  std::size_t axis;
};
std::vector<Figure> figures_of(const Sweep& sweep) {
  std::vector<Figure> figures;
  const std::size_t main = axis_key(sweep);
  for (std::size_t k = 0; k < sweep.varied.size(); ++k) {
    const VariedKey& varied = sweep.varied[k];
    if (k != main && (!has_numbers(varied) || varied.values.size() < kFewestOfAxis)) continue;
    std::string key = varied.key;
    std::replace(key.begin(), key.end(), '.', '_');
    for (const Paper& paper : kPapers) figures.push_back({paper.name + (k == main ? "" : "_by_" + key), &paper, k});
  }
  return figures;
}

constexpr std::array kKinds{".svg", ".pdf", ".csv"};

// A row per point of each panel, with the quantity's name and with it its unit.
std::string csv_of(const Figure& figure, const Sweep& sweep, const std::vector<Plot>& panels) {
  std::string text = fmt::format("quantity,series,{},value,standard_error\n", csv_text(sweep.varied[figure.axis].key));
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const Quantity& q = kQuantities[figure.paper->panels[i]];
    const bool direction = panels[i].y_is_direction;
    for (const PlotSeries& s : panels[i].series)
      for (std::size_t k = 0; k < s.x.size(); ++k)
        if (!std::isnan(s.y[k]))
          text += fmt::format("{},{},{:.9g},{:.9g},{}\n", q.name, csv_text(s.label), s.x[k],
                              direction ? wrap_360(s.y[k]) : s.y[k],
                              s.se.empty() || std::isnan(s.se[k]) ? "" : fmt::format("{:.4g}", s.se[k]));
  }
  return text;
}

}  // namespace

std::size_t axis_key(const Sweep& sweep) {
  std::size_t best = sweep.varied.size(), most = 0;
  for (std::size_t k = 0; k < sweep.varied.size(); ++k)
    if (const std::size_t values = sweep.varied[k].values.size(); values > most && has_numbers(sweep.varied[k]))
      best = k, most = values;
  return best;
}

std::vector<Plot> sweep_plots(const Sweep& sweep, const Config& mill, const Experiments& measured) {
  std::vector<Plot> plots;
  for (const Quantity& q : kQuantities) {
    plots.push_back(plot_of(q, sweep, mill, measured, axis_key(sweep)));
    plots.back().y_label = q.unit;  // the title is right above
  }
  return plots;
}

std::vector<fs::path> sweep_figure_files(const fs::path& folder, const Sweep& sweep) {
  std::vector<fs::path> files;
  for (const Figure& figure : figures_of(sweep))
    for (const char* kind : kKinds) files.push_back(folder / (figure.name + kind));
  return files;
}

void write_sweep_figures(const fs::path& folder, const Sweep& sweep, const Config& mill, const Experiments& measured,
                         const std::vector<fs::path>& keep) {
  for (const Figure& figure : figures_of(sweep)) {
    std::vector<Plot> panels;
    for (const std::size_t q : figure.paper->panels)
      panels.push_back(plot_of(kQuantities[q], sweep, mill, measured, figure.axis));
    for (const char* kind : kKinds) {
      const fs::path file = folder / (figure.name + kind);
      if (std::find(keep.begin(), keep.end(), file) != keep.end()) continue;
      if (file.extension() == ".csv")
        write_text(file, csv_of(figure, sweep, panels));
      else
        write_figure(file, panels, figure.paper->width_mm);
    }
  }
}

}  // namespace tumble::io
