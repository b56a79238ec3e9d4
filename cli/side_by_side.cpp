#include "cli/side_by_side.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/film_pictures.h"
#include "core/angle.h"
#include "core/error.h"

namespace tumble::cli {
namespace {

constexpr int kEdge = 480;             // [px]
constexpr double kRate = 30;           // pictures per second
constexpr double kMostPictures = 240;  // of each film
constexpr double kMostTurns = 3;
constexpr std::uintmax_t kLargest = 6u << 20;  // [bytes] of one film
constexpr double kQuality[] = {26, 32, 38};    // x264's crf, one after the other until the film is small enough

struct Stretch {
  double from = 0;     // after the source's first frame [s]
  double seconds = 0;  // of its own time
  double step = 0;     // between pictures, likewise
};

double span_of(const Shown& s) {
  if (s.run != nullptr) return s.run->frame_count() < 2 ? 0 : s.run->time().back() - s.run->time().front();
  const auto& rows = s.motion->profile;
  return rows.size() < 2 ? 0 : rows.back().time - rows.front().time;
}

// [degrees], after so many seconds; NaN where not known.
double mill_angle_at(const Shown& s, double time) {
  const auto& rows = s.motion->profile;
  if (rows.empty()) return kNotGiven;
  const auto at = std::lower_bound(rows.begin(), rows.end(), rows.front().time + time,
                                   [](const ProfileRow& row, double t) { return row.time < t; });
  return (at == rows.end() ? rows.back() : *at).mill_angle_deg;
}

double degrees_per_second(const Shown& s) { return 6 * s.motion->speed_rpm.value; }

void write_run(const Shown& s, const Stretch& stretch, const fs::path& file, double quality,
               const CommonOptions& options) {
  FilmPlan plan;
  plan.style.width = plan.style.height = plan.format.width = plan.format.height = kEdge;
  plan.style.overlay.text = false;
  plan.style.slow = 1 / (kRate * stretch.step);
  plan.format.fps_numerator = static_cast<int>(kRate);
  plan.format.crf = quality;
  plan.format.threads = options.threads;
  plan.from = stretch.from;
  plan.seconds = stretch.seconds;
  render_run(*s.run, *s.motion, plan, file, options);
}

void write_film(const Shown& s, const Stretch& stretch, const fs::path& file, double quality,
                const CommonOptions& options) {
  const auto& rows = s.motion->profile;
  std::vector<int> frames;
  std::size_t row = 0;
  for (double t = stretch.from; t <= stretch.from + stretch.seconds + 1e-9; t += stretch.step) {
    const auto off = [&](std::size_t i) { return std::abs(rows[i].time - rows.front().time - t); };
    while (row + 1 < rows.size() && off(row + 1) <= off(row)) ++row;
    frames.push_back(rows[row].frame);
  }
  io::FilmFormat format;
  format.width = format.height = kEdge;
  format.fps_numerator = static_cast<int>(kRate);
  format.crf = quality;
  format.threads = options.threads;
  io::FilmWriter writer(file.string(), format);
  analysis::PictureView view;
  view.camera = s.motion->camera;
  view.mirror = s.motion->rotation == Rotation::kClockwise;
  view.edge_px = kEdge;
  ProgressLine line(options, "making a small film", "nothing was written");
  analysis::show_film(
      s.film.string(), view, frames, [&](const Image& image) { writer.write(image); }, line.callback());
  writer.finish();
}

fs::path write_small(const Shown& s, const Stretch& stretch, const fs::path& file, const CommonOptions& options) {
  for (const double quality : kQuality) {
    if (s.run != nullptr)
      write_run(s, stretch, file, quality, options);
    else
      write_film(s, stretch, file, quality, options);
    if (fs::file_size(file) <= kLargest) return file;
  }
  return {};  // pure noise: no film is better than one that no mail takes
}

std::string caption_of(const Shown& s) {
  std::string text = s.run != nullptr ? "The run as it is rendered; colour is speed, and each has its own scale."
                                      : "The film, cut to the mill.";
  if (s.run == nullptr && s.motion->rotation == Rotation::kClockwise)
    text += " Mirrored, as everything that is measured in it.";
  return text;
}

}  // namespace

SideBySide small_films(const Shown& a, const Shown& b, const fs::path& folder, const CommonOptions& options) {
  SideBySide films;
  double seconds = INFINITY;
  for (const Shown* s : {&a, &b}) {
    if (!s->any()) continue;
    seconds = std::min(seconds, span_of(*s));
    const double turn = 360 / std::abs(degrees_per_second(*s));
    if (std::isfinite(turn)) seconds = std::min(seconds, kMostTurns * turn);
  }
  if (!std::isfinite(seconds) || !(seconds > 0)) return films;

  // B's clock against A's, and how much later it begins.
  double pace = 1, later = 0;
  if (a.any() && b.any()) {
    const double ratio = degrees_per_second(a) / degrees_per_second(b);
    const bool alike = std::abs(ratio - 1) < 0.02;
    if (alike) pace = ratio;
    const int lifters = a.motion->lifter_count;
    const double apart = mill_angle_at(a, 0) - mill_angle_at(b, 0);
    if (lifters > 0 && lifters == b.motion->lifter_count && std::isfinite(apart)) {
      const double pitch = 360.0 / lifters;
      later = (apart - pitch * std::floor(apart / pitch)) / std::abs(degrees_per_second(b));
    }
    if (!(later < span_of(b))) later = 0;
    seconds = std::min({seconds, span_of(a), (span_of(b) - later) / pace});
    films.note = later > 0 ? "Both begin with the lifters in the same place" : "Both begin with their first picture";
    films.note += alike ? " and keep step by the angle of their mills."
                        : " and keep step by the clock, for the mills turn at different speeds or at ones not known.";
  }
  films.rate = kRate;
  films.slow = std::clamp(kMostPictures / kRate / seconds, 1.0, 4.0);
  const double step = 1 / (kRate * films.slow);
  seconds = std::min(seconds, (kMostPictures - 1) * step);
  if (a.any()) {
    films.a = write_small(a, {0, seconds, step}, folder / "a.mp4", options);
    films.a_caption = caption_of(a);
  }
  if (b.any()) {
    films.b = write_small(b, {later, seconds * pace, step * pace}, folder / "b.mp4", options);
    films.b_caption = caption_of(b);
  }
  if (!films.note.empty()) films.note += " ";
  films.note += fmt::format(
      "They run {:.2g} times slower than true time; the clock shows true time. Keys: the slider by "
      "arrows, pictures one by one by comma and full stop.",
      films.slow);
  return films;
}

}  // namespace tumble::cli
