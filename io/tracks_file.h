#pragma once
#include <filesystem>

#include "core/pixel_tracks.h"

namespace tumble::io {

// Balls followed through a film by another program: a CSV table with the columns track, frame, x_px, y_px (down) and
// r_px, rows in any order; further columns are left alone. Throws InputError with file, line and column.
PixelTracks read_pixel_tracks(const std::filesystem::path& path);
PixelTracks parse_pixel_tracks(std::string text, const std::string& name);  // `name` stands in messages for the file

}  // namespace tumble::io
