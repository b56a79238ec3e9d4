#include "cli/steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <fstream>
#include <memory>
#include <vector>

#include "cli/picture_output.h"
#include "cli/run_player.h"
#include "core/error.h"
#include "core/parallel_for.h"
#include "core/quantile.h"
#include "io/drawing_file.h"
#include "io/tracks_file.h"
#include "render/sheet.h"

namespace tumble::cli {
namespace {

struct Range {
  double low = 0, high = 0;
};

// The colour scale of all runs: up to what one ball in a hundred exceeds, so that a single impact does not darken the
// film.
Range scale_of(const std::vector<Shot>& shots, render::Colour colour) {
  std::vector<double> values;
  for (const Shot& shot : shots) {
    const io::RunReader& run = *shot.run;
    const std::vector<double>& radii = run.setup().balls.radius;
    if (colour == render::Colour::kSize) values.insert(values.end(), radii.begin(), radii.end());
    if (colour == render::Colour::kSize || colour == render::Colour::kSteel) continue;
    const std::size_t step = std::max<std::size_t>(1, run.frame_count() / 50);
    for (std::size_t i = 0; i < run.frame_count(); i += step) {
      const Frame f = run.frame(i);
      for (std::size_t b = 0; b < f.x.size(); ++b)
        values.push_back(colour == render::Colour::kSpin ? std::abs(f.spin[b]) : std::hypot(f.vx[b], f.vy[b]));
    }
  }
  if (values.empty()) return {0, 1};
  if (colour == render::Colour::kSize) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    return {*least, *most};
  }
  return {0, std::max(quantile_of(std::move(values), 0.99), 1e-3)};
}

// HDF5's signature: a run file, even one cut short, is to be refused as a run file and not as a film.
bool looks_like_hdf5(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  char head[8] = {};
  return file.read(head, sizeof head) && std::memcmp(head, "\x89HDF\r\n\x1a\n", sizeof head) == 0;
}

// The marks of one run at its frame, and its torque.
render::Moment moment_of(const Shot& shot, const Frame& frame) {
  render::Moment moment;
  moment.torque_time = shot.run->time();
  moment.torque = shot.run->torque();
  const double rate = shot.run->setup().config.run.frames_per_second;
  const auto i = static_cast<std::size_t>(std::lround((frame.time - shot.run->time().front()) * rate));
  if (!shot.truth || i >= shot.truth->profile.size()) return moment;
  moment.toe_deg = shot.truth->profile[i].toe_deg;
  moment.shoulder_deg = shot.truth->profile[i].shoulder_deg;
  return moment;
}

// Runs played in step.
class Players {
 public:
  explicit Players(const std::vector<Shot>& shots) : shots_(shots) {
    for (const Shot& shot : shots) players_.emplace_back(*shot.run);
  }
  std::vector<Frame> at(double time) {  // after their beginnings
    std::vector<Frame> frames;
    for (std::size_t c = 0; c < shots_.size(); ++c) frames.push_back(players_[c].at(shots_[c].begin + time));
    return frames;
  }

 private:
  const std::vector<Shot>& shots_;
  std::vector<RunPlayer> players_;
};

void check_view(const std::vector<Shot>& shots, const render::View& view) {
  if (view.from != render::View::From::kBall) return;
  for (const Shot& shot : shots) {
    const std::size_t balls = shot.run->setup().balls.size();
    if (view.ball >= balls)
      throw InputError("--camera", fmt::format("follows ball {}, but there are balls 0 to {}", view.ball, balls - 1));
  }
}

}  // namespace

ChargeMotion measure_run(const io::RunReader& run, const CommonOptions& options) {
  ProgressLine line(options, "reading the run", "nothing was written");
  std::size_t next = 0;
  return analysis::measure_frames(
      run.setup(),
      [&](Frame& frame) {
        if (next >= run.frame_count()) return false;
        frame = run.frame(next++);
        return true;
      },
      line.callback());
}

