#pragma once
#include <CLI/CLI.hpp>

// `tumble trials make` and `tumble trials score`, each added to the verb `trials`.
namespace tumble::trials {

void add_make(CLI::App& trials);
void add_score(CLI::App& trials);

}  // namespace tumble::trials
