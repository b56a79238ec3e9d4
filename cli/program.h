#pragma once
#include <CLI/CLI.hpp>
#include <span>
#include <string>

// `tumble` and its verbs, from the command line to the exit status.
namespace tumble::cli {

using AddVerb = void (*)(CLI::App&);
int run_program(int argc, char** argv, std::span<const AddVerb> verbs);

// One line on standard error, whatever was caught: place, what is wrong, what would be right. Returns the status.
int fail(const std::string& line, int status);

}  // namespace tumble::cli
