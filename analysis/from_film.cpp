#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core/utility.hpp>

#include "analysis/ball_plane.h"
#include "analysis/ball_spin.h"
#include "analysis/ballistics.h"
#include "analysis/charge_motion.h"
#include "analysis/charge_statistics.h"
#include "analysis/film_findings.h"
#include "analysis/film_pass.h"
#include "analysis/film_reader.h"
#include "analysis/frame_clock.h"
#include "analysis/time_base.h"
#include "analysis/tracking.h"
#include "analysis/view.h"
#include "core/angle.h"
#include "core/error.h"
#include "core/mill_shape.h"
#include "core/statistics.h"

namespace tumble::analysis {
namespace {

constexpr double kLeastScore = 0.2;      // of a ball: looked at at all
constexpr double kCalibrateShare = 0.2;  // of the work, for the progress
constexpr double kPassShare = 0.95;
constexpr double kWorstRoll = 1.5;  // standard error beyond which a camera's roll is not believed [degrees]

// Where the mill is in the pictures, and in which unit its lengths are.
struct Scene {
  DrumView drum;
  Circle bound;       // round everything inside the shell [px]
  double radius = 1;  // of the shell, in the camera's unit
  double tip_radius = 1;
  double pixels_per_unit = 1;  // in the middle of the glass
  std::vector<double> radii;   // of the size classes, in the camera's unit
  double metres = kNotGiven;   // per unit; NaN where nothing tells
};

std::vector<cv::Mat> sample_pictures(const std::string& path) {
  FilmReader film(path);
  std::vector<cv::Mat> pictures;
  cv::Mat picture;
  for (int f = 0; f <= 36 && film.next(picture); ++f)
    if (f % 12 == 0) pictures.push_back(picture.clone());
  return pictures;
}

Scene make_scene(DrumView drum, const Config& known) {
  Scene scene;
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

// Places as for balls that touch the inside of the front glass, as the camera sees them. `from_afar`: as if it were so
// far away that depth does not show.
std::vector<SeenFrame> places_of(const std::vector<FilmFrame>& film, const FrameClock& clock, const Scene& scene,
                                 bool from_afar) {
  std::vector<SeenFrame> frames(film.size());
  const double readout = std::isnan(scene.drum.readout.value) ? 0.0 : scene.drum.readout.value;
  for (std::size_t f = 0; f < film.size(); ++f) {
    frames[f].time = clock.source[f];
    for (std::size_t k = 0; k < film[f].balls.size(); ++k) {
      const Detection& d = film[f].balls[k];
      Sighting s;
      s.radius = scene.radii[static_cast<std::size_t>(d.size_class)];
      const Eigen::Vector2d place = mill_place_at(scene.drum.camera, {d.u, d.v}, from_afar ? 0.0 : -s.radius);
      s.x = place.x();
      s.y = place.y();
      if (!(std::hypot(s.x, s.y) + s.radius < scene.radius + 0.4 * s.radius)) continue;
      s.deviation = d.deviation / scene.pixels_per_unit;
      s.size_class = d.size_class;
      s.score = d.score;
      s.visible = d.visible;
      s.colour = film[f].colours[k];
      s.mark = film[f].marks[k];
      s.u = d.u;
      s.v = d.v;
      s.time = clock.source[f] + readout * ((d.v + 0.5) / scene.drum.camera.height - 0.5);
      frames[f].balls.push_back(s);
    }
  }
  return frames;
}

// Drawn films show no perspective, whatever is supposed of the camera: seen as through one, the circle in which balls
// lie against the shell is not about the axis.
bool drawn_from_afar(const BallPlane& near, const BallPlane& afar) {
  constexpr double kClear = 6;  // difference of log likelihoods
  return afar.uneven + kClear < near.uneven;
}

void multiply_lengths(std::vector<SeenFrame>& frames, Scene& scene, double factor) {
  for (SeenFrame& f : frames)
    for (Sighting& s : f.balls) {
      s.x *= factor;
      s.y *= factor;
    }
  scene.drum.camera = with_lengths_times(scene.drum.camera, factor);
  scene.pixels_per_unit /= factor;
}

// Lengths by the balls: where mill and balls are both known, they better the camera's scale; where one is missing, the
// balls' touching gives their size in the unit of the other.
void settle_lengths(std::vector<SeenFrame>& frames, Scene& scene, const BallPlane& plane,
                    const std::vector<double>& sizes, std::vector<std::string>& caveats) {
  const bool mill_known = !std::isnan(scene.metres), sizes_known = sizes.size() == scene.radii.size();
  if (mill_known && sizes_known) {
    multiply_lengths(frames, scene, plane.factor.value);
    if (!std::isnan(plane.touching.value) && !std::isnan(plane.reach.value) &&
        std::abs(plane.touching.value / plane.reach.value - 1) > 0.03)
      caveats.push_back(
          fmt::format("the balls' sizes and the mill's diameter do not fit together: by the distance at which balls "
                      "touch, the mill "
                      "would be {:.1f} % {} than mill.diameter; check mill.diameter and charge.balls",
                      100 * std::abs(plane.reach.value / plane.touching.value - 1),
                      plane.reach.value > plane.touching.value ? "larger" : "smaller"));
    return;
  }
  if (!std::isnan(plane.touching.value)) {
    for (double& r : scene.radii) r *= plane.touching.value;
    for (SeenFrame& f : frames)
      for (Sighting& s : f.balls) s.radius *= plane.touching.value;
  }
  if (sizes_known) scene.metres = sizes.front() / scene.radii.front();
}

// Slope of the drum's angle over time, its error allowing for correlation.
Estimate turn_per_frame(const std::vector<double>& time, const std::vector<double>& angle) {
  const double n = static_cast<double>(angle.size());
  if (n < 3) return {};
  double st = 0, stt = 0, sa = 0, sta = 0;
  for (std::size_t i = 0; i < angle.size(); ++i) {
    st += time[i];
    stt += time[i] * time[i];
    sa += angle[i];
    sta += time[i] * angle[i];
  }
  const double slope = (n * sta - st * sa) / (n * stt - st * st);
  std::vector<double> residual;
  for (std::size_t i = 0; i < angle.size(); ++i) residual.push_back(angle[i] - sa / n - slope * (time[i] - st / n));
  return {slope, mean_of_series(residual).se / std::sqrt(std::max(1e-12, stt / n - st * st / (n * n)))};
}

FreeFall fall_of(const std::vector<SeenFrame>& frames, const Scene& scene) {
  FallOptions options;
  options.readout_share = std::isnan(scene.drum.readout.value) ? 0.0 : scene.drum.readout.value;
  FreeFall upright;
  for (const int quarters : {0, 2, 1, 3}) {  // films may be upside down, or lie on their side
    const double c = std::array{1, 0, -1, 0}[static_cast<std::size_t>(quarters)];
    const double si = std::array{0, 1, 0, -1}[static_cast<std::size_t>(quarters)];
    std::vector<TimedPlace> places;
    for (const SeenFrame& f : frames)
      for (const Sighting& s : f.balls)
        if (s.track >= 0)
          places.push_back({s.track, f.time, c * s.x + si * s.y, c * s.y - si * s.x, s.deviation,
                            (s.v + 0.5) / scene.drum.camera.height});
    FreeFall fall = find_free_fall(places, options);
    if (quarters == 0) upright = fall;
    if (!(fall.roll_deg.se < kWorstRoll)) continue;
    fall.roll_deg.value = wrap_180(fall.roll_deg.value + 90 * quarters);
    return fall;
  }
  return upright;
}

// Bins of the ring, upright and counter-clockwise, of which half and more is covered by what stands still.
std::vector<bool> hidden_bins(const std::vector<double>& share, double roll_deg, bool clockwise) {
  std::vector<bool> hidden(360, false);
  if (share.size() != 360) return hidden;
  for (int i = 0; i < 360; ++i) {
    const double upright = i + 0.5, seen = (clockwise ? 180 - upright : upright) + roll_deg;
    hidden[static_cast<std::size_t>(i)] = share[static_cast<std::size_t>(wrap_360(seen))] > 0.5;
  }
  return hidden;
}

FilmFindings findings_of(const Scene& scene, const std::vector<FilmFrame>& film, const std::vector<SeenFrame>& frames,
                         const std::vector<std::size_t>& row_of, double roll, bool clockwise, int lifters) {
  FilmFindings findings;
  findings.camera = scene.drum.camera;
  findings.radius = scene.radius;
  findings.tip_radius = scene.tip_radius;
  findings.roll = roll;
  findings.clockwise = clockwise;
  findings.lifters = lifters;
  findings.lifter_angle = scene.drum.lifter_angle;
  findings.hidden = scene.drum.hidden;
  for (std::size_t f = 0; f < film.size(); ++f) {
    findings.drum.push_back(film[f].drum.angle);
    findings.balls.emplace_back();
    for (const Sighting& s : frames[row_of[f]].balls)
      findings.balls.back().push_back({s.u, s.v, s.radius * scene.pixels_per_unit, is_told(s) ? s.track : -1});
  }
  return findings;
}

}  // namespace

ChargeMotion measure_film(const std::string& path, const FilmOptions& options, const Progress& progress) {
  cv::setNumThreads(1);  // pictures are looked at side by side instead
  const Config none;
  const Config& known = options.mill != nullptr ? *options.mill : none;
  const std::vector<double> sizes = known_radii(known);
  ChargeMotion motion;
  motion.source = MotionSource::kFilm;
  const FilmReader reader(path);

  DrumView drum = calibrate_drum(path, known, [&](double done) { report(progress, kCalibrateShare * done); });
  motion.caveats = drum.caveats;
  if (!drum.found) throw InputError(path, drum.caveats.empty() ? "shows no turning mill" : drum.caveats.front());
  Scene scene = make_scene(std::move(drum), known);

  BallEyes eyes;
  ScaleRange scales;
  if (known.mill.diameter > 0) scales = {0.88 * scene.pixels_per_unit, 1.08 * scene.pixels_per_unit};
  const std::vector<cv::Mat> sample = sample_pictures(path);
  BallLook look = learn_look(eyes.net, sample, scene.bound, sizes, scales);
  if (look.radii.empty())
    throw InputError(path, "shows no balls; balls of at least 3 pixels' radius were expected in the mill");
  learn_rims(eyes, sample, scene.bound, look);
  const std::vector<FilmFrame> film = look_through(path, scene.drum, look, scene.bound, kLeastScore, [&](double done) {
    report(progress, kCalibrateShare + (kPassShare - kCalibrateShare) * done);
  });
  motion.frames = static_cast<int>(film.size());
  if (motion.frames < 0.98 * reader.frame_count() - 2)
    motion.caveats.push_back(fmt::format("the film breaks off: {} of the {} frames that it announces could be read",
                                         motion.frames, reader.frame_count()));

  // Which recorded picture each frame is.
  const double sense_seen = scene.drum.turn_per_frame.value < 0 ? -1.0 : 1.0;
  std::vector<double> differences, angles;
  for (const FilmFrame& f : film) {
    differences.push_back(f.difference);
    angles.push_back(sense_seen * f.drum.angle);
  }
  FrameEvidence evidence;
  evidence.difference = differences;
  evidence.angle = angles;
  const FrameClock clock = find_frame_clock(evidence);
  motion.duplicated_frames = clock.duplicated;
  for (const DroppedFrames& d : clock.dropped) motion.dropped_frames.push_back(d.after);

  motion.rotation = options.rotation;
  const Rotation seen = sense_seen > 0 ? Rotation::kCounterClockwise : Rotation::kClockwise;
  if (motion.rotation == Rotation::kUnknown) motion.rotation = seen;
  if (motion.rotation != seen)
    motion.caveats.push_back(
        "the drum is seen to turn against the rotation that was given: speed is negative, toe and shoulder are not to "
        "be trusted; leave --rotation at auto");
  const bool clockwise = motion.rotation == Rotation::kClockwise;

  // Balls onto the plane in which they touch the glass.
  for (std::size_t c = 0; c < look.radii.size(); ++c)
    scene.radii.push_back(sizes.size() == look.radii.size() && !std::isnan(scene.metres)
                              ? sizes[c] / scene.metres
                              : look.radii[c] / scene.pixels_per_unit);
  const Estimate scale{1.0, scene.drum.scale.se};
  std::vector<SeenFrame> places = places_of(film, clock, scene, false);
  BallPlane plane = measure_ball_plane(places, scene.radius, scale);
  std::vector<SeenFrame> afar = places_of(film, clock, scene, true);
  if (const BallPlane far_plane = measure_ball_plane(afar, scene.radius, scale); drawn_from_afar(plane, far_plane)) {
    places = std::move(afar);
    plane = far_plane;
  }
  settle_lengths(places, scene, plane, sizes, motion.caveats);
  drop_beyond(places, scene.radius);
  drop_impossible(places,
                  std::isnan(known.mill.length) && in_one_layer(places) ? 0.0 : known.mill.length / scene.metres);

  // Repeats are not linked: each takes over what the frame before it shows.
  std::vector<SeenFrame> frames;
  std::vector<std::size_t> row_of;  // by frame of the file: in `frames`
  std::vector<double> times, unique_angles;
  for (std::size_t f = 0; f < places.size(); ++f) {
    if (f == 0 || clock.source[f] != clock.source[f - 1]) {
      frames.push_back(std::move(places[f]));
      if (!std::isnan(film[f].drum.error)) {
        times.push_back(clock.source[f]);
        unique_angles.push_back(film[f].drum.angle);
      }
    }
    row_of.push_back(frames.size() - 1);
  }
  const Estimate turn = turn_per_frame(times, unique_angles);

  MotionModel model;
  model.turn = turn.value;
  link_sightings(frames, model);
  const FreeFall fall = fall_of(frames, scene);
  TimeWitnesses witnesses;
  witnesses.told_rate = options.recorded_fps;
  witnesses.file_rate = reader.frames_per_second();
  if (!std::isnan(scene.metres)) witnesses.falling_rate = frames_per_second(fall, kGravity / scene.metres);
  witnesses.turn_per_frame = {std::abs(turn.value), turn.se};
  if (known.mill.speed > 0 || known.mill.speed_rpm > 0) witnesses.nominal_rpm = speed_rpm(known.mill);
  const TimeBase base = judge_time_base(witnesses);
  motion.caveats.insert(motion.caveats.end(), base.caveats.begin(), base.caveats.end());
  const double fps = base.frames_per_second.value;
  motion.frames_per_second = fps;
  motion.camera.roll_deg = fall.roll_deg;
  double roll_deg = fall.roll_deg.value;
  if (!(fall.roll_deg.se < kWorstRoll)) {
    roll_deg = 0;
    motion.caveats.push_back("too few balls are seen to fall freely to find the camera's roll: taken as upright");
  }
  if (std::abs(roll_deg) > 45)
    motion.caveats.push_back(fmt::format("balls fall {} in this film: it is taken as turned by {:.0f} degrees",
                                         std::abs(roll_deg) > 135 ? "upwards" : "sideways", roll_deg));
  if (!std::isnan(fps) && !std::isnan(scene.metres)) {  // now that gravity is known, link once more
    const double g = kGravity / scene.metres / (fps * fps), roll = radians(roll_deg);
    model.gravity_x = g * std::sin(roll);
    model.gravity_y = -g * std::cos(roll);
    model.patience = std::clamp(0.03 * fps, 2.0, 8.0);
    model.longest_gap = std::clamp(0.12 * fps, 4.0, 30.0);
    link_sightings(frames, model);
  }
  smooth_velocities(frames, std::isnan(fps) ? 3.0 : std::clamp(0.025 * fps, 2.0, 20.0));
  measure_spins(frames, turn.value);
  turn_upright(frames, radians(roll_deg), clockwise);

  const double unit = std::isnan(scene.metres) ? 1.0 : scene.metres, rate = std::isnan(fps) ? 1.0 : fps;
  const cv::Point2d middle = picture_of(scene.drum.camera, {0, 0, 0});
  motion.camera.centre_u_px = middle.x;
  motion.camera.centre_v_px = middle.y;
  motion.camera.radius_px = scene.radius * scene.pixels_per_unit;
  motion.camera.metres_per_pixel = scene.metres / scene.pixels_per_unit;
  motion.camera.width_px = scene.drum.camera.width;
  motion.camera.height_px = scene.drum.camera.height;
  motion.mill_radius = scene.radius * scene.metres;
  motion.tip_radius = scene.tip_radius * scene.metres;
  motion.lifter_count = scene.drum.lifter_count > 0 ? scene.drum.lifter_count : known.mill.lifters.count;
  const double sense = clockwise ? -1.0 : 1.0;
  const double revolutions = std::abs(turn.value) * (clock.source.back() + 1) / (2 * kPi);
  if (revolutions < 1)
    motion.caveats.push_back(fmt::format("the film shows {:.2f} revolutions: too short for averages", revolutions));
  motion.speed_rpm = {rpm_from_rad_s(sense * turn.value * fps), rpm_from_rad_s(turn.se * fps)};
  if (!std::isnan(base.frames_per_second.se))
    motion.speed_rpm.se = std::hypot(motion.speed_rpm.se, motion.speed_rpm.value * base.frames_per_second.se / fps);
  Mill mill = known.mill;
  if (std::isnan(mill.diameter)) mill.diameter = 2 * motion.mill_radius;
  const double critical = critical_speed_rpm(mill);
  motion.speed_fraction = {motion.speed_rpm.value / critical, motion.speed_rpm.se / critical};

  MillGeometry geometry;
  geometry.radius = scene.radius * unit;
  geometry.tip_radius = scene.tip_radius * unit;
  double diameters = 0, count = 0;
  std::vector<double> fillings;
  for (const SeenFrame& f : frames) {
    double area = 0;
    for (const Sighting& s : f.balls) {
      if (!is_told(s)) continue;
      diameters += 2 * s.radius * unit;
      count += 1;
      area += s.radius * s.radius;
    }
    fillings.push_back(area / (kSettledAreaShare * scene.radius * scene.radius));
  }
  if (count == 0)
    throw InputError(path, "shows no balls; balls of at least 3 pixels' radius were expected in the mill");
  motion.filling = mean_of_series(fillings);
  geometry.mean_diameter = diameters / count;
  const int passages = motion.lifter_count > 0 ? motion.lifter_count : kUsualLifters;
  if (turn.value != 0) geometry.passage_frames = 2 * kPi / passages / std::abs(turn.value);
  if (!std::isnan(scene.metres) && !std::isnan(fps)) geometry.gravity = kGravity;

  const std::vector<bool> hidden = hidden_bins(scene.drum.hidden_share, roll_deg, clockwise);
  ChargeStatistics statistics(geometry);
  for (std::size_t f = 0; f < film.size(); ++f) {
    const std::vector<TrackPoint> balls = points_of(frames[row_of[f]], static_cast<int>(f), unit, rate);
    const double lifter = std::isnan(scene.drum.lifter_angle) ? 0.0 : scene.drum.lifter_angle;  // stands at the angle
    const double as_seen = degrees(lifter + film[f].drum.angle) - roll_deg;
    statistics.add(static_cast<int>(f), clock.source[f] / rate, clockwise ? 180 - as_seen : as_seen, balls, hidden);
  }
  statistics.finish(motion);
  if (options.overlay || options.sheet) {
    const FilmFindings findings =
        findings_of(scene, film, frames, row_of, radians(roll_deg), clockwise, motion.lifter_count);
    if (options.sheet) options.sheet(contact_sheet(path, findings, motion));
    if (options.overlay)
      draw_film(path, findings, motion, options.overlay,
                [&](double done) { report(progress, kPassShare + (1 - kPassShare) * done); });
  }
  shrink_to_film(motion, reader.enlarged());
  if (std::isnan(scene.metres)) forget_lengths(motion);
  report(progress, 1.0);
  return motion;
}

}  // namespace tumble::analysis
