#pragma once
#include <filesystem>

#include "core/config.h"

namespace tumble::io {

// The shell's outline at mill angle 0, worn and incomplete as the config has it, arcs of the shell in chords of at most
// `chord` [m]. Expect a config with a diameter and complete lifters.

// A drawing: section of the steel, numbered lifters, axis, direction of rotation, scale bar, title.
void write_shell_svg(const std::filesystem::path& path, const Config& config, double chord);

// x_m,y_m,lifter,face: one row a point, counter-clockwise; the face is that from this point to the next, the lifter is
// empty on the shell.
void write_shell_csv(const std::filesystem::path& path, const Config& config, double chord);

}  // namespace tumble::io
