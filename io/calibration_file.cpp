#include "io/calibration_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/version.h"
#include "io/csv_file.h"
#include "io/json_number.h"
#include "io/report/html.h"
#include "io/run_columns.h"

namespace tumble::io {
namespace {

using Json = nlohmann::ordered_json;

Json number(double v) { return json_number(v, 9); }
Json error(double v) { return json_number(v, 4); }

Json json_of(const PredictionGroup& group) {
  return {{"data", group.count},
          {"rms_relative_error", error(group.rms_relative_error)},
          {"rms_deg", error(group.rms_degrees)},
          {"reduced_chi", error(group.reduced_chi)}};
}

double relative_error(const Prediction& p) {
  return p.is_direction ? kNotGiven : p.simulated.value / p.measured.value - 1;
}

std::string percent(double share) { return std::isfinite(share) ? fmt::format("{:+.1f} %", 100 * share) : "–"; }

PageTable parameter_table(const Calibration& c) {
  PageTable table;
  table.title = "Fitted keys";
  table.header = {"key", "value", "range", "known before", "remark"};
  for (const FittedKey& k : c.keys)
    table.rows.push_back({k.asked.key, report::with_error(k.value),
                          fmt::format("{:g} to {:g}", k.asked.low, k.asked.high),
                          k.asked.prior_sd > 0 ? fmt::format("{:g} ± {:g}", k.asked.prior, k.asked.prior_sd) : "",
                          k.at_bound       ? "at the end of its range"
                          : k.undetermined ? "not determined by these data"
                                           : ""});
  table.note = c.misfit
                   ? "One standard error, widened because the model does not fit the data within their uncertainties."
                   : "One standard error.";
  return table;
}

PageTable correlation_table(const Calibration& c) {
  PageTable table;
  table.title = "Correlations";
  table.header.emplace_back("");
  for (const FittedKey& k : c.keys) table.header.push_back(k.asked.key);
  for (std::size_t i = 0; i < c.keys.size(); ++i) {
    std::vector<std::string> row{c.keys[i].asked.key};
    for (std::size_t j = 0; j < c.keys.size(); ++j)
      row.push_back(fmt::format("{:.2f}", c.correlation[i * c.keys.size() + j]));
    table.rows.push_back(std::move(row));
  }
  table.note = "Near 1 or -1: the data fix only a combination of the two.";
  return table;
}

PageTable prediction_table(const Calibration& c, bool hold_out) {
  PageTable table;
  table.title = hold_out ? "Held out" : "Fitted";
  table.header = {"experiment", "quantity", "measured", "simulated", "difference", "standard errors"};
  for (const Prediction& p : c.predictions) {
    if (p.hold_out != hold_out) continue;
    const double difference = p.simulated.value - p.measured.value, se = std::hypot(p.simulated.se, p.measured.se);
    table.rows.push_back(
        {p.experiment, p.quantity, report::with_error(p.measured), report::with_error(p.simulated),
         p.is_direction ? fmt::format("{:+.1f}°", std::remainder(difference, 360)) : percent(relative_error(p)),
         se > 0 ? fmt::format("{:+.1f}", (p.is_direction ? std::remainder(difference, 360) : difference) / se) : "–"});
  }
  return table;
}

// Measured and simulated against speed where the experiments differ in it, else one beside the other.
std::vector<Plot> prediction_plots(const Calibration& c) {
  std::vector<Plot> plots;
  std::vector<std::string> quantities;
  for (const Prediction& p : c.predictions)
    if (std::find(quantities.begin(), quantities.end(), p.quantity) == quantities.end())
      quantities.push_back(p.quantity);
  for (const std::string& quantity : quantities) {
    Plot against, parity;
    PlotSeries series[4], fitted, held_out, equal;
    const char* labels[] = {"measured", "simulated", "measured, held out", "simulated, held out"};
    double low = INFINITY, high = -INFINITY;
    for (const Prediction& p : c.predictions) {
      if (p.quantity != quantity) continue;
      against.y_label = parity.y_label = p.unit;
      const auto add = [](PlotSeries& s, double x, const Estimate& y) {
        s.x.push_back(x);
        s.y.push_back(y.value);
        s.se.push_back(y.se);
      };
      add(series[p.hold_out ? 2 : 0], p.speed_fraction, p.measured);
      add(series[p.hold_out ? 3 : 1], p.speed_fraction, p.simulated);
      add(p.hold_out ? held_out : fitted, p.measured.value, p.simulated);
      low = std::min(low, p.measured.value);
      high = std::max(high, p.measured.value);
    }
    against.title = quantity + " against speed";
    against.x_label = "speed, share of critical";
    parity.title = quantity + ": simulated against measured";
    parity.x_label = "measured, " + parity.y_label;
    parity.y_label = "simulated, " + parity.y_label;
    against.y_from_zero = quantity == "power_W" || quantity == "torque_N_m";
    for (int i = 0; i < 4; ++i) {
      series[i].label = labels[i];
      series[i].mark = PlotMark::kPoints;
      if (i % 2 == 1) series[i].mark = PlotMark::kLine;
      series[i].colour = i < 2 ? 1 : 2;
      if (!series[i].x.empty()) against.series.push_back(series[i]);
    }
    fitted.label = "fitted";
    held_out.label = "held out";
    fitted.mark = held_out.mark = PlotMark::kPoints;
    fitted.colour = 1;
    held_out.colour = 2;
    equal = {"equal", {low, high}, {low, high}, {}, {}, {}, PlotMark::kLine, true, 0};
    for (PlotSeries* s : {&equal, &fitted, &held_out})
      if (!s->x.empty()) parity.series.push_back(*s);
    plots.push_back(std::move(against));
    plots.push_back(std::move(parity));
  }
  return plots;
}

std::string in_words(const PredictionGroup& g) {
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : ", ") + part; };
  if (std::isfinite(g.rms_relative_error))
    add(fmt::format("power and torque within {:.1f} %", 100 * g.rms_relative_error));
  if (std::isfinite(g.rms_degrees)) add(fmt::format("angles within {:.1f}°", g.rms_degrees));
  return text + " (rms)";
}

}  // namespace

