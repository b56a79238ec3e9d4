#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/pixel_tracks.h"
#include "io/csv_file.h"

namespace tumble::io {

// Balls followed through a film by another program: a CSV table with the columns track, frame, x_px, y_px (down) and
// r_px, rows in any order; further columns are left alone. Throws InputError with file, line and column.
PixelTracks read_pixel_tracks(const std::filesystem::path& path);
PixelTracks parse_pixel_tracks(std::string text, const std::string& name);  // `name` stands in messages for the file

// Balls followed by another program, in metres about the mill's axis, as they stand in the file: a row per ball and
// frame, frame by frame; a repeated picture has the time of the one before. What is not told is NaN.
struct BallTracks {
  CsvTable table;  // for messages: place(row, column)
  std::vector<int> frame, id;
  std::vector<double> time, x, y, radius, spin;  // [s], [m], [rad/s]
  std::vector<double> mill_angle_deg;            // the same in all rows of a frame
};

// The columns frame, time_s, id, x_m, y_m, and where known radius_m, spin_rad_s and mill_angle_deg; further columns are
// left alone. Throws InputError with file, line and column: no number, frames or times out of order, a ball that is
// twice in a frame.
BallTracks read_ball_tracks(const std::filesystem::path& path);
BallTracks parse_ball_tracks(std::string text, const std::string& name);

}  // namespace tumble::io
