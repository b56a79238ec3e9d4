#include "cli/steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "cli/ball_insight.h"
#include "cli/picture_output.h"
#include "cli/run_player.h"
#include "core/error.h"
#include "core/large_arrays.h"
#include "core/parallel_for.h"
#include "core/quantile.h"
#include "io/drawing_file.h"
#include "io/image_file.h"
#include "render/sheet.h"

namespace tumble::cli {
namespace {

BallInsight insight_of(const Shot& shot, const render::Style& style) {
  return {*shot.run, shot.truth ? *shot.truth : ChargeMotion{}, style};
}

// Where the scales of all runs end: what is drawn of any of them.
struct Tops {
  double residence = 0, force = 0;  // 0 where nothing shows it
};

Tops tops_of(const std::vector<Shot>& shots, const render::Style& style) {
  Tops tops;
  const bool shows_forces = render::shows_forces(style), shows_residence = render::shows_residence(style);
  if (!shows_forces && !shows_residence) return tops;
  for (const Shot& shot : shots) {
    BallInsight insight = insight_of(shot, style);
    if (shows_residence) tops.residence = std::max(tops.residence, insight.residence_top());
    if (shows_forces) tops.force = std::max(tops.force, insight.force_top());
  }
  return tops;
}

Range colour_ends(const std::vector<Shot>& shots, render::Colour colour, const Tops& tops) {
  if (colour == render::Colour::kResidence) return {0, tops.residence};
  if (colour == render::Colour::kForce) return {0, tops.force};
  return scale_of(shots, colour);
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

// Runs played in step, and what their frames do not hold.
class Players {
 public:
  Players(const std::vector<Shot>& shots, const render::Style& style) : shots_(shots), seen_(shots.size()) {
    for (const Shot& shot : shots) {
      players_.emplace_back(*shot.run);
      insights_.push_back(insight_of(shot, style));
    }
  }
  std::vector<Frame> at(double time) {  // after their beginnings
    std::vector<Frame> frames;
    for (std::size_t c = 0; c < shots_.size(); ++c) frames.push_back(players_[c].at(shots_[c].begin + time));
    return frames;
  }
  // What goes with the frames; valid until the next call.
  std::vector<render::Moment> moments(const std::vector<Frame>& frames, const std::vector<std::vector<Frame>>& past) {
    std::vector<render::Moment> moments;
    for (std::size_t c = 0; c < shots_.size(); ++c) {
      seen_[c] = insights_[c].at(frames[c].time);
      moments.push_back(moment_of(shots_[c], frames[c]));
      moments.back().past = past[c];
      moments.back().contacts = seen_[c].contacts;
      moments.back().of_ball = seen_[c].of_ball;
    }
    return moments;
  }

 private:
  const std::vector<Shot>& shots_;
  std::vector<RunPlayer> players_;
  std::vector<BallInsight> insights_;
  std::vector<BallInsight::Moment> seen_;
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

ChargeMotion measure_run(const io::RunReader& run, const CommonOptions& options) {
  ProgressLine line(options, "reading the run", "nothing was written");
  return analysis::measure_frames(run.setup(), frames_of(run), line.callback());
}

std::vector<ProfileRow> measure_run_edges(const io::RunReader& run, const CommonOptions& options) {
  ProgressLine line(options, "reading the run", "nothing was written");
  return analysis::measure_edges(run.setup(), frames_of(run), line.callback());
}

std::size_t render_shots(const std::vector<Shot>& shots, const FilmPlan& plan, const fs::path& output,
                         const CommonOptions& options) {
  keep_large_arrays();
  check_view(shots, plan.style.view);
  const Timeline timeline = timeline_of(shots, plan);
  const std::size_t count = timeline.count;
  const Tops tops = tops_of(shots, plan.style);
  const Range scale = colour_ends(shots, plan.style.colour, tops);
  std::vector<render::SheetMill> mills;
  for (const Shot& shot : shots) mills.push_back({shot.run->setup(), shot.label});
  const auto make_sheet = [&] {
    auto sheet = std::make_unique<render::Sheet>(mills, plan.style);
    sheet->set_scale(scale.low, scale.high);
    if (tops.force > 0) sheet->set_force_scale(tops.force);
    for (std::size_t c = 0; c < shots.size(); ++c)
      if (shots[c].truth && render::shows_mean(plan.style.overlay)) sheet->set_mean(c, *shots[c].truth);
    return sheet;
  };

  // Trails show a fixed stretch of true time: so many pictures before each. A still takes them as a film would.
  const double before_step = timeline.step > 0 ? timeline.step : 1.0 / 240;
  const auto trail_of = [&](const render::Sheet& sheet) {
    return plan.style.overlay.tracks ? static_cast<std::size_t>(std::ceil(sheet.trail_seconds() / before_step)) : 0;
  };
  // What lies before a picture, oldest first, as far as the runs go; by run.
  const auto frames_before = [&](Players& players, std::size_t picture, std::size_t trail) {
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
    const auto sheet = make_sheet();
    Players players(shots, plan.style);
    const std::vector<std::vector<Frame>> past = frames_before(players, 0, trail_of(*sheet));
    const std::vector<Frame> frames = players.at(timeline.first);
    const Drawing drawing = sheet->sketch(frames, players.moments(frames, past), timeline.first);
    output.extension() == ".svg" ? io::write_svg(output, drawing) : io::write_pdf(output, drawing);
    return 1;
  }

  PictureOutput pictures(output, plan.format);
  ProgressLine line(options, "rendering", "nothing was written under " + output.string());
  const Progress progress = line.callback();

  // Each thread takes the next part of the film, draws and encodes it all, and puts it behind those that are ready.
  const std::size_t length = pictures.can_be_cut() ? part_length(count) : count;
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
      pictures.film()->append(std::move(it->second));
      ready.erase(it);
      appended = std::min(count, appended + length);
    }
  };

  const auto draw_parts = [&] {
    const auto sheet = make_sheet();
    Players players(shots, plan.style);
    const std::size_t trail = trail_of(*sheet);
    for (std::size_t first = take(); first < count; first = take()) {
      std::vector<std::vector<Frame>> past = frames_before(players, first, trail);
      std::optional<io::FilmPart> part;
      if (pictures.film()) part = pictures.film()->part(static_cast<std::int64_t>(first));
      for (std::size_t i = first; i < std::min(count, first + length); ++i) {
        if (!tell()) return;
        std::vector<Frame> frames = players.at(timeline.at(i));
        const Image& image = sheet->draw(frames, players.moments(frames, past), timeline.at(i));
        if (part)
          part->write(image);
        else
          pictures.put(i, image);
        if (trail == 0) continue;
        for (std::size_t c = 0; c < shots.size(); ++c) {
          if (past[c].size() == trail) past[c].erase(past[c].begin());
          past[c].push_back(std::move(frames[c]));
        }
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
  pictures.finish();
  report(progress, 1);
  return count;
}

std::size_t render_run(const io::RunReader& run, const ChargeMotion& truth, const FilmPlan& plan,
                       const fs::path& output, const CommonOptions& options) {
  if (run.frame_count() == 0) throw InputError(truth.origin, "holds no frames; simulate for longer");
  return render_shots({{&run, &truth, "", run.time().front()}}, plan, output, options);
}

}  // namespace tumble::cli
