#include "cli/measurements.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "cli/steps.h"
#include "core/angle.h"
#include "core/error.h"
#include "core/fingerprint.h"
#include "core/motion_quantities.h"
#include "core/quantile.h"
#include "core/version.h"
#include "diagnose/data_checks.h"
#include "diagnose/seen_motion.h"
#include "io/config_file.h"
#include "io/config_keys.h"
#include "io/experiments_file.h"
#include "io/motion_file.h"
#include "io/torque_series_file.h"
#include "io/tracks_file.h"

namespace tumble::cli {
namespace {

using diagnose::Measurement;
using diagnose::SeenFrame;

constexpr double kLeastUncertainty = 1e-6;  // of a key's value

// The mill's angle goes on where a file begins again at 0.
void unwrap(std::vector<SeenFrame>& frames) {
  double before = kNotGiven;
  for (SeenFrame& f : frames) {
    if (std::isnan(f.mill_angle)) continue;
    if (!std::isnan(before)) f.mill_angle = before + radians(wrap_180(degrees(f.mill_angle - before)));
    before = f.mill_angle;
  }
}

// A ball has one radius: the median of what was seen of it; else what MILL.toml has where all balls are alike.
void give_radii(std::vector<SeenFrame>& frames, const Config& config, const std::string& name,
                std::vector<std::string>& notes) {
  std::map<int, std::vector<double>> seen;
  for (const SeenFrame& f : frames)
    for (const diagnose::Sighting& s : f.balls)
      if (!std::isnan(s.radius)) seen[s.ball].push_back(s.radius);
  std::map<int, double> radius;
  for (auto& [ball, radii] : seen) radius[ball] = median_of(std::move(radii));
  const double all = config.charge.balls.size() == 1 ? config.charge.balls.front().radius : kNotGiven;
  bool lost = false;
  for (SeenFrame& f : frames)
    for (diagnose::Sighting& s : f.balls) {
      const auto told = radius.find(s.ball);
      s.radius = told != radius.end() ? told->second : all;
      lost = lost || std::isnan(s.radius);
    }
  if (lost)
    notes.push_back(
        name +
        ": no radius_m, and MILL.toml has balls of several sizes: occupancy, toe and shoulder, free flights and "
        "sizes are lost");
}

// What MILL.toml's [measurement] knows to be wrong with places and times.
void put_right(std::vector<SeenFrame>& frames, const MeasurementErrors& wrong) {
  const double longer = 1 + or_nothing(wrong.camera_scale), slower = 1 + or_nothing(wrong.frame_clock),
               turned = radians(or_nothing(wrong.camera_rotation_deg));
  if (longer == 1 && slower == 1 && turned == 0) return;
  const double c = std::cos(turned) / longer, s = std::sin(turned) / longer;
  for (SeenFrame& f : frames) {
    f.time /= slower;
    for (diagnose::Sighting& ball : f.balls) {
      const double x = ball.x, y = ball.y;
      ball.x = c * x + s * y;
      ball.y = c * y - s * x;
      ball.spin *= slower;
    }
  }
}

std::vector<SeenFrame> frames_of(const io::BallTracks& t) {
  std::vector<SeenFrame> frames;
  int of = -1;
  for (std::size_t i = 0; i < t.frame.size(); ++i) {
    if (t.frame[i] != of) {
      of = t.frame[i];
      if (!frames.empty() && t.time[i] == frames.back().time) {  // a repeated picture
        while (i + 1 < t.frame.size() && t.frame[i + 1] == of) ++i;
        continue;
      }
      frames.push_back({t.time[i], radians(t.mill_angle_deg[i]), {}});
    }
    frames.back().balls.push_back({t.id[i], t.x[i], t.y[i], t.radius[i], t.spin[i]});
  }
  return frames;
}

std::vector<SeenFrame> frames_of(const ChargeMotion& motion) {
  std::vector<SeenFrame> frames;
  std::vector<double> angle;  // by frame of the file
  for (const ProfileRow& row : motion.profile) {
    angle.resize(std::max(angle.size(), static_cast<std::size_t>(row.frame) + 1), kNotGiven);
    angle[static_cast<std::size_t>(row.frame)] = row.mill_angle_deg;
  }
  int of = -1;
  bool repeated = false;
  for (const TrackPoint& p : motion.tracks) {
    if (p.frame != of) {
      of = p.frame;
      repeated = std::binary_search(motion.duplicated_frames.begin(), motion.duplicated_frames.end(), of);
      const auto at = static_cast<std::size_t>(of);
      if (!repeated) frames.push_back({p.time, at < angle.size() ? radians(angle[at]) : kNotGiven, {}});
    }
    if (!repeated) frames.back().balls.push_back({p.id, p.x, p.y, p.radius, p.spin});
  }
  return frames;
}

// Rows of another unit are shown where they stand, not as what they come to.
void check_rows(const io::BallTracks& t, const Config& config) {
  constexpr double kBeyond = 1.5;
  const double most = kBeyond * config.mill.diameter / 2;
  std::size_t beyond = 0, first = t.x.size();
  for (std::size_t i = t.x.size(); i-- > 0;)
    if (std::hypot(t.x[i], t.y[i]) > most) ++beyond, first = i;
  if (beyond * 50 > t.x.size())  // others are taken for false finds
    throw InputError(
        t.table.place(first, "x_m"),
        fmt::format(
            "x_m, y_m are {:g}, {:g}: beyond the shell, whose radius is {:g} m; give metres about the mill's axis",
            t.x[first], t.y[first], config.mill.diameter / 2));
}

// The film as analysed before, or now.
ChargeMotion look_at(const fs::path& film, const Config& config, const fs::path& films, const CommonOptions& options) {
  analysis::TracksOptions told;
  told.mill = &config;
  if (films.empty()) return measure(film, told, options);
  std::error_code error;
  const auto bytes = fs::is_directory(film, error) ? 0 : fs::file_size(film, error);
  const auto changed = fs::last_write_time(film, error).time_since_epoch().count();
  Config mill;  // a film's analysis takes no more from MILL.toml
  mill.mill = config.mill;
  mill.charge = config.charge;
  const std::string key =
      fmt::format("{}\n{}\n{}\n{}\n{}", kVersion, fs::absolute(film).string(), bytes, changed, io::to_toml(mill));
  const fs::path kept = films / fmt::format("{:016x}.motion.h5", fingerprint(key));
  if (fs::exists(kept, error)) return io::read_motion(kept);
  ChargeMotion motion = measure(film, told, options);
  fs::create_directories(films, error);
  io::write_motion(kept, motion);
  return motion;
}

void read_frames(Measurement& m, const fs::path& films, const CommonOptions& options, std::vector<std::string>& notes) {
  Experiment& e = m.experiment;
  const fs::path& file = !e.film.empty() ? e.film : !e.motion.empty() ? e.motion : e.tracks;
  if (file.empty()) return;
  m.frames_file = file.string();
  if (!e.tracks.empty()) {
    const io::BallTracks tracks = io::read_ball_tracks(file);
    check_rows(tracks, m.config);
    m.frames = frames_of(tracks);
  } else {
    m.motion = e.film.empty() ? io::read_motion(file) : look_at(file, m.config, films, options);
    m.is_film = m.motion.source == MotionSource::kFilm;
    for (const std::string& caveat : m.motion.caveats) notes.push_back(e.name + ": " + caveat);
    const bool has_time = !std::isnan(m.motion.frames_per_second), is_still = m.motion.source == MotionSource::kStills;
    if (has_time && !is_still && !std::isnan(m.motion.mill_radius)) m.frames = frames_of(m.motion);
    if (m.frames.empty())
      notes.push_back(e.name + ": its pictures tell no motion of balls: toe and shoulder alone are used");
  }
  for (SeenFrame& f : m.frames)
    std::sort(f.balls.begin(), f.balls.end(), [](const auto& a, const auto& b) { return a.ball < b.ball; });
  if (m.frames.empty()) return;
  if (m.frames.size() < 3)
    throw InputError(m.frames_file, fmt::format("has {} frames; give at least 3", m.frames.size()));
  unwrap(m.frames);
  give_radii(m.frames, m.config, e.name, notes);
  put_right(m.frames, m.config.measurement);
  if (std::isnan(m.frames.front().mill_angle))
    notes.push_back(e.name +
                    ": no mill_angle_deg: the mill's own speed, its evenness and what turns with the drum are lost");
  const bool spins = std::any_of(m.frames.begin(), m.frames.end(), [](const SeenFrame& f) {
    return std::any_of(f.balls.begin(), f.balls.end(), [](const auto& ball) { return !std::isnan(ball.spin); });
  });
  if (!spins && !m.is_film) notes.push_back(e.name + ": no spin_rad_s: spin is lost");
  const double seconds = m.frames.back().time - m.frames.front().time;
  m.revolutions = std::abs(diagnose::turning_speed(m.frames, m.config)) * seconds / (2 * kPi);
  if (m.revolutions < 1)
    notes.push_back(
        fmt::format("{}: the frames show {:.2f} revolutions: too short for averages", e.name, m.revolutions));
}

void read_torque(Measurement& m, std::vector<std::string>& notes) {
  Experiment& e = m.experiment;
  const double slices = slice_count(m.config), speed = rad_s_from_rpm(speed_rpm(m.config.mill));
  const bool is_told = !std::isnan(e.torque.value) || !std::isnan(e.power.value);
  if (!e.torque_series.empty()) {
    const io::TorqueSeries series = io::read_torque_series(e.torque_series);
    for (std::size_t i = 0; i < series.time.size(); ++i)
      m.torque_series.push_back({series.time[i], series.torque[i] / slices});
    if (!is_told)
      e.torque = mean_of_series(series.torque);
    else
      notes.push_back(e.name + ": the mean torque is that of power_W or torque_N_m, not of torque_series");
    if (m.frames.empty()) m.revolutions = speed * (series.time.back() - series.time.front()) / (2 * kPi);
  }
  if (!std::isnan(e.torque.value)) m.torque = {e.torque.value / slices, e.torque.se / slices};
  if (!std::isnan(e.power.value)) m.torque = {e.power.value / (slices * speed), e.power.se / (slices * speed)};
  if (is_told) m.torque_error = or_nothing(m.torque.se);
  const double offset = or_nothing(m.config.measurement.torque_offset_N_m) / slices;
  m.torque.value -= offset;
  for (diagnose::TorqueSample& sample : m.torque_series) sample.torque -= offset;
}

// Toe, shoulder and the like, where they are not given as numbers.
void fill_angles(Measurement& m) {
  const bool has_radii =
      !m.frames.empty() && !m.frames.front().balls.empty() && !std::isnan(m.frames.front().balls.front().radius);
  if (!m.experiment.tracks.empty()) {
    if (!has_radii) return;
    m.motion = diagnose::motion_of(m.frames, m.config);
    m.motion.origin = m.frames_file;
  }
  for (const ScalarDatum& d : kScalarData)
    for (const MotionQuantity& q : kMotionQuantities)
      if (d.is_direction && q.name == std::string(d.name) && std::isnan((m.experiment.*d.measured).value)) {
        m.experiment.*d.measured = m.motion.*q.of;
        if (m.experiment.tracks.empty())  // those of tracks come from places that were put right
          (m.experiment.*d.measured).value -= or_nothing(m.config.measurement.camera_rotation_deg);
      }
}

Measurement read_one(const Experiment& experiment, const Config& mill, const fs::path& films,
                     const CommonOptions& options, std::vector<std::string>& notes) {
  Measurement m;
  m.experiment = experiment;
  m.config = io::config_of(mill, experiment);
  check_complete(m.config);
  read_frames(m, films, options, notes);
  read_torque(m, notes);
  diagnose::check_data(m);
  fill_angles(m);
  return m;
}

void check_uncertain(const Experiments& experiments, const Config& mill) {
  for (const UncertainKey& u : experiments.uncertain) {
    const double value = io::number_at(mill, u.key);
    if (u.sd < kLeastUncertainty * std::abs(value))
      throw InputError(
          u.place,
          fmt::format(
              "is {:g}, less than a millionth of its value {:g}; give one standard deviation, such as {:.2g}, or "
              "leave it out where it is known exactly",
              u.sd, value, 0.05 * std::abs(value)));
  }
}

// "speed 0.6, speed 0.8: no spin_rad_s: spin is lost": the same of several experiments, said once.
std::vector<std::string> said_once(const std::vector<std::string>& notes, const Experiments& experiments) {
  std::vector<std::pair<std::string, std::string>> of;  // what, and of whom
  for (const std::string& note : notes) {
    std::string who, what = note;
    for (const Experiment& e : experiments.list)
      if (note.starts_with(e.name + ": ")) who = e.name, what = note.substr(e.name.size() + 2);
    const auto at = std::find_if(of.begin(), of.end(), [&](const auto& known) { return known.first == what; });
    if (at == of.end())
      of.emplace_back(what, who);
    else
      at->second += ", " + who;
  }
  std::vector<std::string> said;
  for (const auto& [what, who] : of) said.push_back(who.empty() ? what : who + ": " + what);
  return said;
}

}  // namespace

std::vector<Measurement> read_measurements(const Experiments& experiments, const Config& mill, const fs::path& films,
                                           const CommonOptions& options, std::vector<std::string>& notes) {
  if (std::all_of(experiments.list.begin(), experiments.list.end(), [](const Experiment& e) { return e.hold_out; }))
    throw InputError(experiments.file, "holds out every experiment; leave some to fit");
  check_uncertain(experiments, mill);
  std::vector<Measurement> all;
  std::vector<std::string> remarks;
  for (const Experiment& e : experiments.list) {
    try {
      all.push_back(read_one(e, mill, films, options, remarks));
    } catch (const InputError& error) {  // the file alone would not tell whose it is
      const std::string said = error.what();
      throw InputError(said.starts_with(e.place) ? "" : e.place, said);
    }
  }
  if (std::none_of(experiments.list.begin(), experiments.list.end(), [](const Experiment& e) { return e.hold_out; }))
    remarks.push_back("no experiment is held out (hold_out = true): nothing tests the prediction");
  for (std::string& note : said_once(remarks, experiments)) notes.push_back(std::move(note));
  return all;
}

}  // namespace tumble::cli
