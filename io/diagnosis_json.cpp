#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>

#include "core/version.h"
#include "io/diagnosis_file.h"
#include "io/diagnosis_words.h"
#include "io/json_number.h"

namespace tumble::io {
namespace {

using Json = nlohmann::ordered_json;

Json number(double v) { return json_number(v, 7); }
Json rough(double v) { return json_number(v, 4); }

Json column(const std::vector<double>& values) {
  Json out = Json::array();
  for (const double v : values) out.push_back(number(v));
  return out;
}

Json json_of(const Estimate& e) { return {{"value", number(e.value)}, {"se", rough(e.se)}}; }
Json json_of(const Gap& gap) { return {{"fit", rough(gap.fit)}, {"hold_out", rough(gap.hold_out)}}; }

// Whole numbers as such: a count of balls is 169, not 169.0.
Json json_of_value(double v) {
  const bool whole = v == std::floor(v) && std::abs(v) < 1e15;
  return whole ? Json(static_cast<std::int64_t>(v)) : number(v);
}

Json json_of(const FoundEffect& effect) {
  Json parameters = Json::object();
  for (const FoundParameter& p : effect.parameters) {
    parameters[p.name] = json_of(p.value);
    parameters[p.name]["unit"] = p.unit;
  }
  return {{"name", effect.name},
          {"kind", name_of(effect.kind)},
          {"parameters", parameters},
          {"probability", rough(effect.probability)},
          {"sets", effect.sets}};
}

Json json_of(const RankedName& r) {
  Json out = {{"name", r.name},
              {"probability", rough(r.probability)},
              {"kind", name_of(r.kind)},
              {"reduced_chi", rough(r.misfit)}};
  if (!r.strength.name.empty()) {
    out["strength"] = json_of(r.strength.value);
    out["strength"]["parameter"] = r.strength.name;
    out["strength"]["unit"] = r.strength.unit;
  }
  if (!r.ruled_out_by.empty()) out["ruled_out_by"] = r.ruled_out_by;
  return out;
}

Json json_of(const NextExperiment& next) {
  Json set = Json::object();
  for (const auto& [key, value] : next.set) set[key] = json_of_value(value);
  return {{"set", set},
          {"separates", next.separates},
          {"expected_log_evidence", rough(next.expected_log_evidence)},
          {"measure", next.measure},
          {"cost", rough(next.cost)}};
}

Json json_of(const GapRow& row) {
  return {{"experiment", row.experiment},
          {"hold_out", row.hold_out},
          {"before", rough(row.before)},
          {"after", rough(row.after)},
          {"runner_up", rough(row.runner_up)},
          {"torque_measured_N_m", json_of(row.torque_measured)},
          {"torque_before_N_m", json_of(row.torque_before)},
          {"torque_after_N_m", json_of(row.torque_after)}};
}

Json json_of(const PlaceOfGap& place) {
  return {{"experiment", place.experiment},
          {"observable", place.observable},
          {"region", place.region},
          {"z", rough(place.z)},
          {"z_after", rough(place.z_after)}};
}

Json json_of(const CheckRow& check) {
  return {{"experiment", check.experiment},
          {"name", check.name},
          {"unit", check.unit},
          {"found", number(check.found)},
          {"expected", number(check.expected)},
          {"se", rough(check.se)},
          {"z", rough(check.z)},
          {"says", check.says}};
}

Json json_of(const LawCurve& law) {
  return {{"experiment", law.experiment}, {"name", law.name},           {"x_name", law.x_name}, {"x_unit", law.x_unit},
          {"y_name", law.y_name},         {"y_unit", law.y_unit},       {"x", column(law.x)},   {"y", column(law.y)},
          {"se", column(law.se)},         {"model", column(law.model)}, {"z", rough(law.z)},    {"says", law.says}};
}

Json json_of(const GapWorse& worse) {
  return {{"experiment", worse.experiment},
          {"observable", worse.observable},
          {"before", rough(worse.before)},
          {"after", rough(worse.after)}};
}

Json json_of(const FittedUncertain& key) {
  return {{"key", key.key},
          {"given", number(key.given)},
          {"given_sd", rough(key.given_sd)},
          {"found", number(key.found.value)},
          {"se", rough(key.found.se)}};
}

template <typename T>
Json list_of(const std::vector<T>& all) {
  Json out = Json::array();
  for (const T& one : all) out.push_back(json_of(one));
  return out;
}

}  // namespace

std::string diagnosis_json(const Diagnosis& d) {
  const bool has_runner_up = !d.runner_up.empty();
  const Json all = {{"verdict", name_of(d.finding)},
                    {"sentence", d.sentence.empty() ? diagnosis_sentence(d) : d.sentence},
                    {"effects", list_of(d.effects)},
                    {"ranking", list_of(d.ranking)},
                    {"where", list_of(d.where)},
                    {"gap",
                     {{"before", json_of(gap_before(d))},
                      {"after", json_of(gap_after(d))},
                      {"runner_up", has_runner_up ? json_of(gap_of_runner_up(d)) : Json()},
                      {"experiments", list_of(d.gaps)}}},
                    {"runner_up", has_runner_up ? Json(d.runner_up) : Json()},
                    {"worse", list_of(d.worse)},
                    {"next_experiment", d.next.empty() ? Json() : json_of(d.next.front())},
                    {"next_experiments", list_of(d.next)},
                    {"checks", list_of(d.checks)},
                    {"laws", list_of(d.laws)},
                    {"found_laws", d.found_laws},
                    {"keys", list_of(d.keys)},
                    {"alike", d.alike},
                    {"caveats", d.caveats},
                    {"mill", d.mill},
                    {"measured", d.measured},
                    {"version", kVersion},
                    {"simulations", d.simulations},
                    {"seconds", number(d.seconds)}};
  return all.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace tumble::io
