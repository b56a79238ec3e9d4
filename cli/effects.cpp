#include "core/effects.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/options.h"
#include "cli/verbs.h"
#include "core/error.h"
#include "io/config_keys.h"

namespace tumble::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kWidth = 100;  // of a line [characters]

// In lines of at most kWidth, all but the first indented.
std::string wrapped(const std::string& text, std::size_t first, std::size_t indent) {
  std::string out, line;
  std::size_t room = kWidth - first;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    if (!line.empty() && line.size() + 1 + word.size() > room) {
      out += line + "\n" + std::string(indent, ' ');
      line.clear();
      room = kWidth - indent;
    }
    line += (line.empty() ? "" : " ") + word;
    at = end + 1;
  }
  return out + line;
}

std::string range_of(const EffectParameter& p) {
  const std::string numbers = fmt::format("{:g} to {:g}", p.least, p.most);
  if (p.is_column()) return "list, " + numbers;
  return p.list ? "list of whole numbers, " + numbers : p.whole ? "whole number, " + numbers : numbers;
}

// What holds where the parameter is not given.
std::string default_of(const EffectParameter& p) {
  if (std::isfinite(p.otherwise)) return fmt::format("default {:g}", p.otherwise);
  return p.strength ? "off unless given" : "may be left out";
}

std::string value_of(const EffectParameter& p) {
  if (p.list) return fmt::format("[{:g}]", fmt::join(typical_list(p), ", "));
  return std::isfinite(p.typical) ? fmt::format("{:g}", p.typical) : "";
}

// Lines for MILL.toml at typical strength. Lifters that are no strength (the worn ones) are left out: all.
std::string example_of(const Effect& effect) {
  std::string lines = fmt::format("[effects.{}]\n", effect.name);
  for (const EffectParameter& p : effect.parameters) {
    if (p.list && p.whole && !p.strength) continue;
    if (const std::string value = value_of(p); !value.empty()) lines += fmt::format("{} = {}\n", p.name, value);
  }
  return lines;
}

std::string table() {
  std::string out;
  for (const Effect& e : all_effects()) {
    out += fmt::format("{:<19} {}\n", e.name, wrapped(e.summary, 20, 20));
    for (const EffectParameter& p : e.parameters)
      out += fmt::format("{:20}{} {}\n", "", p.name,
                         fmt::format("[{}{}{}]{}", range_of(p), *p.unit ? " " : "", p.unit,
                                     std::isfinite(p.otherwise) ? fmt::format(", default {:g}", p.otherwise) : ""));
  }
  return out + "\nFormula, source and an example of one of them: tumble effects NAME\n";
}

std::string page(const Effect& e) {
  std::string out = fmt::format("{}: {}\n\n", e.name, e.summary);
  out += fmt::format("Acts on   {}\n", e.acts_on);
  out += fmt::format("Formula   {}\n", wrapped(e.formula, 10, 10));
  out += fmt::format("Source    {}\n\nParameters\n", wrapped(e.source, 10, 10));
  for (const EffectParameter& p : e.parameters) {
    out += fmt::format("  {:<17} {}\n", p.name, wrapped(p.meaning, 20, 20));
    out += fmt::format("{:20}{}{}{}; {}{}\n", "", range_of(p), *p.unit ? " " : "", p.unit, default_of(p),
                       std::isfinite(p.typical) && p.strength ? fmt::format("; typical {:g}", p.typical) : "");
  }
  out += "\nIn MILL.toml\n";
  const std::string example = example_of(e);
  for (std::size_t at = 0; at < example.size();) {
    const std::size_t end = example.find('\n', at);
    out += "  " + example.substr(at, end - at) + "\n";
    at = end + 1;
  }
  return out + fmt::format("\nAn effect whose strengths are all 0 is absent. More: docs/effects/{}.md\n", e.name);
}

Json number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

Json json_of(const Effect& e) {
  Json parameters = Json::array();
  for (const EffectParameter& p : e.parameters)
    parameters.push_back({{"name", p.name},
                          {"unit", p.unit},
                          {"least", p.least},
                          {"most", p.most},
                          {"default", number(p.otherwise)},
                          {"typical", number(p.typical)},
                          {"strength", p.strength},
                          {"list", p.list},
                          {"whole", p.whole},
                          {"meaning", p.meaning}});
  return {{"name", e.name},     {"acts_on", e.acts_on},     {"summary", e.summary},    {"formula", e.formula},
          {"source", e.source}, {"parameters", parameters}, {"example", example_of(e)}};
}

const Effect& effect_named(const std::string& name) {
  if (const Effect* effect = find_effect(name)) return *effect;
  std::vector<std::string> names;
  for (const Effect& e : all_effects()) names.emplace_back(e.name);
  throw InputError(
      name, "is no effect; the nearest is " + io::nearest_word(name, names) + ", and `tumble effects` lists them all");
}

void effects(const std::string& name, bool json) {
  if (!name.empty()) {
    const Effect& effect = effect_named(name);
    print(json ? json_of(effect).dump(2) + "\n" : page(effect));
    return;
  }
  Json all = Json::array();
  for (const Effect& e : all_effects()) all.push_back(json_of(e));
  print(json ? Json{{"effects", all}}.dump(2) + "\n" : table());
}

}  // namespace

void add_effects(CLI::App& app) {
  struct Options {
    std::string name;
    bool json = false;
  };
  auto o = std::make_shared<Options>();
  CLI::App* verb = app.add_subcommand("effects", "List the effects that the model knows, or tell all about one");
  verb->add_option("name", o->name, "The effect");
  verb->add_flag("--json", o->json, "Print one JSON object");
  verb->footer("Example: tumble effects rolling_resistance");
  verb->callback([o] { effects(o->name, o->json); });
}

}  // namespace tumble::cli
