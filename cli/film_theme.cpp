#include "cli/film_theme.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "cli/picture_output.h"
#include "cli/run_player.h"
#include "core/error.h"
#include "core/mill_shape.h"
#include "core/parallel_for.h"
#include "render/film_camera.h"

namespace tumble::cli {
namespace {

// A run is one slice of a mill, so the mill that is shown is as deep as its largest ball, and a little more.
render::FilmScene scene_of(const RunSetup& setup, bool mirror) {
  render::FilmScene scene;
  scene.shape = make_mill_shape(setup.config);
  scene.clockwise = mirror;
  scene.radius = setup.balls.radius;
  const auto largest = std::max_element(scene.radius.begin(), scene.radius.end());
  scene.length = largest == scene.radius.end() ? 0.1 * scene.shape.radius : 2.2 * *largest;
  for (const double r : scene.radius) {
    const auto& classes = setup.config.charge.balls;
    const auto same = std::find_if(classes.begin(), classes.end(), [r](const BallClass& c) { return c.radius == r; });
    scene.ball_class.push_back(static_cast<int>(same - classes.begin()));
  }
  return scene;
}

render::FilmMoment moment_of(const Frame& frame, double mill_speed, double length) {
  render::FilmMoment moment;
  moment.time = frame.time;
  moment.mill_angle = frame.mill_angle;
  moment.mill_speed = mill_speed;
  moment.ball = [&frame, length](std::size_t i, double later) {
    return render::BallState{frame.x[i] + frame.vx[i] * later,
                             frame.y[i] + frame.vy[i] * later,
                             -0.5 * length,
                             frame.vx[i],
                             frame.vy[i],
                             frame.angle[i] + frame.spin[i] * later,
                             frame.spin[i]};
  };
  return moment;
}

}  // namespace

std::size_t render_filmed_run(const io::RunReader& run, const FilmPlan& plan, std::uint64_t look_seed,
                              const fs::path& output, const CommonOptions& options) {
  if (run.frame_count() == 0) throw InputError("run", "holds no frames; simulate for longer");
  const double first = run.time().front();
  const Timeline timeline = timeline_of({{&run, nullptr, "", first}}, plan);

  render::FilmLook look = render::studio_look(look_seed, plan.style.width, plan.style.height);
  if (timeline.step > 0) look.timing.exposure = std::min(look.timing.exposure, 0.5 * timeline.step);
  const render::FilmScene scene = scene_of(run.setup(), plan.style.mirror);
  RunPlayer player(run);
  const double speed = run.setup().mill_speed;

  // Several cameras draw a batch of frames side by side, all of them exposed for the film's first frame.
  std::vector<std::unique_ptr<render::FilmCamera>> cameras(
      std::min<std::size_t>(static_cast<std::size_t>(thread_limit()), 8));
  const Frame start = player.at(first + timeline.first);
  parallel_for(cameras.size(), 1, [&](std::size_t w, std::size_t) {
    cameras[w] = std::make_unique<render::FilmCamera>();
    cameras[w]->aim(look, scene);
    cameras[w]->draw(moment_of(start, speed, scene.length), 0);
  });
  PictureOutput pictures(output, plan.format);
  ProgressLine line(options, "filming", "nothing was written under " + output.string());
  const Progress progress = line.callback();
  std::vector<Image> images(cameras.size());
  std::vector<Frame> frames(cameras.size());
  for (std::size_t from = 0; from < timeline.count; from += cameras.size()) {
    report(progress, double(from) / double(timeline.count));
    const std::size_t n = std::min(cameras.size(), timeline.count - from);
    for (std::size_t i = 0; i < n; ++i) frames[i] = player.at(first + timeline.at(from + i));
    parallel_for(n, 1, [&](std::size_t i, std::size_t) {
      images[i] = cameras[i]->draw(moment_of(frames[i], speed, scene.length), from + i).image;
    });
    for (std::size_t i = 0; i < n; ++i) pictures.put(from + i, images[i]);
  }
  pictures.finish();
  report(progress, 1);
  return timeline.count;
}

}  // namespace tumble::cli
