#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core/utility.hpp>

#include "analysis/ball_spin.h"
#include "analysis/ballistics.h"
#include "analysis/charge_motion.h"
#include "analysis/charge_statistics.h"
#include "analysis/drum_speed.h"
#include "analysis/even_turn.h"
#include "analysis/film_findings.h"
#include "analysis/film_paths.h"
#include "analysis/film_reader.h"
#include "analysis/film_scene.h"
#include "analysis/frame_clock.h"
#include "analysis/shared_errors.h"
#include "analysis/time_base.h"
#include "analysis/view.h"
#include "core/angle.h"
#include "core/error.h"

namespace tumble::analysis {
namespace {

constexpr double kLeastScore = 0.2;      // of a ball: looked at at all
constexpr double kCalibrateShare = 0.2;  // of the work, for the progress
constexpr double kPassShare = 0.95;
constexpr double kWorstRoll = 1.5;    // standard error beyond which a camera's roll is not believed [degrees]
constexpr double kUnknownRoll = 2.0;  // of a camera that was levelled by eye, standard [degrees]

constexpr double kFarOff = 0.2;  // of the mill's nominal speed: another one is no measurement of it

const char* const kNoBalls = "shows no balls; balls of at least 3 pixels' radius were expected in the mill";

std::vector<cv::Mat> sample_pictures(const std::string& path) {
  FilmReader film(path);
  std::vector<cv::Mat> pictures;
  cv::Mat picture;
  for (int f = 0; f <= 36 && film.next(picture); ++f)
    if (f % 12 == 0) pictures.push_back(picture.clone());
  return pictures;
}

// Sizes of the balls. Where mill and balls are known, what was taken for the shell may turn out to be another circle:
// balls that are seen to be of quite another size tell.
BallLook look_at_balls(BallNet& net, const std::vector<cv::Mat>& sample, const std::vector<double>& sizes,
                       const Config& known, FilmScene& scene) {
  constexpr double kWidest = 1.7, kClearly = 1.2, kRough = 0.03;
  const double scale = scene.pixels_per_unit;
  ScaleRange scales;
  if (known.mill.diameter > 0) scales = {0.88 * scale, 1.08 * scale};
  BallLook look = learn_look(net, sample, scene.bound, sizes, scales);
  if (!(known.mill.diameter > 0) || sizes.empty()) return look;
  BallLook other = learn_look(net, sample, scene.bound, sizes, {scale / kWidest, scale * kWidest});
  if (other.radii.empty() || !(other.explained > kClearly * look.explained)) return look;
  multiply_lengths(scene, scale * sizes.front() / other.radii.front());
  scene.drum.scale.se = kRough;
  scene.bound.radius *= scene.pixels_per_unit / scale;
  return other;
}

// Which recorded picture each frame of the file is. Repeats are not linked: each takes over what the frame before it
// shows.
struct Timeline {
  FrameClock clock;
  std::vector<std::size_t> shown;   // frames of the file without the repeats
  std::vector<std::size_t> row_of;  // by frame of the file: in `shown`
  Estimate turn;                    // of the drum per recorded frame, as seen [rad]
  bool even = true;                 // it can be the drum's
};

Timeline timeline_of(const FilmPass& pass, const DrumView& drum, double sense_seen) {
  std::vector<double> angles;
  for (const DrumAngle& d : pass.drum) angles.push_back(sense_seen * d.angle);
  Timeline line;
  FrameEvidence evidence;
  evidence.difference = pass.difference;
  evidence.difference_over_two = pass.difference_over_two;
  const Evenness evenness = evenness_of(angles);
  line.even = evenness.even;
  if (line.even) evidence.angle = angles;  // else they are not the drum's, and may not accuse frames
  line.clock = find_frame_clock(evidence);
  std::vector<double> times;
  std::vector<DrumAngle> turned;
  for (std::size_t f = 0; f < pass.frames(); ++f) {
    if (f == 0 || line.clock.source[f] != line.clock.source[f - 1]) {
      line.shown.push_back(f);
      times.push_back(line.clock.source[f]);
      turned.push_back(pass.drum[f]);
    }
    line.row_of.push_back(line.shown.size() - 1);
  }
  line.turn = turn_of_drum(times, turned, drum.reader != nullptr ? drum.reader->alike() : 0.0);
  if (!line.even) line.turn.se = std::hypot(line.turn.se, evenness.scatter);
  if (drum.in_view < kSeenWell) line.turn.se = std::hypot(line.turn.se, kOneSided * line.turn.value);
  return line;
}

// What a first linking, before gravity is known, tells of some chapters of the film.
struct FirstLook {
  std::vector<std::vector<TimedPlace>> ways;  // of believed balls, by chapter
  double mean_radius = kNotGiven;             // number mean of told balls, in the camera's unit
};

FirstLook look_first(const Timeline& line, const PlacesOf& places, const FilmScene& scene) {
  constexpr std::size_t kMostChapters = 3;
  const std::size_t length = chapters_of(line.turn.value).length, frames = line.shown.size();
  const std::size_t chapters = std::clamp<std::size_t>(frames / length, 1, kMostChapters);
  MotionModel model;
  model.turn = line.turn.value;
  FirstLook look;
  double radii = 0, told = 0;
  int tracks_before = 0;
  for (std::size_t c = 0; c < chapters; ++c) {
    const std::size_t from = chapters == 1 ? 0 : c * (frames - length) / (chapters - 1);
    std::vector<SeenFrame> chapter;
    for (std::size_t f = from; f < (chapters == 1 ? frames : from + length); ++f) chapter.push_back(places(f));
    const int tracks = link_sightings(chapter, model);
    look.ways.emplace_back();
    for (const SeenFrame& f : chapter)
      for (const Sighting& s : f.balls) {
        if (s.track < 0) continue;
        look.ways.back().push_back(
            {tracks_before + s.track, f.time, s.x, s.y, s.deviation, (s.v + 0.5) / scene.drum.camera.height});
        if (!is_told(s)) continue;
        radii += s.radius;
        told += 1;
      }
    tracks_before += tracks;
  }
  if (told > 0) look.mean_radius = radii / told;
  return look;
}

FreeFall fall_of(const FirstLook& look, double readout) {
  FallOptions options;
  options.readout_share = std::isnan(readout) ? 0.0 : readout;
  FreeFall upright;
  for (const int quarters : {0, 2, 1, 3}) {  // films may be upside down, or lie on their side
    const double c = std::array{1, 0, -1, 0}[static_cast<std::size_t>(quarters)];
    const double si = std::array{0, 1, 0, -1}[static_cast<std::size_t>(quarters)];
    std::vector<TimedPlace> places;
    for (const auto& chapter : look.ways)
      for (TimedPlace p : chapter) {
        const double x = p.x, y = p.y;
        p.x = c * x + si * y;
        p.y = c * y - si * x;
        places.push_back(p);
      }
    FreeFall fall = find_free_fall(places, options);
    if (quarters == 0) upright = fall;
    if (!(fall.roll_deg.se < kWorstRoll)) continue;
    fall.roll_deg.value = wrap_180(fall.roll_deg.value + 90 * quarters);
    return fall;
  }
  return upright;
}

// Which way is up, and how fast time goes.
struct Bearings {
  TimeBase base;
  double roll_deg = 0;
};

Bearings find_bearings(const FilmScene& scene, const FreeFall& fall, const Timeline& line, double file_rate,
                       const Config& known, double told_rate, ChargeMotion& motion) {
  TimeWitnesses witnesses;
  witnesses.told_rate = told_rate;
  witnesses.scale_error = std::max(0.01, scene.place_error);
  witnesses.file_rate = file_rate;
  if (!std::isnan(scene.metres)) witnesses.falling_rate = frames_per_second(fall, kGravity / scene.metres);
  if (line.even) witnesses.turn_per_frame = {std::abs(line.turn.value), line.turn.se};
  if (known.mill.speed > 0 || known.mill.speed_rpm > 0) witnesses.nominal_rpm = speed_rpm(known.mill);
  Bearings bearings;
  bearings.base = judge_time_base(witnesses);
  motion.caveats.insert(motion.caveats.end(), bearings.base.caveats.begin(), bearings.base.caveats.end());
  motion.frames_per_second = bearings.base.frames_per_second.value;
  motion.frames_per_second_se = bearings.base.frames_per_second.se;
  motion.camera.roll_deg = fall.roll_deg;
  if (!(fall.roll_deg.se < kWorstRoll)) {
    motion.caveats.push_back("too few balls are seen to fall freely to find the camera's roll: taken as upright");
    return bearings;
  }
  bearings.roll_deg = fall.roll_deg.value;
  if (std::abs(bearings.roll_deg) > 45)
    motion.caveats.push_back(fmt::format("balls fall {} in this film: it is taken as turned by {:.0f} degrees",
                                         std::abs(bearings.roll_deg) > 135 ? "upwards" : "sideways",
                                         bearings.roll_deg));
  return bearings;
}

// With gravity, where lengths and clock are known.
MotionModel model_of(const FilmScene& scene, double turn, const Bearings& bearings) {
  MotionModel model;
  model.turn = turn;
  if (scene.from_afar) model.shell = scene.radius;
  const double fps = bearings.base.frames_per_second.value;
  if (std::isnan(fps) || std::isnan(scene.metres)) return model;
  const double g = kGravity / scene.metres / (fps * fps), roll = radians(bearings.roll_deg);
  model.gravity_x = g * std::sin(roll);
  model.gravity_y = -g * std::cos(roll);
  model.patience = std::clamp(0.03 * fps, 2.0, 8.0);
  model.longest_gap = std::clamp(0.12 * fps, 4.0, 30.0);
  return model;
}

void describe_mill(const FilmScene& scene, const Timeline& line, const Bearings& bearings, const Config& known,
                   ChargeMotion& motion) {
  const cv::Point2d middle = picture_of(scene.drum.camera, {0, 0, 0});
  motion.camera.centre_u_px = middle.x;
  motion.camera.centre_v_px = middle.y;
  motion.camera.radius_px = scene.radius * scene.pixels_per_unit;
  motion.camera.metres_per_pixel = scene.metres / scene.pixels_per_unit;
  motion.camera.centre_u_px_se = scene.drum.centre_u.se;
  motion.camera.centre_v_px_se = scene.drum.centre_v.se;
  motion.camera.radius_px_se = motion.camera.radius_px * scene.glass_error;
  motion.camera.metres_per_pixel_se = motion.camera.metres_per_pixel * scene.glass_error;
  motion.camera.k1 = scene.drum.k1;
  const MillCamera& camera = scene.drum.camera;
  motion.camera.lens = rolled(with_lengths_times(scene.from_afar ? from_afar(camera) : camera, 1 / scene.radius),
                              radians(bearings.roll_deg));
  motion.camera.width_px = scene.drum.camera.width;
  motion.camera.height_px = scene.drum.camera.height;
  motion.mill_radius = scene.radius * scene.metres;
  motion.tip_radius = scene.tip_radius * scene.metres;
  motion.shell_by_balls = scene.shell_by_balls;
  motion.lifters_seen = scene.drum.lifters_seen;
  motion.lifter_count = scene.drum.lifter_count > 0 ? scene.drum.lifter_count : known.mill.lifters.count;
  const double revolutions = std::abs(line.turn.value) * (line.clock.source.back() + 1) / (2 * kPi);
  if (revolutions < 1)
    motion.caveats.push_back(fmt::format("the film shows {:.2f} revolutions: too short for averages", revolutions));
  const double sense = motion.rotation == Rotation::kClockwise ? -1.0 : 1.0;
  const Estimate& fps = bearings.base.frames_per_second;
  motion.speed_rpm = {rpm_from_rad_s(sense * line.turn.value * fps.value), rpm_from_rad_s(line.turn.se * fps.value)};
  if (!std::isnan(fps.se))
    motion.speed_rpm.se = std::hypot(motion.speed_rpm.se, motion.speed_rpm.value * fps.se / fps.value);
  if (scene.drum.in_view < kSeenWell)
    motion.caveats.push_back(
        fmt::format("only {:.0f} % of the shell is in the picture: axis, radius and speed are less sure than usual",
                    100 * scene.drum.in_view));
  if (!line.even) {
    motion.caveats.push_back(
        "what is seen to turn does not turn evenly, as a charge that slides: too little is seen of the drum itself to "
        "tell its speed well, or missing frames");
  }
  // Of two witnesses, one of which is known to be poor.
  const double nominal = speed_rpm(known.mill), off = std::abs(motion.speed_rpm.value) - nominal;
  if (nominal > 0 && (!line.even || scene.drum.in_view < kSeenWell)) {
    motion.speed_rpm.se = std::hypot(motion.speed_rpm.se, off);
    if (std::abs(off) > kFarOff * nominal) motion.speed_rpm = {};
  }
  Mill mill = known.mill;
  if (std::isnan(mill.diameter)) mill.diameter = 2 * motion.mill_radius;
  const double critical = critical_speed_rpm(mill);
  motion.speed_fraction = {motion.speed_rpm.value / critical, motion.speed_rpm.se / critical};
}

FilmFindings findings_of(const FilmScene& scene, const FilmPass& pass, double roll, const ChargeMotion& motion) {
  FilmFindings findings;
  findings.camera = scene.drum.camera;
  findings.radius = scene.radius;
  findings.tip_radius = scene.tip_radius;
  findings.roll = roll;
  findings.clockwise = motion.rotation == Rotation::kClockwise;
  findings.lifters = motion.lifter_count;
  findings.lifter_angle = scene.drum.lifter_angle;
  findings.hidden = scene.drum.hidden;
  for (const DrumAngle& d : pass.drum) findings.drum.push_back(d.angle);
  return findings;
}

// Share of the mill's cross-section that lies beyond the picture's edges.
double share_beyond_picture(const FilmScene& scene) {
  constexpr int kRings = 20, kDirections = 72;
  int beyond = 0;
  for (int i = 0; i < kRings; ++i)
    for (int k = 0; k < kDirections; ++k) {
      const double r = scene.radius * std::sqrt((i + 0.5) / kRings), a = 2 * kPi * k / kDirections;
      const cv::Point2d p = picture_of(scene.drum.camera, {r * std::cos(a), r * std::sin(a), 0});
      beyond += p.x < 0 || p.y < 0 || p.x > scene.drum.camera.width - 1 || p.y > scene.drum.camera.height - 1;
    }
  return static_cast<double>(beyond) / (kRings * kDirections);
}

// Links the film's balls and gathers all that is told of them. `findings` gets every frame's balls.
void gather(const FilmScene& scene, const FilmPass& pass, const Timeline& line, const PlacesOf& places,
            const Bearings& bearings, double mean_radius, ChargeMotion& motion, FilmFindings& findings) {
  const double fps = bearings.base.frames_per_second.value, rate = std::isnan(fps) ? 1.0 : fps;
  const double unit = std::isnan(scene.metres) ? 1.0 : scene.metres;
  const bool clockwise = findings.clockwise;
  MillGeometry geometry;
  geometry.radius = scene.radius * unit;
  geometry.tip_radius = scene.tip_radius * unit;
  geometry.mean_diameter = 2 * mean_radius * unit;
  const int passages = motion.lifter_count > 0 ? motion.lifter_count : kUsualLifters;
  if (line.turn.value != 0) geometry.passage_frames = 2 * kPi / passages / std::abs(line.turn.value);
  if (!std::isnan(scene.metres) && !std::isnan(fps)) geometry.gravity = kGravity;

  const std::vector<bool> hidden =
      hidden_bins(scene.drum.hidden_share, bearings.roll_deg, clockwise, mean_radius / scene.tip_radius);
  const double lifter = std::isnan(scene.drum.lifter_angle) ? 0.0 : scene.drum.lifter_angle;
  ChargeStatistics statistics(geometry);
  std::vector<double> fillings;
  double seen_area = 0, bridged_area = 0;
  FrameSpool<TrackPoint> unseen;
  const auto finish = [&](std::vector<SeenFrame>& chapter) {
    smooth_velocities(chapter, std::isnan(fps) ? 3.0 : std::clamp(0.025 * fps, 2.0, 20.0));
    measure_spins(chapter, line.turn.value);
    turn_upright(chapter, radians(bearings.roll_deg), clockwise);
  };
  const auto use = [&](std::size_t row, const SeenFrame& seen, const SeenFrame& bridged) {
    double area = 0, between = 0;
    std::vector<FoundBall> found;
    for (const Sighting& s : seen.balls) {
      if (is_told(s)) area += s.radius * s.radius;
      found.push_back({s.u, s.v, s.radius * scene.pixels_per_unit, is_told(s) ? s.track : -1});
    }
    for (const Sighting& s : bridged.balls) between += s.radius * s.radius;
    seen_area += area;
    bridged_area += between;
    fillings.push_back((area + between) / (kSettledAreaShare * scene.radius * scene.radius));
    const std::size_t end = row + 1 < line.shown.size() ? line.shown[row + 1] : pass.frames();
    for (std::size_t f = line.shown[row]; f < end; ++f) {
      const int frame = static_cast<int>(f);
      const double as_seen = degrees(lifter + pass.drum[f].angle) - bearings.roll_deg;
      statistics.add(frame, line.clock.source[f] / rate, clockwise ? 180 - as_seen : as_seen,
                     points_of(seen, frame, unit, rate), hidden);
      unseen.append(points_of(bridged, frame, unit, rate));
      findings.balls.append(found);
    }
  };
  link_in_chapters(line.shown.size(), places, chapters_of(line.turn.value), model_of(scene, line.turn.value, bearings),
                   finish, use);
  motion.filling = mean_of_series(fillings);
  // Balls that no path bridges are missed about as often as those that one does.
  motion.filling.se = std::hypot(motion.filling.se, motion.filling.value * bridged_area / seen_area);
  statistics.finish(motion);
  if (!scene.one_layer) {
    const double length = std::isnan(scene.layer_length) ? scene.radius : scene.layer_length;  // mills are that long
    motion.filling = filling_of_deep_mill(motion.field, geometry.radius, std::max(1.0, length / (2 * mean_radius)));
  }
  // What the picture does not show of the mill may be empty or full.
  if (const double unseen_share = share_beyond_picture(scene); unseen_share > 0) {
    motion.filling.value += 0.5 * unseen_share;
    motion.filling.se = std::hypot(motion.filling.se, unseen_share / std::sqrt(12.0));
  }
  const double roll_se = motion.camera.roll_deg.se;
  add_shared_errors(motion, geometry, hidden, unseen,
                    {scene.drum.place_error / std::sqrt(2.0) * unit, scene.place_error,
                     radians(roll_se < kWorstRoll ? roll_se : kUnknownRoll)});
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
  FilmScene scene = make_scene(std::move(drum), known);

  BallEyes eyes;
  const std::vector<cv::Mat> sample = sample_pictures(path);
  BallLook look = look_at_balls(eyes.net, sample, sizes, known, scene);
  if (look.radii.empty()) throw InputError(path, kNoBalls);
  learn_rims(eyes, sample, scene.bound, look);
  const std::vector<int> shown = sheet_frames(options.sheet ? reader.frame_count() : 0);
  const FilmPass pass = look_through(path, scene.drum, look, scene.bound, kLeastScore, shown, [&](double done) {
    report(progress, kCalibrateShare + (kPassShare - kCalibrateShare) * done);
  });
  motion.frames = static_cast<int>(pass.frames());
  if (motion.frames < 0.98 * reader.frame_count() - 2)
    motion.caveats.push_back(fmt::format("the film breaks off: {} of the {} frames that it announces could be read",
                                         motion.frames, reader.frame_count()));

  const double sense_seen = scene.drum.turn_per_frame.value < 0 ? -1.0 : 1.0;
  const Timeline line = timeline_of(pass, scene.drum, sense_seen);
  motion.duplicated_frames = line.clock.duplicated;
  for (const DroppedFrames& d : line.clock.dropped) motion.dropped_frames.push_back(d.after);
  const Rotation seen = sense_seen > 0 ? Rotation::kCounterClockwise : Rotation::kClockwise;
  motion.rotation = options.rotation == Rotation::kUnknown ? seen : options.rotation;
  if (motion.rotation != seen)
    motion.caveats.push_back(
        "the drum is seen to turn against the rotation that was given: speed is negative, toe and shoulder are not to "
        "be trusted; leave --rotation at auto");

  settle_lengths(scene, pass, look.radii, sizes, known.mill.length, motion.caveats);
  const PlacesOf places = [&](std::size_t row) {
    const std::size_t f = line.shown[row];
    return places_of(pass.balls[f], line.clock.source[f], scene);
  };
  const FirstLook first = look_first(line, places, scene);
  if (std::isnan(first.mean_radius)) throw InputError(path, kNoBalls);
  FreeFall fall = fall_of(first, scene.drum.readout.value);
  // Seen from the side, a tilt that is wrong along one axis leans the other.
  fall.roll_deg.se = std::hypot(fall.roll_deg.se, degrees(scene.drum.obliqueness.value * scene.drum.obliqueness.se));
  const Bearings bearings =
      find_bearings(scene, fall, line, reader.frames_per_second(), known, options.recorded_fps, motion);
  describe_mill(scene, line, bearings, known, motion);
  FilmFindings findings = findings_of(scene, pass, radians(bearings.roll_deg), motion);
  gather(scene, pass, line, places, bearings, first.mean_radius, motion, findings);

  if (options.sheet) options.sheet(contact_sheet(path, shown, pass.kept, findings, motion));
  if (options.overlay)
    draw_film(path, findings, motion, options.overlay,
              [&](double done) { report(progress, kPassShare + (1 - kPassShare) * done); });
  shrink_to_film(motion, reader.enlarged());
  if (std::isnan(scene.metres)) forget_lengths(motion);
  report(progress, 1.0);
  return motion;
}

}  // namespace tumble::analysis
