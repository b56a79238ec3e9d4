#include "io/report/diagnosis_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <sstream>

#include "core/lifter_section.h"
#include "core/motion_quantities.h"
#include "core/suspect_words.h"
#include "io/diagnosis_words.h"
#include "io/json_number.h"
#include "io/report/section.h"

namespace tumble::io::report {
namespace {

constexpr std::size_t kMostPlaces = 10;  // that are listed
constexpr double kWorthABar = 0.005;     // of a suspect's probability

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

std::string one_digit(double v) { return std::isnan(v) ? "–" : fmt::format("{:.1f}", v); }
std::string arrow(double from, double to) {
  return gap_in_words(from) + (std::isnan(to) ? "" : " → " + gap_in_words(to));
}

template <typename T, typename Get>
std::vector<std::string> distinct(const std::vector<T>& all, const Get& get) {
  std::vector<std::string> names;
  for (const T& one : all)
    if (std::find(names.begin(), names.end(), get(one)) == names.end()) names.push_back(get(one));
  return names;
}

const DiagnosedExperiment* experiment_of(const Diagnosis& d, const std::string& name) {
  for (const DiagnosedExperiment& e : d.experiments)
    if (e.name == name) return &e;
  return nullptr;
}

// "0.70 of critical, filling 35 %"
std::string condition_of(const DiagnosedExperiment& e) {
  std::string text;
  if (std::isfinite(e.speed_fraction)) text = fmt::format("{:.2f} of critical", e.speed_fraction);
  if (std::isfinite(e.filling)) text += fmt::format("{}{:.0f} % full", text.empty() ? "" : ", ", 100 * e.filling);
  return text;
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
                       e ? escaped(condition_of(*e)) : "", e && e->hold_out ? "<br>held out" : "");
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
          arrow(before, after), pictures, arrow(before, after));
    }
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

// --- tables as pages have them

std::string tables_html(const std::string& heading, std::vector<std::string> paragraphs,
                        std::vector<PageTable> tables) {
  return section_html({heading, std::move(paragraphs), {}, std::move(tables), {}}, "");
}
// A table inside a section of its own making: the tags round it are off.
std::string table_inside(PageTable table) {
  std::string text = tables_html("", {}, {std::move(table)});
  const std::string open = "<section>\n", close = "</section>\n";
  return text.substr(open.size(), text.size() - open.size() - close.size());
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

struct Axis {
  double low, high;
  double at(double v) const {
    return 100 * (std::log(std::clamp(v, low, high)) - std::log(low)) / (std::log(high) - std::log(low));
  }
};

Axis axis_of(const Diagnosis& d) {
  double low = 0.7, high = 2;
  for (const GapRow& row : d.gaps)
    for (const double v : {row.before, row.after, row.runner_up})
      if (v > 0) low = std::min(low, v / 1.15), high = std::max(high, v * 1.15);
  return {low, high};
}

std::string dot(const Axis& axis, const char* style, double v) {
  return v > 0 ? fmt::format("<i class=\"dot {}\" style=\"left:{:.2f}%\"></i>", style, axis.at(v)) : "";
}

std::string gap_rows(const Diagnosis& d, const Axis& axis, bool hold_out) {
  std::string out;
  for (const GapRow& row : d.gaps) {
    if (row.hold_out != hold_out) continue;
    const DiagnosedExperiment* e = experiment_of(d, row.experiment);
    const double from = std::min(row.before, row.after), to = std::max(row.before, row.after);
    out += fmt::format(
        "<li><span class=\"name\">{}<small>{}</small></span><span class=\"track\"><i class=\"one\" "
        "style=\"left:{:.2f}%\"></i>",
        escaped(row.experiment), e ? escaped(condition_of(*e)) : "", axis.at(1));
    if (from > 0)
      out += fmt::format("<i class=\"way\" style=\"left:{:.2f}%;width:{:.2f}%\"></i>", axis.at(from),
                         axis.at(to) - axis.at(from));
    out += dot(axis, "rival", row.runner_up) + dot(axis, "before", row.before) + dot(axis, "after", row.after);
    out += fmt::format("</span><span class=\"numbers-of\">{}</span></li>\n", arrow(row.before, row.after));
  }
  return out;
}

// Round numbers, as close as they can be read.
std::string ticks(const Axis& axis) {
  constexpr double kApart = 7;  // [% of the axis]
  std::vector<double> shown;
  for (const auto& numbers :
       {std::vector{1., 10., 100.}, {2., 5., 20., 50., 200., 500.}, {0.5, 3., 30., 300.}, {1.5, 0.7, 7., 15., 70.}})
    for (const double v : numbers)
      if (v >= axis.low && v <= axis.high && std::none_of(shown.begin(), shown.end(), [&](double other) {
            return std::abs(axis.at(v) - axis.at(other)) < kApart;
          }))
        shown.push_back(v);
  std::string out;
  for (const double v : shown) out += fmt::format("<i style=\"left:{:.2f}%\">{:g}</i>", axis.at(v), v);
  return out;
}

PageTable torque_table(const Diagnosis& d) {
  PageTable table;
  table.title = "Torque of one slice, N m";
  table.header = {"experiment", "", "measured", "before", "after"};
  for (const GapRow& row : d.gaps)
    if (std::isfinite(row.torque_measured.value))
      table.rows.push_back({row.experiment, row.hold_out ? "held out" : "fitted", with_error(row.torque_measured),
                            with_error(row.torque_before), with_error(row.torque_after)});
  return table;
}

std::string kind_in_words(NameKind kind) {
  switch (kind) {
    case NameKind::kPhysics:
      return "physics of the mill";
    case NameKind::kArtefact:
      return "error of measurement";
    default:
      return "";
  }
}

std::string bar_row(const RankedName& r, bool is_found) {
  const std::string chi = gap_in_words(r.misfit);
  const bool has_strength = std::isfinite(r.strength.value.value) && !r.strength.name.empty();
  return fmt::format(
      "<tr{}><th scope=\"row\">{}<small>{}</small></th><td class=\"probability\"><span class=\"bar\"><i class=\"{}\" "
      "style=\"width:{:.1f}%\"></i></span>"
      "<b>{}</b></td><td>{}</td><td>{}</td></tr>\n",
      is_found ? " class=\"is-found\"" : "", escaped(with_capital(words_of_suspect(r.name))),
      escaped(kind_in_words(r.kind)), name_of(r.kind), 100 * r.probability,
      escaped(probability_in_words(r.probability)), has_strength ? escaped(parameter_in_words(r.strength)) : "", chi);
}

std::string ranking_html(const Diagnosis& d, PageTable& ruled_out) {
  std::string rows;
  int shown = 0;
  for (const RankedName& r : d.ranking) {
    const bool is_found =
        std::any_of(d.effects.begin(), d.effects.end(), [&](const FoundEffect& e) { return e.name == r.name; });
    if (is_found || r.probability >= kWorthABar || shown < 2) {
      rows += bar_row(r, is_found);
      ++shown;
    } else {
      ruled_out.rows.push_back({with_capital(words_of_suspect(r.name)), probability_in_words(r.probability),
                                gap_in_words(r.misfit),
                                r.ruled_out_by.empty() ? "others explain the data better" : r.ruled_out_by});
    }
  }
  return "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Ranking\"><table "
         "class=\"ranking\">\n<thead><tr><th scope=\"col\">Suspect</th>"
         "<th scope=\"col\">Probability</th><th scope=\"col\">Strength, if it is this alone</th><th scope=\"col\">Gap "
         "left</th></tr></thead>\n<tbody>\n" +
         rows + "</tbody></table></div>\n";
}

std::string joined(const std::vector<std::string>& names, const char* between) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : between) + words_of_suspect(name);
  return text;
}