std::size_t render_shots(const std::vector<Shot>& shots, const FilmPlan& plan, const fs::path& output,
                         const CommonOptions& options) {
  check_view(shots, plan.style.view);
  const Timeline timeline = timeline_of(shots, plan);
  const Range scale = scale_of(shots, plan.style.colour);
  std::vector<render::SheetMill> mills;
  for (const Shot& shot : shots) mills.push_back({shot.run->setup(), shot.label});
  const auto new_sheet = [&] {
    auto sheet = std::make_unique<render::Sheet>(mills, plan.style);
    sheet->set_scale(scale.low, scale.high);
    return sheet;
  };

  // Several sheets draw a batch of frames side by side; then the batch is written in order.
  constexpr std::size_t kEach = 4;
  const std::size_t workers =
      std::min<std::size_t>({static_cast<std::size_t>(thread_limit()), 8, (timeline.count + kEach - 1) / kEach});
  std::vector<std::unique_ptr<render::Sheet>> sheets;
  for (std::size_t w = 0; w < workers; ++w) sheets.push_back(new_sheet());

  Players players(shots);
  // Trails show a fixed stretch of true time: so many pictures before each. A still takes them as a film would.
  const double before_step = timeline.step > 0 ? timeline.step : 1.0 / 240;
  const std::size_t trail =
      plan.style.overlay.tracks ? static_cast<std::size_t>(std::ceil(sheets[0]->trail_seconds() / before_step)) : 0;
  // What lies before a picture, oldest first, as far as the runs go; by run.
  const auto frames_before = [&](std::size_t picture) {
    std::vector<std::vector<Frame>> past(shots.size());
    for (std::size_t k = trail; k >= 1; --k) {
      const double then = timeline.first + (static_cast<double>(picture) - static_cast<double>(k)) * before_step;
      if (then < -1e-9) continue;
      std::vector<Frame> frames = players.at(then);
      for (std::size_t c = 0; c < shots.size(); ++c) past[c].push_back(std::move(frames[c]));
    }
    return past;
  };

  if (output_kind(output) == OutputKind::kDrawing) {
    const std::vector<std::vector<Frame>> past = frames_before(0);
    const std::vector<Frame> frames = players.at(timeline.first);
    std::vector<render::Moment> moments;
    for (std::size_t c = 0; c < shots.size(); ++c) {
      moments.push_back(moment_of(shots[c], frames[c]));
      moments.back().past = past[c];
    }
    const Drawing drawing = sheets[0]->sketch(frames, moments, timeline.first);
    output.extension() == ".svg" ? io::write_svg(output, drawing) : io::write_pdf(output, drawing);
    return 1;
  }

  PictureOutput pictures(output, plan.format);
  ProgressLine line(options, "rendering", "nothing was written under " + output.string());
  const Progress progress = line.callback();
  std::vector<Image> images(workers * kEach);
  std::vector<std::vector<Frame>> frames(images.size());
  for (std::size_t from = 0; from < timeline.count; from += images.size()) {
    report(progress, double(from) / double(timeline.count));
    const std::size_t n = std::min(images.size(), timeline.count - from);
    std::vector<std::vector<Frame>> past(shots.size());
    if (trail > 0) past = frames_before(from);
    const std::size_t lead = past[0].size();
    for (std::size_t i = 0; i < n; ++i) frames[i] = players.at(timeline.at(from + i));
    if (trail > 0)
      for (std::size_t c = 0; c < shots.size(); ++c)
        for (std::size_t i = 0; i < n; ++i) past[c].push_back(frames[i][c]);

    parallel_for(workers, 1, [&](std::size_t w, std::size_t) {
      std::vector<render::Moment> moments(shots.size());
      for (std::size_t i = w * kEach; i < std::min(n, (w + 1) * kEach); ++i) {
        const std::size_t here = lead + i, first = here > trail ? here - trail : 0;
        for (std::size_t c = 0; c < shots.size(); ++c) {
          moments[c] = moment_of(shots[c], frames[i][c]);
          if (trail > 0) moments[c].past = std::span<const Frame>(past[c]).subspan(first, here - first);
        }
        images[i] = sheets[w]->draw(frames[i], moments, timeline.at(from + i));
      }
    });
    for (std::size_t i = 0; i < n; ++i) pictures.put(from + i, images[i]);
  }
  pictures.finish();
  report(progress, 1);
  return timeline.count;
}

std::size_t render_run(const io::RunReader& run, const ChargeMotion& truth, const FilmPlan& plan,
                       const fs::path& output, const CommonOptions& options) {
  if (run.frame_count() == 0) throw InputError(truth.origin, "holds no frames; simulate for longer");
  return render_shots({{&run, &truth, "", run.time().front()}}, plan, output, options);
}

ChargeMotion measure(const fs::path& input, const analysis::TracksOptions& film, const CommonOptions& options) {
  std::error_code error;
  if (!fs::exists(input, error))
    throw InputError(input.string(), "does not exist; give a film, a folder or a run file");
  ChargeMotion motion;
  if (looks_like_hdf5(input)) {
    motion = measure_run(io::RunReader(input), options);
  } else if (input.extension() == ".csv") {
    motion = analysis::measure_tracks(io::read_pixel_tracks(input), film);
  } else {
    ProgressLine line(options, "reading the film", "nothing was written");
    motion = fs::is_directory(input, error) ? analysis::measure_stills(input.string(), film, line.callback())
                                            : analysis::measure_film(input.string(), film, line.callback());
  }
  motion.origin = input.string();
  return motion;
}

}  // namespace tumble::cli
