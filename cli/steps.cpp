#include "cli/steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "cli/run_player.h"
#include "core/angle.h"
#include "core/error.h"
#include "core/large_arrays.h"
#include "core/parallel_for.h"
#include "core/quantile.h"
#include "io/image_file.h"
#include "io/output.h"

namespace tumble::cli {
namespace {

// Top of the colour scale: what one ball in a hundred exceeds, so that a single impact does not darken the film.
double scale_top(const io::RunReader& run, render::Colour colour) {
  std::vector<double> values;
  const std::size_t step = std::max<std::size_t>(1, run.frame_count() / 50);
  for (std::size_t i = 0; i < run.frame_count(); i += step) {
    const Frame f = run.frame(i);
    for (std::size_t b = 0; b < f.x.size(); ++b)
      values.push_back(colour == render::Colour::kSpin ? std::abs(f.spin[b]) : std::hypot(f.vx[b], f.vy[b]));
  }
  if (values.empty()) return 1;
  return std::max(quantile_of(std::move(values), 0.99), 1e-3);
}

analysis::NextFrame frames_of(const io::RunReader& run) {
  return [&run, next = std::size_t{0}](Frame& frame) mutable {
    if (next >= run.frame_count()) return false;
    frame = run.frame(next++);
    return true;
  };
}

constexpr std::size_t kMostWorkers = 16;

// Frames of a film that are encoded by themselves, as many in each part but the last: few enough that several threads
// have work in a short film and that a player can jump, enough that the key frames do not burden a long one (parts of
// 48 make a film 5 % larger than one of a piece). Hangs on the film alone.
std::size_t part_length(std::size_t frames) {
  const std::size_t most = std::clamp<std::size_t>(frames / 16, 48, 240), parts = (frames + most - 1) / most;
  return (frames + parts - 1) / parts;
}

struct Marks {
  double toe_deg = kNotGiven, shoulder_deg = kNotGiven;
};

Marks marks_at(const ChargeMotion& truth, double time, double frames_per_second) {
  const auto i = static_cast<std::size_t>(std::lround(time * frames_per_second));
  if (i >= truth.profile.size()) return {};
  return {truth.profile[i].toe_deg, truth.profile[i].shoulder_deg};
}

}  // namespace

ChargeMotion measure_run(const io::RunReader& run, const CommonOptions& options) {
  ProgressLine line(options, "reading the run", "nothing was written");
  return analysis::measure_frames(run.setup(), frames_of(run), line.callback());
}

std::vector<ProfileRow> measure_run_edges(const io::RunReader& run, const CommonOptions& options) {
  ProgressLine line(options, "reading the run", "nothing was written");
  return analysis::measure_edges(run.setup(), frames_of(run), line.callback());
}

std::string picture_name(std::size_t index) { return fmt::format("frame_{:06}.png", index); }

std::size_t render_run(const io::RunReader& run, const ChargeMotion& truth, const FilmPlan& plan,
                       const fs::path& output, bool as_pictures, const CommonOptions& options) {
  if (run.frame_count() == 0) throw InputError(truth.origin, "holds no frames; simulate for longer");
  keep_large_arrays();
  const double film_rate = double(plan.format.fps_numerator) / plan.format.fps_denominator;
  const double start = run.time().front() + plan.from;
  double span = run.time().back() - start;
  if (!std::isnan(plan.seconds)) span = std::min(span, plan.seconds);
  const double step = 1 / (film_rate * plan.style.slow);
  const auto count = static_cast<std::size_t>(std::floor(span / step + 1e-6)) + 1;
  const double top = scale_top(run, plan.style.colour);
  const double stored_rate = run.setup().config.run.frames_per_second;

  std::unique_ptr<io::FilmWriter> film;
  if (!as_pictures) film = std::make_unique<io::FilmWriter>(output.string(), plan.format);
  ProgressLine line(options, "rendering", "nothing was written under " + output.string());
  const Progress progress = line.callback();

  // Each thread takes the next part of the film, draws and encodes it all, and puts it behind those that are ready.
  const std::size_t length = part_length(count);
  const std::size_t workers =
      std::min({static_cast<std::size_t>(thread_limit()), (count + length - 1) / length, kMostWorkers});
  std::mutex mutex;  // of all that follows
  std::size_t next = 0, drawn = 0;
  bool failed = false;
  std::map<std::size_t, io::FilmPart> ready;  // by its first frame
  std::size_t appended = 0;
  const auto take = [&] {
    const std::lock_guard lock(mutex);
    return failed ? count : std::exchange(next, std::min(count, next + length));
  };
  const auto tell = [&] {
    const std::lock_guard lock(mutex);
    report(progress, double(drawn++) / double(count));
    return !failed;
  };
  const auto deliver = [&](std::size_t first, io::FilmPart part) {
    const std::lock_guard lock(mutex);
    ready.emplace(first, std::move(part));
    for (auto it = ready.find(appended); it != ready.end(); it = ready.find(appended)) {
      film->append(std::move(it->second));
      ready.erase(it);
      appended = std::min(count, appended + length);
    }
  };

  const auto draw_parts = [&] {
    render::Renderer renderer(run.setup(), plan.style);
    renderer.set_scale(0, top);
    RunPlayer player(run);
    // Trails show a fixed stretch of true time: so many film frames before each.
    const std::size_t trail =
        plan.style.overlay.tracks ? static_cast<std::size_t>(std::ceil(renderer.trail_seconds() / step)) : 0;
    for (std::size_t first = take(); first < count; first = take()) {
      std::vector<Frame> past;
      for (std::size_t k = first > trail ? first - trail : 0; k < first; ++k)
        past.push_back(player.at(start + double(k) * step));
      std::optional<io::FilmPart> part;
      if (film) part = film->part(static_cast<std::int64_t>(first));
      for (std::size_t i = first; i < std::min(count, first + length); ++i) {
        if (!tell()) return;
        Frame frame = player.at(start + double(i) * step);
        const Marks marks = marks_at(truth, frame.time - run.time().front(), stored_rate);
        const Image& image = renderer.draw(frame, {marks.toe_deg, marks.shoulder_deg, run.time(), run.torque(), past});
        if (part)
          part->write(image);
        else
          io::write_png((output / picture_name(i)).string(), image);
        if (trail == 0) continue;
        if (past.size() == trail) past.erase(past.begin());
        past.push_back(std::move(frame));
      }
      if (!part) continue;
      part->finish();
      deliver(first, std::move(*part));
    }
  };
  parallel_for(workers, 1, [&](std::size_t, std::size_t) {
    try {
      draw_parts();
    } catch (...) {
      const std::lock_guard lock(mutex);
      failed = true;  // the others leave too
      throw;
    }
  });
  if (film) film->finish();
  report(progress, 1);
  return count;
}

}  // namespace tumble::cli
