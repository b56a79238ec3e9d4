#pragma once
#include <CLI/CLI.hpp>
#include <string>

#include "cli/console.h"

namespace tumble::cli {

// --quiet, --json, --force, --threads on a verb.
void add_common(CLI::App& verb, CommonOptions& options);

// "1280x720" -> width and height; throws InputError naming `option`.
void parse_size(const std::string& text, const std::string& option, int& width, int& height);

// "59.94" -> 60000/1001, "60" -> 60/1, "12.5" -> 25/2: the rates that films have; throws InputError.
void parse_rate(double fps, const std::string& option, int& numerator, int& denominator);

}  // namespace tumble::cli
