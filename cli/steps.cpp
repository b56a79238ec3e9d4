#include "cli/steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <exception>
#include <fstream>
#include <memory>
#include <vector>

#include "cli/run_player.h"
#include "core/angle.h"
#include "core/error.h"
#include "core/parallel_for.h"
#include "core/quantile.h"
#include "io/image_file.h"
#include "io/output.h"
#include "io/tracks_file.h"

namespace tumble::cli {
namespace {

// HDF5's signature: a run file, even one cut short, is to be refused as a run file and not as a film.
bool looks_like_hdf5(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  char head[8] = {};
  return file.read(head, sizeof head) && std::memcmp(head, "\x89HDF\r\n\x1a\n", sizeof head) == 0;
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

std::string picture_name(std::size_t index) { return fmt::format("frame_{:06}.png", index); }

std::size_t render_run(const io::RunReader& run, const ChargeMotion& truth, const FilmPlan& plan,
                       const fs::path& output, bool as_pictures, const CommonOptions& options) {
  if (run.frame_count() == 0) throw InputError(truth.origin, "holds no frames; simulate for longer");
  const double film_rate = double(plan.format.fps_numerator) / plan.format.fps_denominator;
  const double start = run.time().front() + plan.from;
  double span = run.time().back() - start;
  if (!std::isnan(plan.seconds)) span = std::min(span, plan.seconds);
  const double step = 1 / (film_rate * plan.style.slow);
  const auto count = static_cast<std::size_t>(std::floor(span / step + 1e-6)) + 1;
  const double top = scale_top(run, plan.style.colour);
  const double stored_rate = run.setup().config.run.frames_per_second;

  // Several renderers draw a batch of frames side by side; then the batch is written in order.
  const std::size_t workers = std::min<std::size_t>(static_cast<std::size_t>(thread_limit()), 8);
  constexpr std::size_t kEach = 4;
  std::vector<std::unique_ptr<render::Renderer>> renderers;
  for (std::size_t w = 0; w < workers; ++w) {
    renderers.push_back(std::make_unique<render::Renderer>(run.setup(), plan.style));
    renderers.back()->set_scale(0, top);
  }
  std::unique_ptr<io::FilmWriter> film;
  if (!as_pictures) film = std::make_unique<io::FilmWriter>(output.string(), plan.format);

  ProgressLine line(options, "rendering", "nothing was written under " + output.string());
  const Progress progress = line.callback();
  RunPlayer player(run);
  // Trails show a fixed stretch of true time: so many film frames before each.
  const std::size_t trail =
      plan.style.overlay.tracks ? static_cast<std::size_t>(std::ceil(renderers[0]->trail_seconds() / step)) : 0;
  std::vector<Image> images(workers * kEach);
  std::vector<Frame> frames(workers * kEach);
  for (std::size_t from = 0; from < count; from += images.size()) {
    report(progress, double(from) / double(count));
    const std::size_t n = std::min(images.size(), count - from);
    std::vector<Frame> before;  // for trails: the film frames before this batch, then the batch itself
    if (trail > 0)
      for (std::size_t k = from > trail ? from - trail : 0; k < from; ++k)
        before.push_back(player.at(start + double(k) * step));
    const std::size_t lead = before.size();
    for (std::size_t i = 0; i < n; ++i) frames[i] = player.at(start + double(from + i) * step);
    if (trail > 0) before.insert(before.end(), frames.begin(), frames.begin() + static_cast<std::ptrdiff_t>(n));

    parallel_for(workers, 1, [&](std::size_t w, std::size_t) {
      for (std::size_t i = w * kEach; i < std::min(n, (w + 1) * kEach); ++i) {
        const Marks marks = marks_at(truth, frames[i].time - run.time().front(), stored_rate);
        render::Moment moment{marks.toe_deg, marks.shoulder_deg, run.time(), run.torque(), {}};
        if (trail > 0) {
          const std::size_t here = lead + i, first = here > trail ? here - trail : 0;
          moment.past = std::span<const Frame>(before).subspan(first, here - first);
        }
        images[i] = renderers[w]->draw(frames[i], moment);
      }
    });
    for (std::size_t i = 0; i < n; ++i) {
      if (film)
        film->write(images[i]);
      else
        io::write_png((output / picture_name(from + i)).string(), images[i]);
    }
  }
  if (film) film->finish();
  report(progress, 1);
  return count;
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
    motion = analysis::are_stills(input.string()) ? analysis::measure_stills(input.string(), film, line.callback())
                                                  : analysis::measure_film(input.string(), film, line.callback());
  }
  motion.origin = input.string();
  return motion;
}

}  // namespace tumble::cli
