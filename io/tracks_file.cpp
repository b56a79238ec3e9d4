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
constexpr double kMostIds = std::numeric_limits<int>::max();
constexpr double kLargestPicture = 1e5;  // [px]

enum class Is { kNumber, kWhole };

std::vector<double> column(const CsvTable& table, const char* name, double least, double most, Is is) {
  std::vector<double> values = table.numbers(name);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!(values[i] >= least && values[i] <= most) || (is == Is::kWhole && values[i] != std::floor(values[i])))
      throw InputError(table.place(i, name), fmt::format("{} is {}; give a {} from {} to {}", name, values[i],
                                                         is == Is::kWhole ? "whole number" : "number", least, most));
  return values;
}

PixelTracks tracks_of(const CsvTable& table) {
  PixelTracks tracks;
  tracks.name = table.place();
  const std::vector<double> track = column(table, "track", 0, kMostIds, Is::kWhole);
  const std::vector<double> frame = column(table, "frame", 0, kMostFrames, Is::kWhole);
  const std::vector<double> x = column(table, "x_px", -kLargestPicture, kLargestPicture, Is::kNumber);
  const std::vector<double> y = column(table, "y_px", -kLargestPicture, kLargestPicture, Is::kNumber);
  const std::vector<double> r = column(table, "r_px", 0.1, kLargestPicture, Is::kNumber);
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

std::vector<int> whole_column(const CsvTable& table, const char* name, double most) {
  const std::vector<double> values = column(table, name, 0, most, Is::kWhole);
  return {values.begin(), values.end()};
}

// Frames grow and times do not fall (a repeated picture has the time of the one before), times and mill angles are a
// frame's, a ball is in a frame once.
void check_order(const BallTracks& t) {
  std::vector<int> here;  // ids in this frame
  std::size_t first = 0;
  for (std::size_t i = 0; i <= t.frame.size(); ++i) {
    if (i < t.frame.size() && t.frame[i] == t.frame[first]) {
      if (t.time[i] != t.time[first])
        throw InputError(t.table.place(i, "time_s"),
                         fmt::format("time_s is {} where frame {} began at {}; give all rows of a frame its one time",
                                     t.time[i], t.frame[i], t.time[first]));
      if (t.mill_angle_deg[i] != t.mill_angle_deg[first] &&
          !(std::isnan(t.mill_angle_deg[i]) && std::isnan(t.mill_angle_deg[first])))
        throw InputError(t.table.place(i, "mill_angle_deg"),
                         "is not that of the frame's first row; give all rows of a frame its one mill angle");
      continue;
    }
    here.assign(t.id.begin() + static_cast<std::ptrdiff_t>(first), t.id.begin() + static_cast<std::ptrdiff_t>(i));
    std::sort(here.begin(), here.end());
    if (const auto twin = std::adjacent_find(here.begin(), here.end()); twin != here.end())
      for (std::size_t k = i; k-- > first;)
        if (t.id[k] == *twin)
          throw InputError(t.table.place(k, "id"),
                           fmt::format("ball {} is in frame {} twice; a ball has one place", *twin, t.frame[first]));
    if (i == t.frame.size()) break;
    if (t.frame[i] < t.frame[first])
      throw InputError(
          t.table.place(i, "frame"),
          fmt::format("frame {} comes after frame {}; give the rows frame by frame", t.frame[i], t.frame[first]));
    if (t.time[i] < t.time[first])
      throw InputError(t.table.place(i, "time_s"),
                       fmt::format("time_s is {} in frame {} after {} in frame {}; times must not fall", t.time[i],
                                   t.frame[i], t.time[first], t.frame[first]));
    first = i;
  }
}

BallTracks ball_tracks_of(CsvTable table) {
  BallTracks t;
  t.frame = whole_column(table, "frame", kMostFrames);
  t.time = table.numbers("time_s");
  t.id = whole_column(table, "id", kMostIds);
  t.x = table.numbers("x_m");
  t.y = table.numbers("y_m");
  t.radius = table.numbers("radius_m", true);
  t.spin = table.numbers("spin_rad_s", true);
  t.mill_angle_deg = table.numbers("mill_angle_deg", true);
  t.table = std::move(table);
  for (std::size_t i = 0; i < t.radius.size(); ++i)
    if (t.radius[i] <= 0)
      throw InputError(t.table.place(i, "radius_m"), fmt::format("radius_m is {}; must be > 0 m", t.radius[i]));
  check_order(t);
  return t;
}

}  // namespace

BallTracks read_ball_tracks(const std::filesystem::path& path) { return ball_tracks_of(read_csv(path)); }

BallTracks parse_ball_tracks(std::string text, const std::string& name) {
  return ball_tracks_of(parse_csv(std::move(text), name));
}

PixelTracks read_pixel_tracks(const std::filesystem::path& path) { return tracks_of(read_csv(path)); }

PixelTracks parse_pixel_tracks(std::string text, const std::string& name) {
  return tracks_of(parse_csv(std::move(text), name));
}

}  // namespace tumble::io
