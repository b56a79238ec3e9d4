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

constexpr int kEdge = 480;  // [px]
constexpr double kMostTurns = 3;
constexpr double kAlike = 0.02;      // of two mills' speeds: they can be kept in step by their angle
constexpr double kJustShort = 0.05;  // of a lifter's pitch

// [degrees], after so many seconds; NaN where not known.
double mill_angle_at(const ChargeMotion& m, double time) {
  const auto& rows = m.profile;
  if (rows.empty()) return kNotGiven;
  const auto after = std::lower_bound(rows.begin(), rows.end(), rows.front().time + time,
                                      [](const ProfileRow& row, double t) { return row.time < t; });
  if (after == rows.end()) return rows.back().mill_angle_deg;
  if (after == rows.begin()) return after->mill_angle_deg;
  const ProfileRow& before = *(after - 1);
  const double share = (rows.front().time + time - before.time) / (after->time - before.time);
  return before.mill_angle_deg + share * (after->mill_angle_deg - before.mill_angle_deg);
}

// By the speed; where that is not known, by the angle of its frames (whatever the unit of their time).
double degrees_per_second(const ChargeMotion& m) {
  if (!std::isnan(m.speed_rpm.value) || m.profile.size() < 2) return 6 * m.speed_rpm.value;
  const ProfileRow &first = m.profile.front(), &last = m.profile.back();
  return (last.mill_angle_deg - first.mill_angle_deg) / (last.time - first.time);
}

void write_run(const Shown& s, const Stretch& stretch, const fs::path& file, double quality,
               const CommonOptions& options) {
  FilmPlan plan;
  plan.style.width = plan.style.height = plan.format.width = plan.format.height = kEdge;
  plan.style.overlay.text = false;
  plan.style.slow = 1 / (kSmallRate * stretch.step);
  plan.format.fps_numerator = static_cast<int>(kSmallRate);
  plan.format.crf = quality;
  plan.format.threads = options.threads;
  plan.from = stretch.from;
  plan.seconds = stretch.seconds;
  render_run(*s.run, *s.motion, plan, file, options);
}

void write_film(const Shown& s, const Stretch& stretch, const fs::path& file, double quality,
                const CommonOptions& options) {
  const std::vector<int> frames = frames_of(*s.motion, stretch);
  io::FilmFormat format;
  format.width = format.height = kEdge;
  format.fps_numerator = static_cast<int>(kSmallRate);
  format.crf = quality;
  format.threads = options.threads;
  io::FilmWriter writer(file.string(), format);
  analysis::PictureView view;
  view.camera = s.motion->camera;
  view.mirror = view.clockwise = s.motion->rotation == Rotation::kClockwise;
  view.edge_px = kEdge;
  ProgressLine line(options, "making a small film", "nothing was written");
  analysis::show_film(
      s.film.string(), view, frames, [&](const Image& image) { writer.write(image); }, line.callback());
  writer.finish();
}

fs::path write_small(const Shown& s, const Stretch& stretch, const fs::path& file, const CommonOptions& options) {
  for (const double quality : kSmallQuality) {
    if (s.run != nullptr)
      write_run(s, stretch, file, quality, options);
    else
      write_film(s, stretch, file, quality, options);
    if (fs::file_size(file) <= kSmallSize) return file;
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

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

double span_of(const ChargeMotion& m) {
  return m.profile.size() < 2 ? 0 : m.profile.back().time - m.profile.front().time;
}

double seconds_shown(const ChargeMotion& m) {
  const double turn = 360 / std::abs(degrees_per_second(m));
  return std::isfinite(turn) ? std::min(span_of(m), kMostTurns * turn) : span_of(m);
}

Stretch stretch_of(double from, double seconds) {
  constexpr double kMostPictures = 240;
  const double slow = std::clamp(kMostPictures / kSmallRate / seconds, 1.0, 4.0), step = 1 / (kSmallRate * slow);
  return {from, std::min(seconds, (kMostPictures - 1) * step), step};
}

std::vector<int> frames_of(const ChargeMotion& film, const Stretch& stretch) {
  const auto& rows = film.profile;
  std::vector<int> frames;
  std::size_t row = 0;
  for (double t = stretch.from; t <= stretch.from + stretch.seconds + 1e-9; t += stretch.step) {
    const auto off = [&](std::size_t i) { return std::abs(rows[i].time - rows.front().time - t); };
    while (row + 1 < rows.size() && off(row + 1) <= off(row)) ++row;
    frames.push_back(rows[row].frame);
  }
  return frames;
}

InStep in_step(const ChargeMotion& a, const ChargeMotion& b) {
  InStep step;
  const double turn_a = degrees_per_second(a), turn_b = degrees_per_second(b), ratio = turn_a / turn_b;
  const bool clocks = !std::isnan(a.frames_per_second) && !std::isnan(b.frames_per_second);
  step.by_angle = std::isfinite(ratio) && ratio > 0 && (!clocks || std::abs(ratio - 1) < kAlike);
  if (step.by_angle) step.pace = ratio;
  const int lifters = a.lifter_count;
  if (lifters <= 0 || lifters != b.lifter_count || !(std::abs(turn_b) > 0)) return step;
  // The mean over a film that stays in step, for the angle of a single frame may be off.
  std::vector<double> apart;
  for (const ProfileRow& row : a.profile) {
    const double time = row.time - a.profile.front().time;
    const double at_b = step.pace * time;
    if (!apart.empty() && (!step.by_angle || at_b > span_of(b))) break;
    apart.push_back(lifters * (row.mill_angle_deg - mill_angle_at(b, at_b)));
  }
  const double later = mean_direction(apart).value / lifters;  // of B, in degrees of the mill
  if (std::isnan(later)) return step;
  step.by_lifters = true;
  // Just short of a whole pitch is rather just before B's begin.
  const double pitch = 360.0 / lifters;
  if (later > (1 - kJustShort) * pitch)
    step.a_from = (pitch - later) / std::abs(turn_a);
  else
    step.b_from = later / std::abs(turn_b);
  return step;
}

SideBySide small_films(const Shown& a, const Shown& b, const fs::path& folder, const CommonOptions& options) {
  SideBySide films;
  double seconds = INFINITY;
  for (const Shown* s : {&a, &b}) {
    if (!s->any()) continue;
    seconds = std::min(seconds, seconds_shown(*s->motion));
  }
  if (!std::isfinite(seconds) || !(seconds > 0)) return films;

  InStep step;
  if (a.any() && b.any()) {
    step = in_step(*a.motion, *b.motion);
    if (!(step.b_from < span_of(*b.motion))) step.b_from = 0, step.by_lifters = false;
    seconds = std::min({seconds, span_of(*a.motion) - step.a_from, (span_of(*b.motion) - step.b_from) / step.pace});
    films.note =
        step.by_lifters ? "Both begin with the lifters in the same place" : "Both begin with their first picture";
    films.note += step.by_angle
                      ? " and keep step by the angle of their mills."
                      : " and keep step by the clock, for the mills turn at different speeds or at ones not known.";
  }
  films.rate = kSmallRate;
  const Stretch stretch = stretch_of(step.a_from, seconds);
  films.slow = 1 / (kSmallRate * stretch.step);
  if (a.any()) {
    films.a = write_small(a, stretch, folder / "a.mp4", options);
    films.a_caption = caption_of(a);
  }
  if (b.any()) {
    films.b =
        write_small(b, {step.b_from, stretch.seconds * step.pace, stretch.step * step.pace}, folder / "b.mp4", options);
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
