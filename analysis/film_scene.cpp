#include "analysis/film_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/mill_shape.h"

namespace tumble::analysis {
namespace {

constexpr double kReachesShell = 0.9;  // where balls must come to, of its radius: they ride on it, or on its lifters
constexpr std::size_t kSample = 400;   // frames from which lengths are told

SeenFrame all_places_of(std::span<const FilmBall> balls, double time, const FilmScene& scene) {
  SeenFrame frame;
  frame.time = time;
  const double readout = std::isnan(scene.drum.readout.value) ? 0.0 : scene.drum.readout.value;
  for (const FilmBall& seen : balls) {
    const Detection& d = seen.found;
    Sighting s;
    s.radius = scene.radii[static_cast<std::size_t>(d.size_class)];
    const Eigen::Vector2d place = mill_place_at(scene.drum.camera, {d.u, d.v}, scene.from_afar ? 0.0 : -s.radius);
    s.x = place.x();
    s.y = place.y();
    if (!(std::hypot(s.x, s.y) + s.radius < scene.radius + 0.4 * s.radius)) continue;
    s.deviation = d.deviation / scene.pixels_per_unit;
    s.size_class = d.size_class;
    s.score = d.score;
    s.visible = d.visible;
    s.colour = seen.colour;
    s.mark = seen.mark;
    s.u = d.u;
    s.v = d.v;
    s.time = time + readout * ((d.v + 0.5) / scene.drum.camera.height - 0.5);
    frame.balls.push_back(s);
  }
  return frame;
}

std::vector<SeenFrame> sample_of(const FilmPass& pass, const FilmScene& scene) {
  std::vector<SeenFrame> frames;
  const std::size_t n = pass.balls.size(), taken = std::min(n, kSample);
  for (std::size_t i = 0; i < taken; ++i) frames.push_back(all_places_of(pass.balls[i * n / taken], 0, scene));
  return frames;
}

// Drawn films show no perspective, whatever is supposed of the camera: seen as through one, the circle in which balls
// lie against the shell is not about the axis.
bool drawn_from_afar(const BallPlane& near, const BallPlane& afar) {
  constexpr double kClear = 6;  // difference of log likelihoods
  return afar.uneven + kClear < near.uneven;
}

// By how much touching balls and those against the shell contradict each other.
double contradiction(const BallPlane& plane) { return std::abs(plane.touching.value / plane.reach.value - 1); }

// Relative distance from `radius` of the nearest edge that goes round nearly all of the drum; large where there is
// none.
double edge_off(const FilmScene& scene, double radius) {
  constexpr double kAllRound = 0.9;  // of the directions
  double least = 1;
  for (const RingFound& ring : scene.drum.rings)
    if (ring.coverage > kAllRound) least = std::min(least, std::abs(ring.radius / radius - 1));
  return least;
}

// What was taken for the shell may be another circle. Where mill and balls are known and the balls' touching
// contradicts it, its scale is tried without it: if they then stop at the shell, two witnesses outvote one. Balls that
// do not fit between the lifters stop before it, anywhere from the tips on: then an edge all round must be the second.
void doubt_shell(const FilmPass& pass, FilmScene& scene, BallPlane& plane) {
  constexpr double kClear = 0.03, kAgreement = 0.012;
  constexpr double kRough = 0.02;  // of a scale by touching balls
  if (!(std::abs(plane.touching.value - 1) > kClear) || contradiction(plane) < kClear) return;
  FilmScene other = scene;
  multiply_lengths(other, 1 / plane.touching.value);
  BallPlane by_balls = measure_ball_plane(sample_of(pass, other), other.radius, {1.0, kRough});
  if (!(contradiction(by_balls) < kAgreement)) {
    const double ball = *std::max_element(scene.radii.begin(), scene.radii.end());
    const double tips = (scene.tip_radius - ball) / (scene.radius - ball), reach = by_balls.reach.value;
    const bool on_lifters = scene.tip_radius < scene.radius && reach < 1 && reach > tips - kAgreement;
    if (!on_lifters || edge_off(scene, scene.radius * plane.touching.value) > kAgreement) return;
    by_balls.reach = {};
    by_balls.factor = lengths_factor(by_balls, {1.0, kAgreement});
  }
  scene = std::move(other);
  plane = by_balls;
}

}  // namespace

void multiply_lengths(FilmScene& scene, double factor) {
  scene.drum.camera = with_lengths_times(scene.drum.camera, factor);
  scene.pixels_per_unit /= factor;
}

FilmScene make_scene(DrumView drum, const Config& known) {
  FilmScene scene;
  const MillCamera& camera = drum.camera;
  scene.radius = known.mill.diameter > 0 ? 0.5 * known.mill.diameter : 1.0;
  if (known.mill.diameter > 0) scene.metres = 1;
  const cv::Point2d middle = picture_of(camera, {0, 0, 0});
  scene.bound = {middle.x, middle.y, 0};
  double sum = 0;
  for (int k = 0; k < 72; ++k) {
    const double a = 2 * kPi * k / 72;
    const cv::Point2d p = picture_of(camera, {scene.radius * std::cos(a), scene.radius * std::sin(a), 0});
    const double reach = std::hypot(p.x - middle.x, p.y - middle.y);
    scene.bound.radius = std::max(scene.bound.radius, 1.01 * reach);
    sum += reach / 72;
  }
  scene.pixels_per_unit = sum / scene.radius;

  scene.tip_radius = scene.radius;
  const MillShape shape = make_mill_shape(known);  // worn as the file has it
  if (shape.tip_radius < shape.radius) {
    scene.tip_radius = scene.radius * shape.tip_radius / shape.radius;
  } else if (known.mill.lifters.height > 0 && known.mill.diameter > 0) {
    scene.tip_radius = scene.radius - known.mill.lifters.height;
  } else if (!known.origin.contains("mill.lifters.profile")) {
    for (const RingFound& ring : drum.rings)
      if (ring.kind == RingKind::kLifterTips) scene.tip_radius = ring.radius;
  }
  scene.drum = std::move(drum);
  return scene;
}

void settle_lengths(FilmScene& scene, const FilmPass& pass, const std::vector<double>& seen_radii,
                    const std::vector<double>& sizes, double mill_length, std::vector<std::string>& caveats) {
  const bool mill_known = !std::isnan(scene.metres), sizes_known = sizes.size() == seen_radii.size();
  for (std::size_t c = 0; c < seen_radii.size(); ++c)
    scene.radii.push_back(sizes_known && mill_known ? sizes[c] / scene.metres : seen_radii[c] / scene.pixels_per_unit);

  const Estimate scale{1.0, scene.drum.scale.se};
  BallPlane plane = measure_ball_plane(sample_of(pass, scene), scene.radius, scale);
  if (mill_known && sizes_known) doubt_shell(pass, scene, plane);
  scene.from_afar = true;
  const BallPlane afar = measure_ball_plane(sample_of(pass, scene), scene.radius, scale);
  scene.from_afar = drawn_from_afar(plane, afar);
  if (scene.from_afar) plane = afar;

  std::vector<SeenFrame> sample = sample_of(pass, scene);
  for (SeenFrame& frame : sample) drop_beyond(frame, scene.radius);
  // Few balls do not show it; but in so short a mill none can hide another's middle.
  const double smallest = *std::min_element(scene.radii.begin(), scene.radii.end());
  scene.one_layer = in_one_layer(sample) || mill_length / scene.metres < (2 + std::sqrt(3.0)) * smallest;
  DepthDoubt depth;
  if (!scene.from_afar) {
    double usual = 0;
    for (double r : scene.radii) usual += r / static_cast<double>(scene.radii.size());
    depth = depth_doubt(scene.one_layer, mill_length / scene.metres, usual, scene.drum.camera.translation.z(),
                        scene.drum.focal.se / scene.drum.focal.value);
  }
  scene.place_error = std::hypot(plane.factor.se, depth.place_error);
  if (mill_known && sizes_known) {
    multiply_lengths(scene, plane.factor.value);
    scene.shell_by_balls = shell_by_balls(plane);
    if (plane.outermost < kReachesShell)
      caveats.push_back(
          fmt::format("no ball is seen near a shell of mill.diameter {:.4g} m: check mill.diameter and charge.balls",
                      2 * scene.radius));
    if (contradiction(plane) > 0.03) {
      scene.place_error = std::hypot(scene.place_error, contradiction(plane));  // either may be right, or neither
      caveats.push_back(
          fmt::format("the balls' sizes and the mill's diameter do not fit together: by the distance at which balls "
                      "touch, the mill "
                      "would be {:.1f} % {} than mill.diameter; check mill.diameter and charge.balls",
                      100 * std::abs(plane.reach.value / plane.touching.value - 1),
                      plane.reach.value > plane.touching.value ? "larger" : "smaller"));
    }
  } else {
    if (!std::isnan(plane.touching.value))
      for (double& r : scene.radii) r *= plane.touching.value;
    if (sizes_known) scene.metres = sizes.front() / scene.radii.front();
  }
  if (scene.drum.in_view < kSeenWell) scene.place_error = std::hypot(scene.place_error, kOneSided);
  scene.glass_error = std::hypot(scene.place_error, depth.glass_error);
  scene.layer_length = std::isnan(mill_length) && scene.one_layer ? 0.0 : mill_length / scene.metres;
}

SeenFrame places_of(std::span<const FilmBall> balls, double time, const FilmScene& scene) {
  SeenFrame frame = all_places_of(balls, time, scene);
  drop_beyond(frame, scene.radius);
  drop_impossible(frame, scene.layer_length);
  return frame;
}

std::vector<bool> hidden_bins(const std::vector<double>& share, double roll_deg, bool clockwise, double reach) {
  std::vector<bool> hidden(360, false);
  if (share.size() != 360) return hidden;
  const int beside = static_cast<int>(std::lround(degrees(reach)));
  for (int i = 0; i < 360; ++i) {
    const double upright = i + 0.5, seen = (clockwise ? 180 - upright : upright) + roll_deg;
    if (!(share[static_cast<std::size_t>(wrap_360(seen))] > 0.5)) continue;
    for (int k = i - beside; k <= i + beside; ++k) hidden[static_cast<std::size_t>((k + 360) % 360)] = true;
  }
  return hidden;
}

}  // namespace tumble::analysis
