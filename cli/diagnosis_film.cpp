#include "cli/diagnosis_film.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "analysis/film_pictures.h"
#include "cli/run_player.h"
#include "cli/side_by_side.h"
#include "render/sheet.h"

namespace tumble::cli {
namespace {

constexpr int kCellWidth = 480, kHeight = 600;  // [px]

struct Played {
  const io::RunReader* run;
  ChargeMotion motion;
  InStep step;  // of the film and it
};

}  // namespace

DiagnosisFilmFile make_diagnosis_film(const fs::path& measured, const ChargeMotion& motion, const io::RunReader& before,
                                      const io::RunReader* after, const fs::path& output,
                                      const CommonOptions& options) {
  std::vector<Played> runs{{&before, {}, {}}};
  if (after != nullptr) runs.push_back({after, {}, {}});
  double from = 0, seconds = seconds_shown(motion);
  for (Played& p : runs) {
    p.motion = measure_run(*p.run, options);
    p.step = in_step(motion, p.motion);
    if (!(p.step.b_from < span_of(p.motion))) p.step = InStep{0, 0, p.step.pace, false, p.step.by_angle};
    from = std::max(from, p.step.a_from);
  }
  for (const Played& p : runs) seconds = std::min(seconds, (span_of(p.motion) - p.step.b_at(from)) / p.step.pace);
  seconds = std::min(seconds, span_of(motion) - from);
  if (!(seconds > 0) || !std::isfinite(seconds)) return {};
  const Stretch stretch = stretch_of(from, seconds);
  const std::vector<int> frames = frames_of(motion, stretch);

  render::Style style;
  style.width = kCellWidth * static_cast<int>(1 + runs.size());
  style.height = kHeight;
  style.overlay.toe = style.overlay.shoulder = false;
  style.slow = 1 / (kSmallRate * stretch.step);
  std::vector<render::SheetMill> mills{{before.setup(), "Measured"}};
  std::vector<Shot> shots;
  for (const Played& p : runs) {
    mills.push_back({p.run->setup(), after == nullptr ? "Model" : p.run == after ? "After" : "Before"});
    shots.push_back({p.run, nullptr, "", 0});
  }
  render::Sheet sheet(mills, style);
  const Range scale = scale_of(shots, style.colour);
  sheet.set_scale(scale.low, scale.high);

  const bool clockwise = motion.rotation == Rotation::kClockwise;
  const double radius = before.setup().config.mill.diameter / 2;
  analysis::PictureView view;
  view.camera = motion.camera;
  view.mirror = view.clockwise = clockwise;
  view.margin = sheet.square().margin;
  view.edge_px = sheet.square().edge_px;
  view.straightened = true;
  view.depth = mean_of(before.setup().balls.radius) / radius;

  for (const double quality : kSmallQuality) {
    io::FilmFormat format;
    format.width = style.width;
    format.height = kHeight;
    format.fps_numerator = static_cast<int>(kSmallRate);
    format.crf = quality;
    format.threads = options.threads;
    io::FilmWriter writer(output.string(), format);
    std::vector<RunPlayer> players;
    for (const Played& p : runs) players.emplace_back(*p.run);
    ProgressLine line(options, "making a small film", "nothing was written under " + output.string());
    std::size_t index = 0;
    analysis::show_film(
        measured.string(), view, frames,
        [&](const Image& image) {
          const double time = from + static_cast<double>(index++) * stretch.step;
          std::vector<Frame> shown(mills.size());
          for (std::size_t k = 0; k < runs.size(); ++k)
            shown[k + 1] = players[k].at(runs[k].run->time().front() + runs[k].step.b_at(time));
          sheet.set_picture(0, image);
          writer.write(sheet.draw(shown, std::vector<render::Moment>(mills.size()), time - from));
        },
        line.callback());
    writer.finish();
    if (fs::file_size(output) <= kSmallSize) break;
  }

  const bool by_lifters = std::all_of(runs.begin(), runs.end(), [](const Played& p) { return p.step.by_lifters; });
  std::string caption = fmt::format(
      "What was measured{} {}Slowed {:.2g} times. The balls’ colour is their speed; no ball of one is a ball of "
      "another.",
      after == nullptr ? " and the model." : ", the model as it was, and with what was found.",
      by_lifters ? "All begin with the lifters in the same place. " : "", style.slow);
  if (clockwise) caption += " The film is mirrored, as all that is measured in it.";
  return {output, caption};
}

}  // namespace tumble::cli
