#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "analysis/ballistics.h"
#include "analysis/carried_balls.h"
#include "analysis/charge_motion.h"
#include "analysis/charge_statistics.h"
#include "analysis/time_base.h"
#include "analysis/tracking.h"
#include "analysis/view.h"
#include "core/angle.h"
#include "core/error.h"
#include "core/mill_shape.h"
#include "core/quantile.h"

namespace tumble::analysis {
namespace {

constexpr double kKnownRoll_deg = 1;   // error of a camera's roll that is good enough to take it out
constexpr double kPoorCentre = 0.015;  // relative, of the axis by the balls that turn about it
constexpr double kShellError = 0.015;  // relative, of the shell's radius by the outermost balls: the scale's
constexpr double kSizeError = 0.05;    // relative, of the size that balls seem to have

// A track has one ball: its radius is the median of what was seen.
std::map<int, double> radius_of_track(const PixelTracks& tracks) {
  std::map<int, std::vector<double>> seen;
  for (const PixelSighting& s : tracks.sightings) seen[s.track].push_back(s.radius);
  std::map<int, double> radius;
  for (auto& [track, radii] : seen) radius[track] = median_of(std::move(radii));
  return radius;
}

struct Scale {
  double metres_per_pixel = kNotGiven, error = kNotGiven;  // error relative
};

Scale find_scale(const Config& known, const TracksOptions& options, const Shell& shell,
                 const std::map<int, double>& radii) {
  if (!std::isnan(options.metres_per_pixel)) return {options.metres_per_pixel, 0.005};
  if (known.mill.diameter > 0) return {0.5 * known.mill.diameter / shell.radius, kShellError};
  double true_mean = 0, shares = 0, seen = 0;
  for (const BallClass& b : known.charge.balls) true_mean += b.share * b.radius, shares += b.share;
  for (const auto& [track, radius] : radii) seen += radius / static_cast<double>(radii.size());
  if (!(true_mean > 0)) return {};
  return {true_mean / shares / seen, kSizeError};
}

}  // namespace

ChargeMotion measure_tracks(const PixelTracks& tracks, const TracksOptions& options) {
  const Config none;
  const Config& known = options.mill != nullptr ? *options.mill : none;
  ChargeMotion motion;
  motion.source = MotionSource::kTracks;
  for (const PixelSighting& s : tracks.sightings) motion.frames = std::max(motion.frames, s.frame + 1);
  const std::map<int, double> radii = radius_of_track(tracks);
  std::vector<PixelSighting> sightings = tracks.sightings;
  for (PixelSighting& s : sightings) s.radius = radii.at(s.track);

  std::optional<PixelPoint> given;
  if (!std::isnan(options.centre_u_px)) given = PixelPoint{options.centre_u_px, options.centre_v_px};
  Turning turning = find_turning(sightings, given);
  if (!turning.found && !given)
    throw InputError(tracks.name,
                     "the mill's axis cannot be told: no three stretches of tracks turn about one centre; give "
                     "--centre-px u,v");
  const PixelPoint turns_about = given ? *given : turning.centre;
  Shell shell = find_shell(sightings, turns_about, 0.0);
  if (!given && turning.centre_se > kPoorCentre * shell.radius) {
    // Few balls are carried, and they creep: where the outermost ones stop says more.
    shell = find_shell(sightings, turns_about, turning.centre_se);
    turning = find_turning(sightings, shell.centre);
  }
  const Scale scale = find_scale(known, options, shell, radii);
  const bool has_scale = !std::isnan(scale.metres_per_pixel);
  const double unit = has_scale ? scale.metres_per_pixel : 1.0;
  if (!has_scale)
    motion.caveats.push_back(
        "lengths and the frame rate are not known: give --mill with the mill's diameter or the balls' radii, or "
        "--metres-per-pixel");
  else if (scale.error == kSizeError)
    motion.caveats.push_back("the scale is from the balls' apparent sizes alone: give the mill's diameter");
  if (!given)
    motion.caveats.push_back(
        fmt::format("the mill's axis is taken at {:.1f}, {:.1f} px, about which carried balls turn "
                    "and within which they stay; --centre-px would be surer",
                    shell.centre.u, shell.centre.v));

  // The clock and the upright.
  std::vector<TimedPlace> places;
  for (const PixelSighting& s : sightings) {
    TimedPlace p;
    p.track = s.track;
    p.frame = s.frame;
    p.x = (s.u - shell.centre.u) * unit;
    p.y = (shell.centre.v - s.v) * unit;
    places.push_back(p);
  }
  const FreeFall fall = find_free_fall(places);
  TimeWitnesses witnesses;
  witnesses.told_rate = options.recorded_fps;
  if (has_scale) {
    witnesses.falling_rate = frames_per_second(fall, kGravity);
    witnesses.scale_error = scale.error;
  }
  if (turning.found) witnesses.turn_per_frame = {std::abs(turning.turn_per_frame.value), turning.turn_per_frame.se};
  const double critical = known.mill.diameter > 0 ? critical_speed_rpm(known.mill) : kNotGiven;
  witnesses.nominal_rpm = speed_rpm(known.mill);
  const TimeBase base = judge_time_base(witnesses);
  motion.caveats.insert(motion.caveats.end(), base.caveats.begin(), base.caveats.end());
  motion.frames_per_second = base.frames_per_second.value;
  const double fps = motion.frames_per_second, rate = std::isnan(fps) ? 1.0 : fps;
  const bool roll_known = fall.roll_deg.se < kKnownRoll_deg;
  if (roll_known) motion.camera.roll_deg = fall.roll_deg;
  const double roll = roll_known ? radians(fall.roll_deg.value) : 0.0;

  motion.rotation = options.rotation;
  const Rotation seen = !turning.found                     ? Rotation::kUnknown
                        : turning.turn_per_frame.value > 0 ? Rotation::kCounterClockwise
                                                           : Rotation::kClockwise;
  if (motion.rotation == Rotation::kUnknown) motion.rotation = seen;
  if (motion.rotation == Rotation::kUnknown)
    motion.caveats.push_back("direction of rotation unknown, taken as counter-clockwise; give --rotation");
  const bool clockwise = motion.rotation == Rotation::kClockwise;
  const double sense = clockwise ? -1.0 : 1.0;

  motion.camera.centre_u_px = shell.centre.u;
  motion.camera.centre_v_px = shell.centre.v;
  motion.camera.radius_px = known.mill.diameter > 0 ? 0.5 * known.mill.diameter / unit : shell.radius;
  motion.camera.metres_per_pixel = scale.metres_per_pixel;
  motion.lifter_count = known.mill.lifters.count;
  motion.mill_radius = motion.camera.radius_px * scale.metres_per_pixel;
  double tip_share = 1;
  if (known.mill.diameter > 0) {
    const MillShape shape = make_mill_shape(known);
    tip_share = shape.tip_radius / shape.radius;
  }
  motion.tip_radius = tip_share * motion.mill_radius;
  if (turning.found) {
    const double turn = sense * turning.turn_per_frame.value;
    const double clock_error = std::isnan(base.frames_per_second.se) ? 0.0 : base.frames_per_second.se / rate;
    motion.speed_rpm.value = rpm_from_rad_s(turn * fps);
    motion.speed_rpm.se = motion.speed_rpm.value * std::hypot(clock_error, turning.turn_per_frame.se / turn);
    motion.speed_fraction = {motion.speed_rpm.value / critical, motion.speed_rpm.se / critical};
    const double revolutions = std::abs(turn) * motion.frames / (2 * kPi);
    if (revolutions < 1)
      motion.caveats.push_back(fmt::format("the tracks show {:.2f} revolutions: too short for averages", revolutions));
  }
  motion.caveats.push_back("filling, toe, shoulder and occupancy are those of the balls that the tracks hold");

  std::vector<SeenFrame> frames(static_cast<std::size_t>(motion.frames));
  for (const PixelSighting& s : sightings) {
    Sighting ball;
    ball.x = s.u - shell.centre.u;
    ball.y = shell.centre.v - s.v;
    ball.radius = s.radius;
    ball.score = 1;
    ball.u = s.u;
    ball.v = s.v;
    ball.track = s.track;
    ball.time = s.frame;
    frames[static_cast<std::size_t>(s.frame)].balls.push_back(ball);
  }
  turn_upright(frames, roll, clockwise);
  smooth_velocities(frames, std::isnan(fps) ? 4.0 : std::clamp(0.025 * fps, 2.0, 20.0));

  MillGeometry geometry;
  geometry.radius = motion.camera.radius_px * unit;
  geometry.tip_radius = tip_share * geometry.radius;
  for (const PixelSighting& s : sightings)
    geometry.mean_diameter += 2 * s.radius * unit / static_cast<double>(sightings.size());
  const int passages = motion.lifter_count > 0 ? motion.lifter_count : kUsualLifters;
  if (turning.found) geometry.passage_frames = 2 * kPi / passages / std::abs(turning.turn_per_frame.value);
  if (has_scale && !std::isnan(fps)) geometry.gravity = kGravity;
  ChargeStatistics statistics(geometry);
  std::vector<double> fillings;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    double area = 0;
    for (const Sighting& s : frames[f].balls) area += s.radius * s.radius;
    fillings.push_back(area / (kSettledAreaShare * motion.camera.radius_px * motion.camera.radius_px));
    statistics.add(static_cast<int>(f), static_cast<double>(f) / rate, kNotGiven,
                   points_of(frames[f], static_cast<int>(f), unit, rate));
  }
  motion.filling = mean_of_series(fillings);
  statistics.finish(motion);
  if (!has_scale) forget_lengths(motion);
  return motion;
}

}  // namespace tumble::analysis
