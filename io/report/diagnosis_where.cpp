#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/lifter_section.h"
#include "core/motion_quantities.h"
#include "core/suspect_words.h"
#include "io/diagnosis_words.h"
#include "io/json_number.h"
#include "io/report/diagnosis_parts.h"
#include "io/report/section.h"

namespace tumble::io::report {
namespace {

constexpr std::size_t kMostPlaces = 10;  // that are listed

struct ObservableWords {
  const char* name;
  const char* title;
  const char* meaning;
};
constexpr std::array kObservables{
    ObservableWords{"torque", "torque", ""},
    ObservableWords{"closure", "torque less that of the charge’s weight", ""},
    ObservableWords{"angles", "toe and shoulder", ""},
    ObservableWords{"occupancy", "occupancy", "Area of balls in each cell."},
    ObservableWords{"momentum_x", "momentum to the right", "Area of balls times their velocity to the right."},
    ObservableWords{"momentum_y", "momentum upwards", "Area of balls times their velocity upwards."},
    ObservableWords{"agitation", "agitation", "Area of balls times the square of their velocity."},
    ObservableWords{"spin", "spin", "Area of balls times their spin, counter-clockwise counted positive."},
    ObservableWords{"pockets", "pockets", "Area of balls before each lifter: the ring turns with the drum."},
    ObservableWords{"slip", "slip in the pockets",
                    "Speed of the balls before each lifter against the drum: the ring turns with it."},
    ObservableWords{"flight", "free flight", ""},
};

const ObservableWords* find(const std::string& name) {
  for (const ObservableWords& w : kObservables)
    if (name == w.name) return &w;
  return nullptr;
}

double largest(const std::vector<double>& z) {
  double most = kNotGiven;
  for (const double v : z)
    if (!std::isnan(v) && !(std::abs(v) <= most)) most = std::abs(v);
  return most;
}

template <typename T, typename Get>
std::vector<std::string> distinct(const std::vector<T>& all, const Get& get) {
  std::vector<std::string> names;
  for (const T& one : all)
    if (std::find(names.begin(), names.end(), get(one)) == names.end()) names.push_back(get(one));
  return names;
}

bool is_repaired(const Diagnosis& d) {
  return std::any_of(d.maps.begin(), d.maps.end(), [](const GapMap& m) { return !m.z_after.empty(); });
}

// Of the maps: where nothing was added there is no after.
std::vector<std::string> sides_of(const Diagnosis& d) {
  return is_repaired(d) ? std::vector<std::string>{"before", "after"} : std::vector<std::string>{"before"};
}

std::string outline_of(const MillShape& shape) {
  std::string path;
  if (!(shape.radius > 0)) return path;
  for (const auto& p : thinned(outline(shape, shape.radius / 30), 2e-3 * shape.radius))
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", 100 * p.x() / shape.radius,
                        -100 * p.y() / shape.radius);
  return path + "z";
}

Json cells(const std::vector<double>& values, int digits) {
  Json out = Json::array();
  for (const double v : values) out.push_back(json_number(v, digits));
  return out;
}

// A small table of maps: experiments down, observables across.
std::string matrix_html(const Diagnosis& d) {
  const auto observables = distinct(d.maps, [](const GapMap& m) { return m.observable; });
  const auto experiments = distinct(d.maps, [](const GapMap& m) { return m.experiment; });
  std::string out =
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"All maps\"><table "
      "class=\"matrix\">\n<thead><tr><td></td>";
  for (const std::string& o : observables)
    out += "<th scope=\"col\">" + escaped(with_capital(words_of_observable(o))) + "</th>";
  out += "</tr></thead>\n<tbody>\n";
  for (const std::string& name : experiments) {
    const DiagnosedExperiment* e = experiment_of(d, name);
    out += fmt::format("<tr><th scope=\"row\">{}<small>{}{}</small></th>", escaped(name),
                       e ? escaped(condition_in_words(*e)) : "", e && e->hold_out ? "<br>held out" : "");
    for (const std::string& o : observables) {
      const auto map = std::find_if(d.maps.begin(), d.maps.end(),
                                    [&](const GapMap& m) { return m.experiment == name && m.observable == o; });
      if (map == d.maps.end()) {
        out += "<td></td>";
        continue;
      }
      const double before = largest(map->z_before), after = largest(map->z_after);
      std::string pictures;
      for (const std::string& side : sides_of(d))
        pictures += "<svg class=\"mill\" viewBox=\"-106 -106 212 212\" data-side=\"" + side + "\"></svg>";
      out += fmt::format(
          "<td><button type=\"button\" class=\"map-button{}\" data-map=\"{}\" aria-label=\"{}, {}: largest z "
          "{}\">{}<span>{}</span></button></td>",
          before > map->limit ? " far" : "", map - d.maps.begin(), escaped(name), escaped(words_of_observable(o)),
          gaps_in_words(before, after), pictures, gaps_in_words(before, after));
    }
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

// Of each experiment and observable the number that differs most.
PageTable places_table(const Diagnosis& d) {
  struct Most {
    const PlaceOfGap* place;
    int count;
  };
  std::vector<Most> all;
  for (const PlaceOfGap& p : d.where) {
    const auto of = std::find_if(all.begin(), all.end(), [&](const Most& m) {
      return m.place->experiment == p.experiment && m.place->observable == p.observable;
    });
    if (of == all.end()) {
      all.push_back({&p, 1});
      continue;
    }
    ++of->count;
    if (std::abs(p.z) > std::abs(of->place->z)) of->place = &p;
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Most& a, const Most& b) { return std::abs(a.place->z) > std::abs(b.place->z); });
  PageTable table;
  table.title = "What differs beyond chance";
  table.header = {"experiment", "what", "numbers", "most", "z before", "z after"};
  for (std::size_t i = 0; i < std::min(all.size(), kMostPlaces); ++i) {
    const PlaceOfGap& p = *all[i].place;
    table.rows.push_back({p.experiment, words_of_observable(p.observable), fmt::format("{}", all[i].count),
                          words_for(p.region), number(p.z, 1), number(p.z_after, 1)});
  }
  if (all.size() > kMostPlaces)
    table.note = fmt::format("The {} largest of {} kinds; all numbers are in verdict.json. ", kMostPlaces, all.size());
  table.note += "z: measured less simulated, in standard errors. Within ±2 is chance.";
  return table;
}

// --- the gap as dots on a line

}  // namespace

std::string words_of_observable(const std::string& name) {
  if (const ObservableWords* words = find(name)) return words->title;
  const std::string known = words_for(name);              // of summary.json
  return known == name ? words_of_suspect(name) : known;  // of no suspect: its letters
}

std::string where_html(const Diagnosis& d) {
  if (d.maps.empty() && d.where.empty()) return "";
  std::string out = "<section>\n<h2>Where mill and model differ</h2>\n";
  if (!d.maps.empty()) {
    out +=
        std::string("<p>") + (is_repaired(d) ? "Left the model as it was, right with what was found. " : "") +
        "<b class=\"more\">Orange</b>: more in the mill than in the model; <b class=\"less\">blue</b>: less. Outlined: "
        "beyond what chance does.</p>\n<div class=\"pair maps\">\n";
    for (const std::string& side : sides_of(d))
      out += fmt::format(
          "<figure>{}<svg class=\"mill map\" data-side=\"{}\" viewBox=\"-108 -108 216 216\" tabindex=\"0\" "
          "role=\"application\" aria-label=\"Map {}; arrow keys move from cell to cell\" "
          "aria-describedby=\"map-reading\"></svg></figure>\n",
          is_repaired(d) ? "<h3>" + with_capital(side) + "</h3>" : "", side, side);
    out += R"(</div>
<p class="scale-line" id="map-scale"></p>
<p class="map-title" id="map-title"></p>
<p class="reading" id="map-reading" aria-live="polite">Point at a cell, or come here with the tab key and use the arrow keys.</p>
)";
    out += matrix_html(d);
    out +=
        "<p class=\"note\">Choose a map to see it large. Figures: the largest |z| on it, before → after. z is the "
        "difference in "
        "standard errors; chance alone goes beyond the outline’s limit somewhere on a map in one of twenty "
        "diagnoses.</p>\n";
  }
  if (!d.where.empty()) out += table_html(places_table(d));
  return out + "</section>\n";
}

Json maps_json(const Diagnosis& d) {
  Json shapes = Json::object(), maps = Json::array();
  for (const DiagnosedExperiment& e : d.experiments)
    shapes[e.name] = {{"outline", outline_of(e.shape)},
                      {"tip", json_number(e.shape.radius > 0 ? e.shape.tip_radius / e.shape.radius : 1, 4)},
                      {"lifters", e.shape.lifter_count}};
  for (const GapMap& m : d.maps) {
    const ObservableWords* words = find(m.observable);
    maps.push_back({{"experiment", m.experiment},
                    {"observable", with_capital(words_of_observable(m.observable))},
                    {"meaning", words ? words->meaning : ""},
                    {"unit", m.unit},
                    {"n", m.n},
                    {"limit", json_number(m.limit, 3)},
                    {"measured", cells(m.measured, 3)},
                    {"before", cells(m.before, 3)},
                    {"after", cells(m.after, 3)},
                    {"z_before", cells(m.z_before, 3)},
                    {"z_after", cells(m.z_after, 3)}});
  }
  return {{"shapes", shapes}, {"all", maps}};
}

}  // namespace tumble::io::report
