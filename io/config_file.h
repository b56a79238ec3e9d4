#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/config.h"

namespace tumble::io {

// Reads MILL.toml, applies `--set key=value` assignments in order, and checks ranges (core/config.h `check`). Whether
// it is complete is asked by whoever simulates. Throws InputError: "mill.toml:12: mill.diamter: unknown key; did you
// mean mill.diameter?".
Config read_config(const std::filesystem::path& path, const std::vector<std::string>& sets = {});
Config parse_config(const std::string& toml, const std::string& name, const std::vector<std::string>& sets = {});

// The config with further assignments applied, in order: a campaign reads its MILL.toml once.
Config with_sets(Config config, const std::vector<std::string>& sets);

// The config as MILL.toml text with every key that is in force; parse_config gives the same config back, to the bit.
std::string to_toml(const Config& config);

// The key that says the same thing the other way ("mill.speed_rpm" for "mill.speed"): setting one removes the other.
// Empty where there is none.
std::string twin_of(const std::string& key);

}  // namespace tumble::io
