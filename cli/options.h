#pragma once
#include <CLI/CLI.hpp>
#include <map>
#include <string>

#include "cli/console.h"
#include "core/error.h"

namespace tumble::cli {

// One of `names`, whatever its case; throws InputError naming `option` and what there is.
template <class Value>
Value parse_name(const std::string& text, const std::string& option, const std::map<std::string, Value>& names) {
  if (const auto it = names.find(CLI::detail::to_lower(text)); it != names.end()) return it->second;
  std::string known;
  for (const auto& [name, value] : names) known += (known.empty() ? "" : ", ") + name;
  throw InputError(option, "is \"" + text + "\"; give one of " + known);
}

// --quiet, --json, --force, --threads on a verb.
void add_common(CLI::App& verb, CommonOptions& options);

// "1280x720" -> width and height; throws InputError naming `option`.
void parse_size(const std::string& text, const std::string& option, int& width, int& height);

// "640.5,360" -> u and v; throws InputError naming `option`.
void parse_point(const std::string& text, const std::string& option, double& u, double& v);

// "59.94" -> 60000/1001, "60" -> 60/1, "12.5" -> 25/2: the rates that films have; throws InputError.
void parse_rate(double fps, const std::string& option, int& numerator, int& denominator);

}  // namespace tumble::cli
