#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/suspect_words.h"
#include "io/diagnosis_words.h"
#include "io/report/diagnosis_parts.h"
#include "io/report/section.h"

namespace tumble::io::report {
namespace {

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
        escaped(row.experiment), e ? escaped(condition_in_words(*e)) : "", axis.at(1));
    if (from > 0)
      out += fmt::format("<i class=\"way\" style=\"left:{:.2f}%;width:{:.2f}%\"></i>", axis.at(from),
                         axis.at(to) - axis.at(from));
    out += dot(axis, "rival", row.runner_up) + dot(axis, "before", row.before) + dot(axis, "after", row.after);
    out += fmt::format("</span><span class=\"numbers-of\">{}</span></li>\n", gaps_in_words(row.before, row.after));
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

}  // namespace

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
  if (PageTable torque = torque_table(d); !torque.rows.empty()) out += table_html(torque);
  if (!d.worse.empty()) {
    PageTable table;
    table.title = "What got worse";
    table.header = {"experiment", "what", "gap before", "gap after"};
    for (const GapWorse& w : d.worse)
      table.rows.push_back(
          {w.experiment, words_of_observable(w.observable), gap_in_words(w.before), gap_in_words(w.after)});
    out += table_html(table);
  } else if (added) {
    out += "<p class=\"note\">Nothing that was measured got worse.</p>\n";
  }
  return out + "</section>\n";
}

}  // namespace tumble::io::report
