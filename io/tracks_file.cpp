#include "io/tracks_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "core/error.h"
#include "io/csv_file.h"

namespace tumble::io {
namespace {

constexpr double kMostFrames = 1e6;
constexpr double kLargestPicture = 1e5;  // [px]

PixelTracks tracks_of(const CsvTable& table) {
  PixelTracks tracks;
  tracks.name = table.place();
  const auto column = [&](const char* name, double least, double most, bool whole) {
    std::vector<double> values = table.numbers(name);
    for (std::size_t i = 0; i < values.size(); ++i)
      if (!(values[i] >= least && values[i] <= most) || (whole && values[i] != std::floor(values[i])))
        throw InputError(table.place(i, name), fmt::format("{} is {}; give a {} from {} to {}", name, values[i],
                                                           whole ? "whole number" : "number", least, most));
    return values;
  };
  const std::vector<double> track = column("track", 0, std::numeric_limits<int>::max(), true);
  const std::vector<double> frame = column("frame", 0, kMostFrames, true);
  const std::vector<double> x = column("x_px", -kLargestPicture, kLargestPicture, false);
  const std::vector<double> y = column("y_px", -kLargestPicture, kLargestPicture, false);
  const std::vector<double> r = column("r_px", 0.1, kLargestPicture, false);
  for (std::size_t i = 0; i < x.size(); ++i)
    tracks.sightings.push_back({static_cast<int>(track[i]), static_cast<int>(frame[i]), x[i], y[i], r[i]});

  std::vector<std::size_t> order(x.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return track[a] != track[b] ? track[a] < track[b] : frame[a] < frame[b];
  });
  for (std::size_t k = 1; k < order.size(); ++k)
    if (track[order[k]] == track[order[k - 1]] && frame[order[k]] == frame[order[k - 1]])
      throw InputError(
          table.place(order[k], "track"),
          fmt::format("track {} is in frame {} twice; a ball has one place", track[order[k]], frame[order[k]]));
  return tracks;
}

}  // namespace

PixelTracks read_pixel_tracks(const std::filesystem::path& path) { return tracks_of(read_csv(path)); }

PixelTracks parse_pixel_tracks(std::string text, const std::string& name) {
  return tracks_of(parse_csv(std::move(text), name));
}

}  // namespace tumble::io
