#include "trials/verdict.h"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "io/text_file.h"

namespace tumble::trials {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kLargestMiB = 64;
constexpr std::array kVerdicts{"missing_effect", "agreement", "measurement_artefact", "unknown_effect", "ambiguous"};

double number(const Json& in, const char* key) {
  const auto it = in.find(key);
  return it == in.end() || !it->is_number() ? kNotGiven : it->get<double>();
}

double hold_out_gap(const Json& gap, const char* when) {
  const auto it = gap.find(when);
  return it == gap.end() || !it->is_object() ? kNotGiven : number(*it, "hold_out");
}

Named named_of(const Json& effect) {
  Named named{effect.at("name").get<std::string>(), {}};
  if (const auto it = effect.find("parameters"); it != effect.end())
    for (const auto& [name, p] : it->items()) named.parameters[name] = {number(p, "value"), number(p, "se")};
  return named;
}

Verdict read(const Json& j) {
  Verdict v;
  v.verdict = j.at("verdict").get<std::string>();
  if (std::find(kVerdicts.begin(), kVerdicts.end(), v.verdict) == kVerdicts.end())
    throw InputError("verdict", "is \"" + v.verdict + "\"");
  for (const Json& e : j.at("effects")) v.effects.push_back(named_of(e));
  for (const Json& r : j.at("ranking"))
    v.ranking.push_back({r.at("name").get<std::string>(), r.at("probability").get<double>()});
  std::stable_sort(v.ranking.begin(), v.ranking.end(),
                   [](const Ranked& a, const Ranked& b) { return a.probability > b.probability; });
  if (const auto gap = j.find("gap"); gap != j.end() && gap->is_object()) {
    v.gap_before = hold_out_gap(*gap, "before");
    v.gap_after = hold_out_gap(*gap, "after");
    v.gap_runner_up = hold_out_gap(*gap, "runner_up");
  }
  const auto next = j.find("next_experiment");
  v.has_next_experiment = next != j.end() && next->is_object();
  return v;
}

}  // namespace

Verdict parse_verdict(const std::string& json) {
  const auto broken = [](const std::string& why) {
    Verdict v;
    v.broken = io::one_line(why);
    return v;
  };
  try {
    return read(Json::parse(json));
  } catch (const Json::exception& e) {
    return broken(e.what());
  } catch (const InputError& e) {
    return broken(e.what());
  }
}

Verdict read_verdict(const std::filesystem::path& path) {
  try {
    return parse_verdict(io::read_text(path, "a verdict", kLargestMiB));
  } catch (const InputError& e) {
    Verdict v;
    v.broken = e.what();
    return v;
  }
}

}  // namespace tumble::trials
