#include "core/motion_quantities.h"
#include "io/comparison_file.h"
#include "io/json_number.h"

namespace tumble::io {
namespace {

using Json = nlohmann::ordered_json;

Json number(double v) { return json_number(v, 9); }
Json rough(double v) { return json_number(v, 4); }

Json source_json(const ChargeMotion& m) {
  return {
      {"file", m.origin},          {"source", name_of(m.source)}, {"diameter_m", number(2 * m.mill_radius)},
      {"lifters", m.lifter_count}, {"frames", m.frames},          {"frames_per_second", number(m.frames_per_second)},
      {"caveats", m.caveats}};
}

Json quantities_json(const Deviation& d) {
  Json all = Json::array();
  for (const Difference& one : d.differences) {
    Json row = {{"name", one.name},
                {"unit", one.unit},
                {"a", number(one.a.value)},
                {"a_se", rough(one.a.se)},
                {"b", number(one.b.value)},
                {"b_se", rough(one.b.se)},
                {"difference", number(one.difference)},
                {"se", rough(one.se)},
                {"z", rough(one.z)},
                {"chance", rough(one.chance)},
                {"beyond_chance", one.significant},
                {"condition", one.is_condition},
                {"counts", one.counts}};
    if (!one.note.empty()) row["note"] = one.note;
    all.push_back(row);
  }
  return all;
}

Json column(const std::vector<double>& values, int digits) {
  Json out = Json::array();
  for (const double v : values) out.push_back(json_number(v, digits));
  return out;
}

Json sampled_json(const SampledDifference& d) {
  Json out = {{"name", d.name}, {"unit", d.unit}};
  if (d.n > 0) {
    out["cells"] = d.n;
    out["cell_in_mill_radii"] = d.cell;
  } else {
    out["along"] = d.x_name;
    out["along_unit"] = d.x_unit;
  }
  out["compared"] = d.compared;
  out["beyond_chance"] = d.beyond_chance;
  if (!d.where.empty()) out["where"] = d.where;
  if (d.n == 0) out["x"] = column(d.x, 7);
  out["a"] = column(d.a, 6);
  out["a_se"] = column(d.a_se, 4);
  out["b"] = column(d.b, 6);
  out["b_se"] = column(d.b_se, 4);
  out["difference"] = column(d.difference, 6);
  out["se"] = column(d.se, 4);
  out["z"] = column(d.z, 4);
  Json named = Json::array();
  for (std::size_t i = 0; i < d.significant.size(); ++i)
    if (d.significant[i]) named.push_back(i);
  out["beyond_chance_at"] = named;
  return out;
}

Json summary(const Comparison& c) {
  const Deviation& d = *c.deviation;
  Json kinds = Json::array();
  for (const Agreement& of : d.agreements)
    kinds.push_back({{"name", of.name}, {"compared", of.compared}, {"mean_square_z", rough(of.mean_square)}});
  return {{"verdict", name_of(d.verdict)},
          {"sentence", d.sentence},
          {"number",
           {{"value", rough(d.chi)},
            {"of_equal_mills", 1},
            {"limit_of_equal_mills", rough(d.chi_limit)},
            {"kinds", kinds}}},
          {"a", source_json(*c.a.motion)},
          {"b", source_json(*c.b.motion)},
          {"caveats", d.caveats},
          {"quantities", quantities_json(d)}};
}

std::string text_of(const Json& json) { return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n"; }

}  // namespace

std::string deviation_summary(const Comparison& c) {
  Json out = summary(c);
  for (const auto& [key, all] : {std::pair{"lines", &c.deviation->lines}, {"fields", &c.deviation->fields}}) {
    out[key] = Json::array();
    for (const SampledDifference& d : *all)
      out[key].push_back({{"name", d.name}, {"compared", d.compared}, {"beyond_chance", d.beyond_chance}});
  }
  return text_of(out);
}

std::string deviation_json(const Comparison& c) {
  Json out = summary(c);
  for (const auto& [key, all] : {std::pair{"lines", &c.deviation->lines}, {"fields", &c.deviation->fields}}) {
    out[key] = Json::array();
    for (const SampledDifference& d : *all) out[key].push_back(sampled_json(d));
  }
  return text_of(out);
}

}  // namespace tumble::io
