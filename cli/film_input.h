#pragma once
#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "analysis/charge_motion.h"
#include "core/config.h"

namespace tumble::cli {

// What a user tells of a film, on every verb that reads one.
struct FilmInput {
  std::filesystem::path mill;
  std::string rotation = "auto";
  std::optional<Config> drawing;  // of the mill, once settled
  analysis::TracksOptions told;
};

// --mill, --recorded-fps, --rotation on a verb.
void add_film_input(CLI::App& verb, FilmInput& input);

// Reads the drawing and checks what was told; throws InputError. `told` points into `input` from then on.
void settle(FilmInput& input);

}  // namespace tumble::cli
