#include "io/report/figure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "io/json_number.h"

namespace tumble::io::report {
namespace {

// Seven digits are more than a plot can show.
Json plotted(double v, bool log = false) { return log && !(v > 0) ? Json(nullptr) : json_number(v, 7); }

Json series_json(const PlotSeries& s, const Plot& plot, int colour) {
  const bool edges = s.mark == PlotMark::kSteps && s.x.size() == s.y.size() + 1;
  const bool ends = !s.low.empty() || !s.high.empty();
  const auto fits = [&](const std::vector<double>& v) { return v.empty() || v.size() == s.y.size(); };
  if ((s.x.size() != s.y.size() && !edges) || !fits(s.se) || !fits(s.low) || s.low.size() != s.high.size())
    throw std::logic_error("the series " + s.label + " has columns of different lengths");

  Json x = Json::array(), y = Json::array(), low = Json::array(), high = Json::array();
  const auto add = [&](double place, std::size_t i) {
    if (plotted(place, plot.x_log).is_null()) return;
    x.push_back(plotted(place));
    y.push_back(plotted(s.y[i], plot.y_log));
    const double se = s.se.empty() ? kNotGiven : s.se[i];
    const double bottom = ends ? s.low[i] : s.y[i] - se;
    // A bar that reaches below zero has no end on a logarithmic axis: it is drawn down to a thousandth of its value.
    low.push_back(plotted(plot.y_log && !(bottom > 0) && s.y[i] > 0 ? s.y[i] / 1000 : bottom, plot.y_log));
    high.push_back(plotted(ends ? s.high[i] : s.y[i] + se, plot.y_log));
  };
  std::vector<std::size_t> order(s.y.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return s.x[a] < s.x[b]; });
  for (const std::size_t i : order) add(s.x[i], i);
  if (edges && !s.y.empty()) add(s.x.back(), s.y.size() - 1);  // the last edge closes the last step

  static constexpr const char* kMarks[] = {"line", "points", "steps"};
  Json out = {{"label", s.label},   {"x", x},          {"y", y}, {"mark", kMarks[static_cast<int>(s.mark)]},
              {"dashed", s.dashed}, {"colour", colour}};
  if (ends || !s.se.empty()) {
    out["low"] = low;
    out["high"] = high;
  }
  return out;
}

Json rules_json(const std::vector<PlotRule>& rules) {
  Json out = Json::array();
  for (const PlotRule& r : rules) {
    if (!std::isfinite(r.at)) continue;
    Json rule = {{"at", plotted(r.at)}, {"label", r.label}};
    if (std::isfinite(r.se)) {
      rule["low"] = plotted(r.at - r.se);
      rule["high"] = plotted(r.at + r.se);
    }
    out.push_back(rule);
  }
  return out;
}

std::string place_of(const std::string& id, std::size_t i) { return fmt::format("{}-{}", id, i); }

}  // namespace

std::string figures_of(const std::vector<Plot>& plots, const std::string& id) {
  std::string out;
  for (std::size_t i = 0; i < plots.size(); ++i) {
    const Plot& p = plots[i];
    const bool pair = !p.tall, opens = pair && (i == 0 || plots[i - 1].tall);
    const bool closes = pair && (i + 1 == plots.size() || plots[i + 1].tall);
    if (opens) out += "<div class=\"pair\">\n";
    out += "<figure>";
    if (!p.title.empty()) out += "<h3>" + escaped(p.title) + "</h3>";
    out += fmt::format(R"(<div class="plot{}" id="{}" role="img" aria-label="{}"></div>)", p.tall ? " tall" : "",
                       escaped(place_of(id, i)), escaped(p.title.empty() ? p.y_label : p.title));
    if (!p.caption.empty()) out += "<figcaption>" + escaped(p.caption) + "</figcaption>";
    out += "</figure>\n";
    if (closes) out += "</div>\n";
  }
  return out;
}

Json plots_json(const std::vector<Plot>& plots, const std::string& id) {
  Json out = Json::array();
  for (std::size_t i = 0; i < plots.size(); ++i) {
    const Plot& p = plots[i];
    Json series = Json::array();
    int next = 0;
    for (const PlotSeries& s : p.series) series.push_back(series_json(s, p, s.colour >= 0 ? s.colour : next++));
    out.push_back({{"id", place_of(id, i)},
                   {"x_label", p.x_label},
                   {"y_label", p.y_label},
                   {"x_log", p.x_log},
                   {"y_log", p.y_log},
                   {"x_direction", p.x_is_direction},
                   {"y_direction", p.y_is_direction},
                   {"y_from_zero", p.y_from_zero && !p.y_log},
                   {"series", series},
                   {"upright", rules_json(p.upright)},
                   {"level", rules_json(p.level)}});
  }
  return out;
}

}  // namespace tumble::io::report
