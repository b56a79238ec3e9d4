#include "cli/film_beside.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "analysis/film_pictures.h"
#include "cli/options.h"
#include "cli/picture_output.h"
#include "cli/run_player.h"
#include "cli/side_by_side.h"
#include "core/angle.h"
#include "core/error.h"
#include "io/motion_file.h"

namespace tumble::cli {
namespace {

constexpr double kFastest = 60;      // pictures per second, where the film's rate decides
constexpr double kStillRate = 30;    // likewise, of stills
constexpr double kStillSeconds = 2;  // that a still stands
constexpr double kSweep = 8;         // for the wipe's line there and back [s]
constexpr int kCorners = 40;         // of a ball's outline
constexpr double kSameSize = 0.01;   // of two mills' radii

const std::map<std::string, render::BesideView> kViews = {{"side", render::BesideView::kSide},
                                                          {"overlay", render::BesideView::kOverlay},
                                                          {"wipe", render::BesideView::kWipe},
                                                          {"difference", render::BesideView::kDifference}};

struct Filmed {
  ChargeMotion motion;
  fs::path file;
};

// What is known of the film's mill is, where nothing else is told, what the run was made of; not its speed.
Config drawing_of(const RunSetup& setup) {
  Config drawing = setup.config;
  drawing.mill.speed = drawing.mill.speed_rpm = kNotGiven;
  return drawing;
}

Filmed read_film(const fs::path& path, const RunSetup& setup, FilmInput& input, const CommonOptions& options) {
  Filmed film;
  if (io::is_motion_file(path)) {
    film.motion = io::read_motion(path);
    film.file = film.motion.origin;
    std::error_code error;
    if (film.motion.source != MotionSource::kFilm && film.motion.source != MotionSource::kStills)
      throw InputError(path.string(), "was not made of a film; give a film, stills, or the MOTION.h5 of one");
    if (!fs::exists(film.file, error))
      throw InputError(path.string(), "was made of " + film.motion.origin + ", which is not there; give the film");
    return film;
  }
  if (io::is_run_file(path)) throw InputError(path.string(), "is a run; give a film, stills, or the MOTION.h5 of one");
  if (path.extension() == ".csv") throw InputError(path.string(), "holds no pictures; give a film or stills");
  settle(input);
  const Config drawing = drawing_of(setup);
  if (input.told.mill == nullptr) input.told.mill = &drawing;
  film.motion = measure(path, input.told, options);
  film.file = path;
  input.told.mill = nullptr;
  return film;
}

struct Taken {
  int frame = 0;             // of the film
  std::size_t row = 0;       // of its profile
  double clock = kNotGiven;  // [s]
  double run_time = 0;       // after the run's first frame [s]
};

struct FilmTimes {
  std::vector<Taken> all;    // the film's pictures
  std::vector<Taken> shots;  // those that are shown
  double rate = kStillRate;  // pictures per second
  double apart = kNotGiven;  // true time between two [s]
  InStep step;
  bool run_ends_first = false;
};

FilmTimes times_of(const ChargeMotion& film, const ChargeMotion& run, double run_from, double given_rate, double slow) {
  FilmTimes line;
  const auto& rows = film.profile;
  line.step = in_step(film, run);
  if (!std::isnan(run_from)) line.step = InStep{0, run_from, line.step.pace, false, line.step.by_angle};
  // A film without a clock takes the run's: its "seconds" are frames.
  const double second = std::isnan(film.frames_per_second) ? line.step.pace : 1;
  const double film_rate = (std::isnan(film.frames_per_second) ? 1 : film.frames_per_second) / second;
  const double every = std::max(1.0, std::ceil(film_rate / slow / kFastest - 1e-6));
  line.rate = std::isnan(given_rate) ? std::clamp(film_rate / slow / every, 1.0, 1000.0) : given_rate;
  line.apart = 1 / (line.rate * slow);
  const double span_film = rows.back().time - rows.front().time;
  const double span_run = run.profile.back().time - run.profile.front().time;
  if (line.step.b_from > span_run) line.step = InStep{0, 0, line.step.pace, false, line.step.by_angle};
  const double of_film = span_film - line.step.a_from, of_run = (span_run - line.step.b_from) / line.step.pace;
  line.run_ends_first = of_run < of_film - line.apart / second;
  const double until = std::min(of_film, of_run);
  // The run at the very moment at which a picture was taken.
  const auto shot_of = [&](std::size_t row) {
    const double at = std::max(rows[row].time - rows.front().time, line.step.a_from);
    return Taken{rows[row].frame, row, (at - line.step.a_from) * second, std::min(line.step.b_at(at), span_run)};
  };
  for (std::size_t row = 0; row < rows.size(); ++row) line.all.push_back(shot_of(row));
  std::size_t row = 0;
  for (std::size_t k = 0; static_cast<double>(k) * line.apart / second <= until + 1e-9; ++k) {
    const double t = line.step.a_from + static_cast<double>(k) * line.apart / second;
    const auto off = [&](std::size_t i) { return std::abs(rows[i].time - rows.front().time - t); };
    while (row + 1 < rows.size() && off(row + 1) <= off(row)) ++row;
    line.shots.push_back(shot_of(row));
  }
  return line;
}

// Stills tell neither time nor phase: the run goes on while each stands.
FilmTimes times_of_stills(const ChargeMotion& stills, const ChargeMotion& run, double given_rate, double slow,
                          bool as_pictures) {
  FilmTimes line;
  line.rate = std::isnan(given_rate) ? kStillRate : given_rate;
  line.apart = 1 / (line.rate * slow);
  const double span = run.profile.back().time - run.profile.front().time;
  const int each = as_pictures ? 1 : static_cast<int>(std::lround(kStillSeconds * line.rate));
  for (int i = 0, k = 0; i < stills.frames; ++i)
    for (int j = 0; j < each; ++j, ++k)
      line.shots.push_back({i, static_cast<std::size_t>(i), kNotGiven,
                            as_pictures ? span * (i + 0.5) / stills.frames : std::fmod(k * line.apart, span)});
  line.all = line.shots;
  return line;
}

// "−0.2 ± 1.6°"; errors that are nothing at so many digits are left out.
std::string with_error(const Estimate& e, int digits, const char* unit, bool is_difference = false) {
  if (std::isnan(e.value)) return "–";
  const std::string size = fmt::format("{:.{}f}", std::abs(e.value), digits);
  const bool zero = size.find_first_not_of("0.") == std::string::npos;
  const char* sign = zero ? "" : e.value < 0 ? "−" : is_difference ? "+" : "";
  const double least = 0.5 * std::pow(10, -digits);
  const std::string error = e.se >= least ? fmt::format(" ± {:.{}f}", e.se, digits) : "";
  return sign + size + error + unit;
}

render::BesideWords words_of(const Filmed& film, const ChargeMotion& run) {
  render::BesideWords words;
  const auto detail = [](const ChargeMotion& m) {
    std::string text;
    if (!std::isnan(m.speed_rpm.value))
      text = fmt::format("{:.1f} rev/min, {:.0f} % of critical", m.speed_rpm.value, 100 * m.speed_fraction.value);
    const auto edge = [&](const char* name, const Estimate& e) {
      if (!std::isnan(e.value)) text += fmt::format("{}{} {:.0f}°", text.empty() ? "" : " · ", name, e.value);
    };
    edge("toe", m.toe_deg);
    edge("shoulder", m.shoulder_deg);
    return text;
  };
  const auto file_name = [](const fs::path& p) { return (p.has_filename() ? p : p.parent_path()).filename().string(); };
  words.film = {film.motion.source == MotionSource::kStills ? "Photograph" : "Film", file_name(film.file),
                detail(film.motion)};
  words.run = {"Simulation", file_name(run.origin), detail(run)};
  const auto row = [&](const char* name, const Estimate ChargeMotion::*of, int digits, const char* unit, double factor,
                       bool direction) {
    const auto scaled = [factor](const Estimate& e) { return Estimate{factor * e.value, factor * e.se}; };
    const Estimate a = scaled(film.motion.*of), b = scaled(run.*of);
    Estimate d{b.value - a.value, std::hypot(a.se, b.se)};
    if (direction) d.value = wrap_180(d.value);
    words.table.push_back(
        {name, with_error(a, digits, unit), with_error(b, digits, unit), with_error(d, digits, unit, true)});
  };
  row("Speed, rev/min", &ChargeMotion::speed_rpm, 2, "", 1, false);
  row("Toe", &ChargeMotion::toe_deg, 1, "°", 1, true);
  row("Shoulder", &ChargeMotion::shoulder_deg, 1, "°", 1, true);
  row("Filling, %", &ChargeMotion::filling, 1, "", 100, false);
  return words;
}

std::string colour_in_words(render::Colour colour, double top) {
  if (colour == render::Colour::kSpeed) return fmt::format("speed, from 0 (dark) to {:.2g} m/s (bright)", top);
  if (colour == render::Colour::kSpin) return fmt::format("spin, from -{0:.2g} (cool) to {0:.2g} rad/s (warm)", top);
  return "size, from the smallest (dark) to the largest (bright)";
}

std::vector<std::string> notes_of(const ChargeMotion& film, const ChargeMotion& run, const FilmTimes& line,
                                  render::BesideView view, double passages, std::size_t mean_over, bool told) {
  std::vector<std::string> notes;
  if (view == render::BesideView::kDifference)
    notes.push_back(fmt::format(
        "Running mean over {} ({} pictures): the motion is chaotic, single pictures never match ball by ball.",
        film.source == MotionSource::kStills ? "all so far"
        : passages == 1                      ? "one lifter passage"
                                             : fmt::format("{:g} lifter passages", passages),
        mean_over));
  if (film.source == MotionSource::kStills)
    notes.push_back(
        "A photograph tells neither time nor phase: the run is shown at a time of its own; the line is its mean free "
        "surface.");
  else if (line.step.by_lifters && line.step.by_angle)
    notes.push_back("Begun with the lifters in the same place, kept in step by the angle of the mills.");
  else if (line.step.by_lifters)
    notes.push_back(
        fmt::format("Begun with the lifters in the same place; one clock for both, at different speeds ({:.1f} and "
                    "{:.1f} rev/min).",
                    film.speed_rpm.value, run.speed_rpm.value));
  else if (told)
    notes.push_back(fmt::format("The film begins {:.3g} s into the run, as told.", line.step.b_from));
  else
    notes.push_back("One clock for both; the lifters' phase in the film is not known.");
  if (std::isnan(film.frames_per_second) && film.source == MotionSource::kFilm)
    notes.push_back("The film's clock is not known: it runs so that its mill turns as fast as the run's.");
  if (film.rotation == Rotation::kClockwise)
    notes.push_back("The film's mill turns clockwise, so the run is seen from its other end.");
  if (view == render::BesideView::kOverlay)
    notes.push_back("The run as the film's own camera would see it, its balls touching the front glass.");
  else if (film.camera.lens && view != render::BesideView::kDifference)
    notes.push_back("Perspective, distortion and roll are taken out of the film, in the plane of the balls.");
  if (std::abs(run.mill_radius / film.mill_radius - 1) > kSameSize)
    notes.push_back(fmt::format("The mills differ: shell radius {:.4g} m in the film, {:.4g} m in the run.",
                                film.mill_radius, run.mill_radius));
  if (line.run_ends_first) notes.push_back("The run is shorter than the film, which is shown as far as the run goes.");
  notes.insert(notes.end(), film.caveats.begin(), film.caveats.end());
  return notes;
}

// The balls that were found, frame by frame.
class FoundBalls {
 public:
  explicit FoundBalls(const Spool<TrackPoint>& tracks) : at_(tracks.begin()), end_(tracks.end()) {}

