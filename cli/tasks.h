#pragma once
#include <CLI/CLI.hpp>
#include <string>

namespace tumble::cli {

// The verb by which Slurm has a task of a job array done: no user's, and in no list of verbs.
void add_task(CLI::App& app);

// --engine on a verb; and whether it says slurm. Throws InputError where it says neither that nor local.
void add_engine(CLI::App& verb, std::string& engine);
bool is_slurm(const std::string& engine);

}  // namespace tumble::cli
