#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/suspect_words.h"
#include "core/version.h"
#include "io/diagnosis_file.h"
#include "io/diagnosis_words.h"
#include "io/output.h"
#include "io/report/diagnosis_parts.h"
#include "io/report/embedded.h"
#include "io/report/figure.h"
#include "io/report/html.h"
#include "io/report/section.h"

namespace tumble::io {
using namespace report;
namespace {

constexpr std::size_t kMostKeys = 3;  // of effects at the top

// Of the plots' palette: the same on the whole page.
constexpr int kMeasured = 0, kAfter = 1, kBefore = 4, kHeldOut = 2;

// --- numbers at the top

std::string key(const std::string& term, const std::string& value, const std::string& beside) {
  return "<div><dt>" + term + "</dt><dd>" + value + "<small>" + beside + "</small></dd></div>";
}

std::string verdict_in_words(Finding finding) {
  switch (finding) {
    case Finding::kMissingEffect:
      return "Missing effect";
    case Finding::kAgreement:
      return "Agreement";
    case Finding::kMeasurementArtefact:
      return "Error of measurement";
    case Finding::kUnknownEffect:
      return "Unknown effect";
    case Finding::kAmbiguous:
      break;
  }
  return "Ambiguous";
}

std::string gap_value(double before, double after) {
  return gap_in_words(before) + (std::isnan(after) ? "" : " → " + gap_in_words(after));
}

std::string keys_html(const Diagnosis& d) {
  std::string out = key("Verdict", verdict_in_words(d.finding), "");
  for (std::size_t i = 0; i < std::min(d.effects.size(), kMostKeys); ++i) {
    const FoundEffect& e = d.effects[i];
    std::string strength;
    for (const FoundParameter& p : e.parameters) strength += (strength.empty() ? "" : ", ") + parameter_in_words(p);
    out += key(escaped(with_capital(words_of_suspect(e.name))), escaped(probability_in_words(e.probability)),
               "probability" + (strength.empty() ? "" : "; " + escaped(strength)));
  }
  const Gap before = gap_before(d), after = gap_after(d), rival = gap_of_runner_up(d);
  out += key("Gap, fitted experiments", gap_value(before.fit, after.fit), "1 is agreement");
  if (std::isfinite(before.hold_out))
    out += key("Gap, held out", gap_value(before.hold_out, after.hold_out), "never used to choose or to fit");
  if (!d.runner_up.empty() && std::isfinite(rival.fit))
    out += key("Gap with the runner-up",
               gap_value(rival.fit, kNotGiven) +
                   (std::isfinite(rival.hold_out) ? ", held out " + gap_in_words(rival.hold_out) : ""),
               escaped(words_of_suspect(d.runner_up)));
  return out;
}

// --- sections of plots and tables

Plot torque_plot(const TorqueCurve& t) {
  Plot plot{.title = t.experiment,
            .x_label = t.x_name + (t.x_unit.empty() ? "" : ", " + t.x_unit),
            .y_label = "torque of one slice, N m"};
  plot.series = {{.label = "before", .x = t.x, .y = t.before, .se = t.before_se, .dashed = true, .colour = kBefore},
                 {.label = "after", .x = t.x, .y = t.after, .se = t.after_se, .colour = kAfter},
                 {.label = "measured", .x = t.x, .y = t.measured, .se = t.measured_se, .colour = kMeasured}};
  std::erase_if(plot.series, [](const PlotSeries& s) { return s.y.empty(); });
  return plot;
}

// Mean torque against speed, where one filling was run at several.
std::vector<Plot> torque_against_speed(const Diagnosis& d) {
  struct Point {
    double speed;
    const GapRow* row;
  };
  std::vector<std::pair<double, std::vector<Point>>> fillings;
  for (const DiagnosedExperiment& e : d.experiments)
    for (const GapRow& row : d.gaps) {
      if (row.experiment != e.name || std::isnan(row.torque_measured.value) || std::isnan(e.speed_fraction)) continue;
      auto of = std::find_if(fillings.begin(), fillings.end(),
                             [&](const auto& f) { return std::abs(f.first - e.filling) < 0.01; });
      if (of == fillings.end()) of = fillings.insert(fillings.end(), {e.filling, {}});
      of->second.push_back({e.speed_fraction, &row});
    }
  std::vector<Plot> plots;
  for (const auto& [filling, points] : fillings) {
    if (points.size() < 2) continue;
    Plot plot{.title = fmt::format("Filling {:.0f} %", 100 * filling),
              .x_label = "speed, share of critical",
              .y_label = "torque of one slice, N m"};
    PlotSeries before{.label = "before", .dashed = true, .colour = kBefore}, after{.label = "after", .colour = kAfter},
        fitted{.label = "measured", .mark = PlotMark::kPoints, .colour = kMeasured},
        held_out{.label = "measured, held out", .mark = PlotMark::kPoints, .colour = kHeldOut};
    const auto add = [](PlotSeries& s, double x, const Estimate& y) {
      if (std::isnan(y.value)) return;
      s.x.push_back(x);
      s.y.push_back(y.value);
      s.se.push_back(y.se);
    };
    for (const Point& p : points) {
      add(before, p.speed, p.row->torque_before);
      add(after, p.speed, p.row->torque_after);
      add(p.row->hold_out ? held_out : fitted, p.speed, p.row->torque_measured);
    }
    for (PlotSeries* s : {&before, &after, &fitted, &held_out})
      if (!s->x.empty()) plot.series.push_back(std::move(*s));
    plots.push_back(std::move(plot));
  }
  return plots;
}

PageSection torque_section(const Diagnosis& d) {
  PageSection section{.heading = "Torque"};
  for (const TorqueCurve& t : d.torque) section.plots.push_back(torque_plot(t));
  for (Plot& plot : torque_against_speed(d)) section.plots.push_back(std::move(plot));
  if (!section.plots.empty()) section.paragraphs = {"Bands and bars: one standard error. Broken: the model as it was."};
  return section;
}

PageSection law_section(const Diagnosis& d) {
  PageSection section{.heading = "Laws, measured contact by contact"};
  if (d.laws.empty() && d.found_laws.empty()) return section;
  section.paragraphs = {
      "From single flights and impacts alone, without a simulation. Broken: the law of the model as it was."};
  for (const LawCurve& law : d.laws) {
    const auto label = [](const std::string& name, const std::string& unit) {
      return unit.empty() ? name : name + ", " + unit;
    };
    Plot plot{.title = law.name,
              .x_label = label(law.x_name, law.x_unit),
              .y_label = label(law.y_name, law.y_unit),
              .caption = law.says};
    if (!law.experiment.empty()) plot.title += " (" + law.experiment + ")";
    if (std::isfinite(law.z))
      plot.caption += fmt::format("{}z against the model: {}.", plot.caption.empty() ? "" : " ", number(law.z, 1));
    plot.series = {
        {.label = "measured", .x = law.x, .y = law.y, .se = law.se, .mark = PlotMark::kPoints, .colour = kMeasured}};
    if (!law.model.empty())
      plot.series.push_back({.label = "model", .x = law.x, .y = law.model, .dashed = true, .colour = kBefore});
    section.plots.push_back(std::move(plot));
  }
  for (const std::string& found : d.found_laws) section.paragraphs.push_back("Not on the list: " + found);
  if (!d.model_tabulated_toml.empty())
    section.paragraphs.emplace_back("model_tabulated.toml is the mill with what is beyond the model’s laws as tables.");
  return section;
}

bool speaks(const CheckRow& check) { return std::abs(check.z) > 3; }

PageSection check_section(const Diagnosis& d) {
  PageSection section{.heading = "Checks without a simulation"};
  if (d.checks.empty()) return section;
  section.paragraphs = {
      "What must be so whatever the contacts do: the drum’s circle, free fall, the balance of torque and weight."};
  PageTable table;
  table.header = {"check", "experiment", "unit", "found", "expected", "z", "says"};
  std::vector<CheckRow> checks = d.checks;
  std::stable_sort(checks.begin(), checks.end(),
                   [](const CheckRow& a, const CheckRow& b) { return speaks(a) && !speaks(b); });
  for (const CheckRow& c : checks)
    table.rows.push_back(
        {c.name, c.experiment, c.unit, with_error({c.found, c.se}), number(c.expected, c.se), number(c.z, 1), c.says});
  section.tables.push_back(std::move(table));
  return section;
}

PageSection key_section(const Diagnosis& d) {
  PageSection section{.heading = "What MILL.toml did not know exactly"};
  if (d.keys.empty()) return section;
  section.paragraphs = {"Refitted with everything else, within what was known before."};
  PageTable table;
  table.header = {"key", "known before", "from these data", "moved by"};
  for (const FittedUncertain& k : d.keys)
    table.rows.push_back({k.key, with_error({k.given, k.given_sd}), with_error(k.found),
                          k.given_sd > 0 ? number((k.found.value - k.given) / k.given_sd, 1) + " sd" : "–"});
  section.tables.push_back(std::move(table));
  return section;
}

std::string films_html(const std::vector<DiagnosisFilm>& films) {
  if (films.empty()) return "";
  std::string out = "<section>\n<h2>Measured, before and after</h2>\n";
  for (const DiagnosisFilm& film : films)
    out += "<figure class=\"film\">" + video_html(film.file, "controls loop muted playsinline") + "<figcaption>" +
           escaped(film.caption) + "</figcaption></figure>\n";
  return out + "</section>\n";
}

std::string fact(const std::string& term, const std::string& value) {
  return "<dt>" + term + "</dt><dd>" + escaped(value) + "</dd>";
}

std::string facts_html(const Diagnosis& d) {
  std::string out =
      fact("Program", std::string("tumble ") + kVersion) + fact("Mill", d.mill) + fact("Measured", d.measured);
  for (const DiagnosedExperiment& e : d.experiments)
    out += fact(escaped(e.name), (e.data.empty() ? "" : e.data) +
                                     (e.hold_out ? std::string(e.data.empty() ? "" : ", ") + "held out" : ""));
  out += fact("Simulations", fmt::format("{}", d.simulations));
  const double minutes = d.seconds / 60;
  return out + fact("Time", minutes < 2 ? fmt::format("{:.0f} s", d.seconds) : fmt::format("{:.0f} min", minutes));
}

}  // namespace

void write_diagnosis_page(const std::filesystem::path& path, const Diagnosis& d,
                          const std::vector<DiagnosisFilm>& films) {
  std::string sections;
  Json plots = Json::array();
  for (const PageSection& section : {torque_section(d), law_section(d), check_section(d), key_section(d)}) {
    if (section.paragraphs.empty()) continue;
    const std::string id = fmt::format("plot-{}", plots.size());
    sections += section_html(section, id);
    for (Json& plot : plots_json(section.plots, id)) plots.push_back(std::move(plot));
  }
  const bool asks = d.finding == Finding::kAmbiguous || d.finding == Finding::kUnknownEffect;
  const std::string title = diagnosis_title(d), next = next_html(d);
  write_text(path, filled(diagnosis_html, {{"top", std::string(top_html)},
                                           {"head", head_html(title, films.empty() ? "" : "; media-src data:")},
                                           {"title", escaped(title)},
                                           {"lead", escaped(sentence_below_title(d))},
                                           {"caveats", caveats_html(d.caveats)},
                                           {"keys", keys_html(d)},
                                           {"next_first", asks ? next : ""},
                                           {"where", where_html(d)},
                                           {"films", films_html(films)},
                                           {"proof", proof_html(d)},
                                           {"suspects", suspects_html(d)},
                                           {"sections", sections},
                                           {"next_last", asks ? "" : next},
                                           {"model", model_html(d)},
                                           {"facts", facts_html(d)},
                                           {"footer", footer_html(kVersion)},
                                           {"data", script_json({{"plots", plots}, {"maps", maps_json(d)}})},
                                           {"uplot_js", std::string(uplot_js)},
                                           {"plots_js", std::string(plots_js)},
                                           {"maps_js", std::string(maps_js)},
                                           {"script", std::string(diagnosis_js)}}));
}

}  // namespace tumble::io
