#pragma once
#include <CLI/CLI.hpp>

// One function per verb: adds its sub-command with options, help and what it does when called (add_render:
// cli/film_beside.h).
namespace tumble::cli {

void add_run(CLI::App& app);
void add_simulate(CLI::App& app);
void add_analyse(CLI::App& app);
void add_compare(CLI::App& app);
void add_parameters(CLI::App& app);
void add_sweep(CLI::App& app);
void add_calibrate(CLI::App& app);
void add_diagnose(CLI::App& app);
void add_effects(CLI::App& app);
void add_shell(CLI::App& app);

}  // namespace tumble::cli