std::string calibration_json(const Calibration& c) {
  Json keys = Json::array(), correlation = Json::array(), predictions = Json::array();
  for (std::size_t i = 0; i < c.keys.size(); ++i) {
    const FittedKey& k = c.keys[i];
    Json j = {{"key", k.asked.key},           {"value", number(k.value.value)}, {"se", error(k.value.se)},
              {"low", k.asked.low},           {"high", k.asked.high},           {"at_bound", k.at_bound},
              {"determined", !k.undetermined}};
    if (k.asked.prior_sd > 0) j["prior"] = {{"value", number(k.asked.prior)}, {"sd", number(k.asked.prior_sd)}};
    keys.push_back(std::move(j));
    Json row = Json::array();
    for (std::size_t l = 0; l < c.keys.size(); ++l) row.push_back(error(c.correlation[i * c.keys.size() + l]));
    correlation.push_back(std::move(row));
  }
  for (const Prediction& p : c.predictions)
    predictions.push_back({{"experiment", p.experiment},
                           {"hold_out", p.hold_out},
                           {"quantity", p.quantity},
                           {"measured", number(p.measured.value)},
                           {"uncertainty", error(p.measured.se)},
                           {"simulated", number(p.simulated.value)},
                           {"simulated_se", error(p.simulated.se)},
                           {"relative_error", error(relative_error(p))}});
  const Json all = {
      {"mill", c.mill},
      {"measured", c.measured},
      {"version", kVersion},
      {"parameters", keys},
      {"correlation", correlation},
      {"chi2", error(c.chi2)},
      {"degrees_of_freedom", c.degrees_of_freedom},
      {"reduced_chi", error(c.degrees_of_freedom > 0 ? std::sqrt(c.chi2 / c.degrees_of_freedom) : kNotGiven)},
      {"misfit", c.misfit},
      {"fit", json_of(c.fitted)},
      {"hold_out", json_of(c.held_out)},
      {"predictions", predictions},
      {"simulations", c.runs.size() + c.prediction_runs},
      {"notes", c.notes},
      {"definition", c.definition}};
  return all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string runs_csv(const Calibration& c) {
  std::string text = "experiment";
  for (const FittedKey& k : c.keys) text += "," + k.asked.key;
  text += ",seed" + csv_header() + "\n";
  for (const DesignRun& run : c.runs) {
    text += csv_text(run.experiment);
    for (const double v : run.at) text += fmt::format(",{}", v);
    text += fmt::format(",{}{}\n", run.seed, csv_cells(run.outcome));
  }
  return text;
}

PlotPage calibration_page(const Calibration& c) {
  PlotPage page;
  page.kind = "Calibration";
  page.version = kVersion;
  std::string keys;
  for (const FittedKey& k : c.keys)
    keys += fmt::format("{}{} = {}", keys.empty() ? "" : ", ", k.asked.key, report::with_error(k.value));
  page.title = keys;
  page.lead = fmt::format("{} data of the fitted experiments in {}: {}. {}{} simulations to fit, {} to predict.",
                          c.fitted.count, c.measured, in_words(c.fitted),
                          c.held_out.count > 0 ? fmt::format("{} held-out data, never used to fit: {}. ",
                                                             c.held_out.count, in_words(c.held_out))
                                               : std::string("Nothing was held out. "),
                          c.runs.size(), c.prediction_runs);
  page.caveats = c.notes;
  if (c.misfit)
    page.caveats.push_back(fmt::format(
        "The model does not fit the data within their uncertainties: reduced chi {:.2f}, where 1 is agreement.",
        std::sqrt(c.chi2 / c.degrees_of_freedom)));
  PageSection found{"What was found", {}, {}, {parameter_table(c)}, {}};
  if (c.keys.size() > 1) found.tables.push_back(correlation_table(c));
  page.sections.push_back(std::move(found));
  page.sections.push_back(
      {"Measured and simulated",
       {"Every experiment was simulated anew at the fitted values, with packings that had no part in "
        "the fit. Bars are one standard error."},
       prediction_plots(c),
       {},
       {}});
  PageSection numbers{"Numbers", {}, {}, {prediction_table(c, false)}, {}};
  if (c.held_out.count > 0) numbers.tables.push_back(prediction_table(c, true));
  page.sections.push_back(std::move(numbers));
  page.sections.push_back({"The fitted model", {"model.toml:"}, {}, {}, c.model_toml});
  return page;
}

std::string definition_in(const std::string& calibration_json) {
  const Json j = Json::parse(calibration_json, nullptr, false);
  return j.is_object() && j.contains("definition") && j["definition"].is_string() ? j["definition"].get<std::string>()
                                                                                  : "";
}

}  // namespace tumble::io
