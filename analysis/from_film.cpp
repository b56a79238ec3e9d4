#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/core/utility.hpp>

#include "analysis/charge_motion.h"
#include "analysis/charge_statistics.h"
#include "analysis/film_survey.h"
#include "analysis/lifters.h"
#include "analysis/mill_scale.h"
#include "analysis/tracking.h"
#include "analysis/view.h"
#include "core/angle.h"
#include "core/error.h"
#include "core/statistics.h"

namespace tumble::analysis {
namespace {

constexpr double kSurveyShare = 0.15, kDetectShare = 0.8;  // of the work, for the progress

struct Pass {                                 // what the pass over the whole film leaves
  std::vector<std::vector<Detection>> balls;  // by frame
  std::vector<double> angle;                  // of the drum, unwrapped, counter-clockwise as seen [rad]
  cv::Size size;
};

Pass detect_all(const std::string& path, const FilmSurvey& survey, const BallLook& look, const DrumPattern& drum,
                const Progress& progress) {
  Pass pass;
  FilmReader film(path);
  pass.size = film.size();
  const DrumUnroller unroll(survey.centre, strip_inner(survey.centre), strip_outer(survey.centre), film.size());
  const int count = std::max(film.frame_count(), survey.frames);
  cv::Mat picture;
  double angle = 0, step = drum.step;
  while (film.next(picture)) {
    pass.balls.push_back(detect_balls(picture, look, survey.centre));
    if (drum.found) {
      const double expected = pass.angle.empty() ? 0.0 : angle + step;
      angle = drum_angle(drum, unroll(picture), expected);
      pass.angle.push_back(angle);
    }
    report(progress, kSurveyShare + kDetectShare * std::min(1.0, static_cast<double>(pass.balls.size()) / count));
  }
  return pass;
}

Estimate turn_per_frame(const std::vector<double>& angle) {
  const double n = static_cast<double>(angle.size());
  if (n < 3) return {};
  double st = 0, stt = 0, sa = 0, sta = 0;
  for (std::size_t i = 0; i < angle.size(); ++i) {
    const double t = static_cast<double>(i);
    st += t;
    stt += t * t;
    sa += angle[i];
    sta += t * angle[i];
  }
  const double slope = (n * sta - st * sa) / (n * stt - st * st);
  std::vector<double> residual;
  for (std::size_t i = 0; i < angle.size(); ++i)
    residual.push_back(angle[i] - sa / n - slope * (static_cast<double>(i) - st / n));
  // Error of a slope whose residuals are correlated: that of the mean, times the lever of a straight line.
  const double se = mean_of_series(residual).se;
  return {slope, se * std::sqrt(12.0) / n};
}

// Annuli of the strips between lifter tips and shell.
cv::Range lifter_rows(const FilmSurvey& survey, const MillView& view) {
  const double inner = strip_inner(survey.centre), outer = strip_outer(survey.centre);
  const auto row = [&](double r) { return (r - inner) / (outer - inner) * DrumStrip::kAnnuli; };
  const int from = std::max(0, static_cast<int>(std::ceil(row(view.tip_radius) - 0.2)));
  const int to = std::min(DrumStrip::kAnnuli, static_cast<int>(std::floor(row(view.mill.radius) + 0.2)));
  return from < to ? cv::Range(from, to) : cv::Range(0, 0);
}

std::vector<std::vector<Sighting>> sightings_of(const Pass& pass, const MillView& view, bool clockwise) {
  std::vector<std::vector<Sighting>> frames(pass.balls.size());
  for (std::size_t f = 0; f < pass.balls.size(); ++f)
    for (const Detection& d : pass.balls[f]) {
      Sighting s;
      s.radius = view.radii[static_cast<std::size_t>(d.size_class)];
      const cv::Point2d place = about_axis(d, view);
      s.x = (clockwise ? -1.0 : 1.0) * place.x;
      s.y = place.y;
      s.size_class = d.size_class;
      s.score = d.score;
      if (std::hypot(s.x, s.y) + s.radius > view.mill.radius + 0.3 * s.radius) continue;
      frames[f].push_back(s);
    }
  return frames;
}

}  // namespace

ChargeMotion measure_film(const std::string& path, const FilmOptions& options, const Progress& progress) {
  cv::setNumThreads(1);  // same bytes for any number of threads; the caller runs films side by side
  const FilmSurvey survey = survey_film(path, [&](double done) { report(progress, kSurveyShare * done); });
  const Config none;
  const Config& known = options.mill != nullptr ? *options.mill : none;

  ChargeMotion motion;
  motion.source = MotionSource::kFilm;
  FilmReader reader(path);
  motion.frames_per_second = std::isnan(options.recorded_fps) ? reader.frames_per_second() : options.recorded_fps;
  const double fps = motion.frames_per_second;

  ScaleRange scales;  // the shell lies among the circles about the axis; rims look up to 15 % smaller or larger
  if (known.mill.diameter > 0) {
    scales.least = 0.85 * strip_inner(survey.centre) / (0.5 * known.mill.diameter);
    scales.most = 1.15 * strip_outer(survey.centre) / (0.5 * known.mill.diameter);
  }
  const BallLook look = learn_look(survey.samples, survey.centre, known_radii(known), scales);
  const DrumPattern drum = learn_drum(survey.strips, known.mill.lifters.count, kNotGiven);
  Pass pass = detect_all(path, survey, look, drum, progress);
  motion.frames = static_cast<int>(pass.balls.size());
  if (motion.frames < 0.98 * reader.frame_count() - 2)
    motion.caveats.push_back(fmt::format("the film breaks off: {} of the {} frames that it announces could be read",
                                         motion.frames, reader.frame_count()));

  motion.rotation = options.rotation;
  const Rotation seen = drum.step > 0 ? Rotation::kCounterClockwise : Rotation::kClockwise;
  if (motion.rotation == Rotation::kUnknown && drum.found) motion.rotation = seen;
  if (drum.found && motion.rotation != seen)
    motion.caveats.push_back(
        "the drum is seen to turn against the rotation that was given: speed is negative, toe and shoulder are not to "
        "be "
        "trusted; leave --rotation at auto");
  const bool clockwise = motion.rotation == Rotation::kClockwise;
  if (!drum.found) motion.caveats.push_back("nothing that turns with the drum was made out: speed unknown");
  if (motion.rotation == Rotation::kUnknown)
    motion.caveats.push_back("direction of rotation unknown, taken as counter-clockwise; give --rotation");

  // Lifters taken for balls would lie against the shell: they are found with a first view, which needs to be good to a
  // few percent only, and taken out before the second.
  std::vector<std::string> first_caveats;
  MillView view = find_view(pass.balls, look, survey, drum, known, first_caveats);
  const double guess = lifter_phase(drum, survey.strips, lifter_rows(survey, view));
  const LifterLattice lifters = find_lifters(pass.balls, pass.angle, view, drum.lifter_count, guess);
  for (std::size_t f = 0; f < pass.angle.size(); ++f)
    std::erase_if(pass.balls[f], [&](const Detection& d) { return within_lifter(d, view, lifters, pass.angle[f]); });
  view = find_view(pass.balls, look, survey, drum, known, motion.caveats);
  motion.camera.centre_u_px = view.mill.u;
  motion.camera.centre_v_px = view.mill.v;
  motion.camera.radius_px = view.mill.radius;
  motion.camera.metres_per_pixel = view.metres_per_pixel;
  motion.camera.width_px = pass.size.width;
  motion.camera.height_px = pass.size.height;
  motion.lifter_count = drum.found ? drum.lifter_count : known.mill.lifters.count;
  const double unit = std::isnan(view.metres_per_pixel) ? 1.0 : view.metres_per_pixel;
  motion.mill_radius = view.mill.radius * view.metres_per_pixel;
  motion.tip_radius = view.tip_radius * view.metres_per_pixel;

  const Estimate turn = drum.found ? turn_per_frame(pass.angle) : Estimate{};
  const double sense = clockwise ? -1.0 : 1.0;
  const double revolutions = std::abs(turn.value) * motion.frames / (2 * kPi);
  if (revolutions < 1)
    motion.caveats.push_back(fmt::format("the film shows {:.2f} revolutions: too short for averages", revolutions));
  motion.speed_rpm = {rpm_from_rad_s(sense * turn.value * fps), rpm_from_rad_s(turn.se * fps)};
  Mill mill = known.mill;
  if (std::isnan(mill.diameter)) mill.diameter = 2 * motion.mill_radius;
  const double critical = critical_speed_rpm(mill);
  motion.speed_fraction = {motion.speed_rpm.value / critical, motion.speed_rpm.se / critical};

  auto frames = sightings_of(pass, view, clockwise);
  MotionModel model;
  model.turn = drum.found ? sense * turn.value : 0.0;
  model.tip_radius = view.tip_radius;
  if (!std::isnan(view.metres_per_pixel) && !std::isnan(fps))
    model.gravity = kGravity / view.metres_per_pixel / (fps * fps);
  model.birth_score = look.birth_score;
  model.patience = std::isnan(fps) ? 3 : std::max(2, static_cast<int>(std::lround(0.03 * fps)));
  link_sightings(frames, model);
  const int window = std::isnan(fps) ? 3 : std::clamp(2 * static_cast<int>(std::lround(0.0125 * fps)) + 1, 3, 21);
  smooth_velocities(frames, window);

  MillGeometry geometry;
  geometry.radius = view.mill.radius * unit;
  geometry.tip_radius = view.tip_radius * unit;
  double diameters = 0, area = 0, count = 0;
  std::vector<double> fillings;
  for (const auto& f : frames) {
    area = 0;
    for (const Sighting& s : f) {
      if (s.track < 0) continue;
      diameters += 2 * s.radius * unit;
      count += 1;
      area += s.radius * s.radius;
    }
    fillings.push_back(area / (kSettledAreaShare * view.mill.radius * view.mill.radius));
  }
  if (count == 0)
    throw InputError(path, "shows no balls; balls of at least 3 pixels' radius were expected in the mill");
  motion.filling = mean_of_series(fillings);
  geometry.mean_diameter = diameters / count;
  const int passages = motion.lifter_count > 0 ? motion.lifter_count : kUsualLifters;
  if (model.turn > 0) geometry.passage_frames = 2 * kPi / passages / model.turn;
  if (!std::isnan(view.metres_per_pixel) && !std::isnan(fps)) geometry.gravity = kGravity;

  ChargeStatistics statistics(geometry);
  const double rate = std::isnan(fps) ? 1.0 : fps;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    std::vector<TrackPoint> balls;
    for (const Sighting& s : frames[f]) {
      if (s.track < 0) continue;
      TrackPoint p;
      p.frame = static_cast<int>(f);
      p.id = s.track;
      p.time = static_cast<double>(f) / rate;
      p.x = s.x * unit;
      p.y = s.y * unit;
      p.vx = s.vx * unit * rate;
      p.vy = s.vy * unit * rate;
      p.radius = s.radius * unit;
      p.u_px = view.mill.u + (clockwise ? -s.x : s.x);
      p.v_px = view.mill.v - s.y;
      balls.push_back(p);
    }
    std::sort(balls.begin(), balls.end(), [](const TrackPoint& a, const TrackPoint& b) { return a.id < b.id; });
    const double at_start = std::isnan(lifters.angle) ? 0.0
                            : clockwise               ? kPi - lifters.angle
                                                      : lifters.angle;  // a lifter stands at the mill angle
    const double angle = drum.found ? degrees(at_start + sense * pass.angle[f]) : kNotGiven;
    statistics.add(static_cast<int>(f), static_cast<double>(f) / rate, angle, balls);
  }
  statistics.finish(motion);
  shrink_to_film(motion, reader.enlarged());
  if (std::isnan(view.metres_per_pixel)) forget_lengths(motion);
  report(progress, 1.0);
  return motion;
}

}  // namespace tumble::analysis
