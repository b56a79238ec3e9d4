#pragma once
#include <array>
#include <filesystem>
#include <string>

#include "core/charge_motion.h"

namespace tumble::io {

// MOTION.h5: docs/motion-file.md. Same groups whether it came from a run file or from a film.
void write_motion(const std::filesystem::path& path, const ChargeMotion& motion);
ChargeMotion read_motion(const std::filesystem::path& path);
bool is_motion_file(const std::filesystem::path& path);

// All of these go into an existing folder; torque.csv for run files alone.
inline constexpr std::array kTables{"summary.json", "profile.csv", "tracks.csv", "occupancy.csv", "torque.csv"};
void write_csv(const std::filesystem::path& folder, const ChargeMotion& motion);

// summary.json as text: also what --json prints.
std::string summary_json(const ChargeMotion& motion);

}  // namespace tumble::io