std::string settings_of(const NextExperiment& next) {
  std::string text;
  for (const auto& [key, value] : next.set) text += fmt::format("{}{} = {:g}", text.empty() ? "" : ", ", key, value);
  return text.empty() ? "as before" : text;
}

// --- what is new in a text, line by line

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

// Which lines of b are not in a: by the longest common subsequence.
std::vector<bool> new_lines(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  const std::size_t n = a.size(), m = b.size();
  std::vector<std::size_t> length((n + 1) * (m + 1), 0);
  const auto at = [&](std::size_t i, std::size_t j) -> std::size_t& { return length[i * (m + 1) + j]; };
  for (std::size_t i = n; i-- > 0;)
    for (std::size_t j = m; j-- > 0;)
      at(i, j) = a[i] == b[j] ? at(i + 1, j + 1) + 1 : std::max(at(i + 1, j), at(i, j + 1));
  std::vector<bool> is_new(m, true);
  for (std::size_t i = 0, j = 0; i < n && j < m;) {
    if (a[i] == b[j])
      is_new[j++] = false, ++i;
    else if (at(i + 1, j) >= at(i, j + 1))
      ++i;
    else
      ++j;
  }
  return is_new;
}

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
  if (!d.where.empty()) out += table_inside(places_table(d));
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