  const std::vector<render::FilmedBall>& of(int frame) {  // never falling
    if (frame == frame_) return balls_;
    frame_ = frame;
    balls_.clear();
    for (; !(at_ == end_) && (*at_).frame <= frame; ++at_)
      if ((*at_).frame == frame) balls_.push_back({(*at_).x, (*at_).y, (*at_).radius});
    return balls_;
  }

 private:
  Spool<TrackPoint>::Iterator at_, end_;
  int frame_ = -1;
  std::vector<render::FilmedBall> balls_;
};

render::ChargeEdge edge_at(const ChargeMotion& m, std::size_t row) {
  return row < m.profile.size() ? render::ChargeEdge{m.profile[row].toe_deg, m.profile[row].shoulder_deg}
                                : render::ChargeEdge{};
}

std::vector<Eigen::Vector2d> surface_of(const ChargeMotion& m) {
  std::vector<Eigen::Vector2d> line;
  for (const SurfacePoint& p : m.surface) line.emplace_back(p.x, p.y);
  return line;
}

}  // namespace

BesideResult render_beside(const io::RunReader& run, BesidePlan plan, const fs::path& output,
                           const CommonOptions& options) {
  const bool as_pictures = output_kind(output) == OutputKind::kFolder;
  const render::BesideView kind = parse_name(plan.view, "--as", kViews);
  if (!std::isnan(plan.wipe) && !(plan.wipe >= 0 && plan.wipe <= 1))
    throw InputError("--wipe-at", "must lie between 0 and 1: the share that shows the film");
  if (!(plan.opacity >= 0 && plan.opacity <= 1)) throw InputError("--opacity", "must lie between 0 and 1");
  if (!std::isnan(plan.run_from) && !(plan.run_from >= 0 && plan.run_from < run.time().back() - run.time().front()))
    throw InputError("--run-from",
                     fmt::format("must lie between 0 and the run's {:.3g} s", run.time().back() - run.time().front()));
  if (!(plan.passages > 0)) throw InputError("--passages", "must be above 0; 1 is one lifter passage");
  if (run.frame_count() < 2) throw InputError("run", "holds no motion; simulate for longer");
  const Filmed film = read_film(plan.film, run.setup(), plan.input, options);
  const bool stills = film.motion.source == MotionSource::kStills;
  if (film.motion.profile.empty()) throw InputError(film.file.string(), "gives no frames to show");
  const bool difference = kind == render::BesideView::kDifference;
  if (difference && (film.motion.tracks.empty() || std::isnan(film.motion.mill_radius)))
    throw InputError("--as", "difference needs balls found in the film and its scale; give side, overlay or wipe");
  ChargeMotion truth = measure_run(run, options);
  truth.origin = plan.run.string();

  FilmPlan& picture = plan.picture;
  const double given =
      plan.rate_given ? double(picture.format.fps_numerator) / picture.format.fps_denominator : kNotGiven;
  const FilmTimes line = stills ? times_of_stills(film.motion, truth, given, picture.style.slow, as_pictures)
                                : times_of(film.motion, truth, plan.run_from, given, picture.style.slow);
  parse_rate(std::clamp(std::round(1000 * line.rate) / 1000, 1.0, 1000.0), "--fps", picture.format.fps_numerator,
             picture.format.fps_denominator);

  const int lifters = truth.lifter_count > 0 ? truth.lifter_count : 18;  // as the torque's running mean
  const double passage = 2 * kPi / lifters / std::abs(run.setup().mill_speed) / line.step.pace;  // [s]
  render::BesideStyle style;
  style.width = picture.format.width;
  style.height = picture.format.height;
  style.view = kind;
  style.colour = picture.style.colour;
  style.mirror = film.motion.rotation == Rotation::kClockwise;
  style.slow = picture.style.slow;
  style.opacity = plan.opacity;
  const double rate = static_cast<double>(line.all.size() - 1) / (line.all.back().clock - line.all.front().clock);
  style.mean_over =
      stills ? line.all.size() : static_cast<std::size_t>(std::max(1.0, std::round(plan.passages * passage * rate)));
  const Range scale = scale_of({{&run, nullptr, "", 0}}, style.colour);
  render::BesideWords words = words_of(film, truth);
  words.notes = notes_of(film.motion, truth, line, kind, plan.passages, style.mean_over, !std::isnan(plan.run_from));
  if (style.colour != render::Colour::kSteel)
    words.notes.push_back(fmt::format("The balls' colour is their {}.", colour_in_words(style.colour, scale.high)));
  for (const std::string& note : words.notes) say(options, "note: " + note);
  const double radius = film.motion.mill_radius > 0 ? film.motion.mill_radius : truth.mill_radius;
  render::BesideRenderer renderer(run.setup(), style, words, radius);
  renderer.set_scale(scale.low, scale.high);

  analysis::PictureView view;
  view.camera = film.motion.camera;
  view.clockwise = style.mirror;
  view.margin = renderer.square().margin;
  view.edge_px = renderer.square().edge_px;
  view.straightened = kind != render::BesideView::kOverlay;
  view.depth = mean_of(run.setup().balls.radius) / radius;
  renderer.set_projection({[&view, radius](double x, double y, double behind) {
                             return analysis::place_in_picture(view, x / radius, y / radius, behind / radius);
                           },
                           [&view, radius](double x, double y, double r) {
                             return analysis::ball_in_picture(view, x / radius, y / radius, r / radius, kCorners);
                           }});

  if (stills) renderer.set_surface(surface_of(truth));

  PictureOutput pictures(output, picture.format);
  RunPlayer player(run), at_run(run);
  FoundBalls found(film.motion.tracks);
  std::vector<int> frames;
  for (const Taken& shot : line.shots) frames.push_back(shot.frame);
  ProgressLine progress(options, "rendering", "nothing was written under " + output.string());
  std::size_t index = 0, compared = 0;
  analysis::show_film(
      film.file.string(), view, frames,
      [&](const Image& image) {
        const Taken& shot = line.shots[index];
        const Frame frame = player.at(run.time().front() + shot.run_time);
        render::BesideMoment moment;
        moment.film = &image;
        moment.run = &frame;
        moment.clock = shot.clock;
        if (picture.style.overlay.toe || picture.style.overlay.shoulder) {
          moment.film_edge = edge_at(film.motion, shot.row);
          const auto row = static_cast<std::size_t>(std::lround(shot.run_time * truth.frames_per_second));
          moment.run_edge = stills ? render::ChargeEdge{truth.toe_deg.value, truth.shoulder_deg.value}
                                   : edge_at(truth, std::min(row, truth.profile.size() - 1));
        }
        for (render::ChargeEdge* edge : {&moment.film_edge, &moment.run_edge}) {
          if (!picture.style.overlay.toe) edge->toe_deg = kNotGiven;
          if (!picture.style.overlay.shoulder) edge->shoulder_deg = kNotGiven;
        }
        const double sweep = 2 * kPi * static_cast<double>(index) / line.rate / kSweep;
        moment.wipe = std::isnan(plan.wipe) ? 0.5 + 0.4 * std::sin(sweep) : plan.wipe;
        for (; difference && compared < line.all.size() && line.all[compared].frame <= shot.frame; ++compared) {
          const Taken& taken = line.all[compared];
          renderer.compare(found.of(taken.frame), at_run.at(run.time().front() + taken.run_time));
        }
        pictures.put(index++, renderer.draw(moment));
      },
      progress.callback());
  pictures.finish();
  return {index, line.rate, line.step.b_from, line.step.pace, renderer.only_film(), renderer.only_run()};
}

}  // namespace tumble::cli