std::string proof_html(const Diagnosis& d) {
  if (d.gaps.empty()) return "";
  const bool added = !d.effects.empty();
  const Axis axis = axis_of(d);
  std::string out = added ? "<section>\n<h2>The gap, before and after</h2>\n" : "<section>\n<h2>The gap</h2>\n";
  out +=
      "<p>Every experiment simulated anew, with packings that had no part in the fit. The gap is the usual distance "
      "between mill and "
      "model in standard errors: 1 is agreement, 2 twice what chance makes.";
  if (!d.runner_up.empty())
    out += " Hollow: " + escaped(words_of_suspect(d.runner_up)) + ", the runner-up, fitted in the same way instead.";
  out += "</p>\n";
  out +=
      R"(<p class="legend"><span><i class="dot before"></i>the model as it was</span><span><i class="dot after"></i>with what was found</span>)";
  if (!d.runner_up.empty()) out += "<span><i class=\"dot rival\"></i>with the runner-up</span>";
  out += "</p>\n";
  for (const bool hold_out : {false, true}) {
    const std::string rows = gap_rows(d, axis, hold_out);
    if (rows.empty()) continue;
    out += fmt::format(
        "<h3>{}</h3>\n<ol class=\"gaps\">\n{}<li class=\"axis\" aria-hidden=\"true\"><span></span><span "
        "class=\"track\">{}</span><span></span></li></ol>\n",
        hold_out ? "Held out: never used to choose or to fit" : "Fitted", rows, ticks(axis));
  }
  if (PageTable torque = torque_table(d); !torque.rows.empty()) out += table_inside(std::move(torque));
  if (!d.worse.empty()) {
    PageTable table;
    table.title = "What got worse";
    table.header = {"experiment", "what", "gap before", "gap after"};
    for (const GapWorse& w : d.worse)
      table.rows.push_back(
          {w.experiment, words_of_observable(w.observable), gap_in_words(w.before), gap_in_words(w.after)});
    out += table_inside(std::move(table));
  } else if (added) {
    out += "<p class=\"note\">Nothing that was measured got worse.</p>\n";
  }
  return out + "</section>\n";
}

// Each pair once, at the name that most pairs have.
std::string alike_html(std::vector<std::vector<std::string>> pairs) {
  std::string out;
  while (!pairs.empty()) {
    std::map<std::string, int> count;
    for (const auto& pair : pairs)
      for (const std::string& name : pair) ++count[name];
    const std::string& most = std::max_element(count.begin(), count.end(), [](const auto& a, const auto& b) {
                                return a.second < b.second;
                              })->first;
    std::vector<std::string> others;
    std::erase_if(pairs, [&](const auto& pair) {
      if (std::find(pair.begin(), pair.end(), most) == pair.end()) return false;
      for (const std::string& name : pair)
        if (name != most) others.push_back(name);
      return true;
    });
    out += "<li>" + escaped(with_capital(joined({most}, "")) + ": " + joined(others, ", ")) + "</li>";
  }
  return out;
}

std::string suspects_html(const Diagnosis& d) {
  if (d.ranking.empty()) return "";
  PageTable ruled_out;
  ruled_out.title = "Ruled out";
  ruled_out.header = {"suspect", "probability", "gap left", "by what"};
  std::string out = "<section>\n<h2>Who may have done it</h2>\n" + ranking_html(d, ruled_out);
  out +=
      "<p class=\"note\">Probability that it is in the mill, all suspects weighed against each other; several may be "
      "in it together. "
      "Gap left: what remains if it alone is added; 1 is agreement.</p>\n";
  if (!ruled_out.rows.empty()) out += table_inside(std::move(ruled_out));
  if (!d.alike.empty()) {
    out += "<h3>What such data cannot tell apart</h3>\n<ul class=\"plain-list\">" + alike_html(d.alike);
    out +=
        "</ul>\n<p class=\"note\">Known before the data were looked at: from what was measured, and how "
        "precisely.</p>\n";
  }
  return out + "</section>\n";
}

std::string next_html(const Diagnosis& d) {
  if (d.next.empty()) return "";
  const NextExperiment& best = d.next.front();
  std::string out =
      "<section>\n<h2>What to measure next</h2>\n<p class=\"next\">" + escaped(with_capital(best.measure)) + "</p>\n";
  PageTable table;
  table.header = {"experiment", "settings", "tells apart", "evidence", "cost"};
  for (const NextExperiment& n : d.next)
    table.rows.push_back({with_capital(n.measure), settings_of(n), joined(n.separates, " – "),
                          one_digit(n.expected_log_evidence),
                          std::isnan(n.cost) ? "–" : fmt::format("{:.2g}", n.cost)});
  table.note =
      "Evidence: expected logarithm of the odds that it would give; 3 is 20 to 1, 5 is 150 to 1. Cost: "
      "against one more "
      "measurement like those given.";
  return out + table_inside(std::move(table)) + "</section>\n";
}

std::string model_html(const Diagnosis& d) {
  if (d.model_toml.empty() || d.model_toml == d.mill_toml) return "";
  const auto lines = lines_of(d.model_toml);
  const auto is_new = new_lines(lines_of(d.mill_toml), lines);
  std::string code;
  for (std::size_t i = 0; i < lines.size(); ++i)
    code += is_new[i] && !lines[i].empty() ? "<ins>" + escaped(lines[i]) + "</ins>\n" : escaped(lines[i]) + "\n";
  return "<section>\n<h2>The model with what was found</h2>\n<p>model.toml; what is new in it is marked. Copy the "
         "lines into your MILL.toml, or use the "
         "file as it is.</p>\n<pre class=\"lines\" tabindex=\"0\">" +
         code + "</pre>\n</section>\n";
}

}  // namespace tumble::io::report
