#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>

#include "analysis/charge_motion.h"
#include "bench/film_commands.h"
#include "bench/film_staging.h"
#include "core/error.h"
#include "core/units.h"
#include "io/film_file.h"

namespace fs = std::filesystem;

namespace tumble::films {
namespace {

using render::BallState;

// The film begins so long after the first state: rolling shutters look back [s].
constexpr double kLead = 0.02;

// Cubic through places and velocities: a flight is exact.
BallState between(const BallState& a, const BallState& b, double seconds, double share) {
  const double s = share, s2 = s * s, s3 = s2 * s;
  const double h0 = 2 * s3 - 3 * s2 + 1, h1 = 1 - h0, d0 = s3 - 2 * s2 + s, d1 = s3 - s2;
  const double k0 = (6 * s2 - 6 * s) / seconds, e0 = 3 * s2 - 4 * s + 1, e1 = 3 * s2 - 2 * s;
  const auto place = [&](double p, double q, double v, double w) {
    return h0 * p + h1 * q + seconds * (d0 * v + d1 * w);
  };
  const auto speed = [&](double p, double q, double v, double w) { return k0 * (p - q) + e0 * v + e1 * w; };
  BallState c;
  c.x = place(a.x, b.x, a.vx, b.vx);
  c.y = place(a.y, b.y, a.vy, b.vy);
  c.angle = place(a.angle, b.angle, a.spin, b.spin);
  c.vx = speed(a.x, b.x, a.vx, b.vx);
  c.vy = speed(a.y, b.y, a.vy, b.vy);
  c.spin = speed(a.angle, b.angle, a.spin, b.spin);
  return c;
}

BallState state_at(const FilmMill& mill, std::size_t ball, double time) {
  const double seconds = mill.states[1].time - mill.states[0].time;
  const double at = std::clamp((time - mill.states[0].time) / seconds, 0.0, double(mill.states.size()) - 1.001);
  const auto k = static_cast<std::size_t>(at);
  return between(mill.states[k].balls[ball], mill.states[k + 1].balls[ball], seconds, at - double(k));
}

// Which recorded frame each frame of the file shows, and with what clock the file runs.
struct TimeBase {
  std::vector<int> recorded_of_file, duplicated, dropped;
  double file_fps = 30;
};

TimeBase random_time_base(int frames, double fps, int level, Random& random) {
  TimeBase base;
  base.file_fps = fps;
  if (level > 0 && random.uniform() < 0.4)
    base.file_fps = random.uniform() < 0.5 ? 30 : random.uniform() < 0.5 ? 25 : 60;
  const bool faulty = level >= 2 && random.uniform() < 0.6;
  const double drop = faulty ? random.uniform(0.002, 0.02) : 0, twice = faulty ? random.uniform(0.002, 0.02) : 0;
  for (int k = 0; k < frames; ++k) {
    if (k > 0 && random.uniform() < drop) {
      base.dropped.push_back(k);
      continue;
    }
    base.recorded_of_file.push_back(k);
    if (random.uniform() < twice) {
      base.duplicated.push_back(static_cast<int>(base.recorded_of_file.size()));
      base.recorded_of_file.push_back(k);
    }
  }
  return base;
}

// What the laboratory knows of its mill: the drawing, the balls, and the speed that the drive was set to.
void write_given(const fs::path& path, const FilmMill& mill, double speed_error) {
  const Mill& m = mill.config.mill;
  std::string text = fmt::format("[mill]\ndiameter = {:.6g}\nlength = {:.6g}\nspeed_rpm = {:.5g}\n", m.diameter,
                                 mill.length, rpm_from_rad_s(mill.mill_speed) * (1 + speed_error));
  const Lifters& l = m.lifters;
  if (l.count > 0) {
    text += fmt::format("[mill.lifters]\ncount = {}\nprofile = \"{}\"\nheight = {:.6g}\n", l.count, name_of(l.profile),
                        l.height);
    const auto key = [&](const char* name, double value) {
      if (!std::isnan(value)) text += fmt::format("{} = {:.6g}\n", name, value);
    };
    key("width", l.width);
    key("leading_angle_deg", l.leading_angle_deg);
    key("trailing_angle_deg", l.trailing_angle_deg);
    key("swivel_angle_deg", l.swivel_angle_deg);
  }
  text += "[charge]\nballs = [";
  for (const BallClass& c : mill.config.charge.balls)
    text += fmt::format(" {{ radius = {:.6g}, density = 7800 }},", c.radius);
  text.back() = ' ';
  std::ofstream(path) << text << "]\n";
}

// A mill before its camera. With more seconds it is the same mill, seen for longer.
struct Staged {
  FilmMill mill;
  render::FilmLook look;
  render::FilmScene scene;
  std::vector<double> z;  // depth of every ball [m]
};

Staged stage(const FilmOrder& order, double seconds, Random& random) {
  if (!(seconds > 0 && order.fps >= 1)) throw InputError("--seconds, --fps", "must be above 0 and at least 1");
  Keeping keeping;
  keeping.seconds = seconds + 0.1;
  keeping.states_per_second = std::max(250.0, order.fps);
  keeping.slabs = true;
  Staged staged;
  staged.mill = simulate_random_mill(order.seed + 500000, keeping);
  staged.look = render::random_look(order.seed * 977 + 5, order.level);
  staged.look.timing.exposure = std::min(staged.look.timing.exposure, 0.9 / order.fps);
  staged.look.timing.readout = std::min(staged.look.timing.readout, 0.95 / order.fps);
  frame_mill(staged.look, staged.mill, order.level == 3 ? Crop::kOften : Crop::kNever, random);
  staged.scene = scene_of(staged.mill, random.uniform() < 0.4);
  staged.z = slab_depths_of(staged.mill, random);
  return staged;
}

Random random_of(const FilmOrder& order) {
  Random random(order.seed * 69069 + 17);
  random.next();
  return random;
}

// Toe, shoulder and the rest as the run's own truth would have them: all layers' balls together, as a camera sees them.
// `as_if_at_glass`: where a camera puts balls that it takes to touch the glass; else where they are.
ChargeMotion charge_motion_of(const Staged& staged, int frames, double fps, bool as_if_at_glass) {
  const FilmMill& mill = staged.mill;
  const double begin = mill.states[0].time + kLead;
  Eigen::Vector3d eye = staged.look.lens.position * staged.scene.shape.radius;
  if (staged.scene.clockwise) eye.x() = -eye.x();  // the mill is simulated counter-clockwise
  RunSetup setup;
  setup.config = mill.config;
  setup.config.run.frames_per_second = fps;
  setup.mill_speed = mill.mill_speed;
  setup.frame_count = frames;
  for (const double r : mill.radius) {
    setup.balls.radius.push_back(r);
    setup.balls.mass.push_back(7800 * 4.0 / 3 * kPi * r * r * r);
  }
  int next = 0;
  return analysis::measure_frames(setup, [&](Frame& frame) {
    if (next >= frames) return false;
    frame = {};
    frame.time = next / fps;
    frame.mill_angle = mill.states[0].mill_angle + mill.mill_speed * (begin + frame.time - mill.states[0].time);
    for (std::size_t i = 0; i < mill.radius.size(); ++i) {
      const BallState b = state_at(mill, i, begin + frame.time);
      const double k = as_if_at_glass ? (eye.z() + mill.radius[i]) / (eye.z() - staged.z[i]) : 1.0;
      frame.x.push_back(eye.x() + (b.x - eye.x()) * k);
      frame.y.push_back(eye.y() + (b.y - eye.y()) * k);
      frame.vx.push_back(b.vx * k);
      frame.vy.push_back(b.vy * k);
      frame.angle.push_back(b.angle);
      frame.spin.push_back(b.spin);
    }
    ++next;
    return true;
  });
}

void write_rows(std::ofstream& csv, std::size_t frame, const render::FilmPicture& picture) {
  for (const render::SeenBall& b : picture.balls) {
    const double r = b.radius_px;
    if (b.u < -r || b.v < -r || b.u > picture.image.width + r || b.v > picture.image.height + r) continue;
    csv << fmt::format("{},{},{:.3f},{:.3f},{:.3f},{:.3f},{:.6f},{:.6f},{:.6f},{:.4f},{:.5f},{:.5f},{:.3f}\n", frame,
                       b.ball, b.u, b.v, r, b.visible, b.state.x, b.state.y, b.state.z, b.state.angle, b.state.vx,
                       b.state.vy, b.glare);
  }
}

}  // namespace

void make_film(const FilmOrder& order) {
  Random random = random_of(order);
  const Staged staged = stage(order, order.seconds, random);
  const auto& [mill, look, scene, z] = staged;
  const int frames = static_cast<int>(order.seconds * order.fps);
  const TimeBase base = random_time_base(frames, order.fps, order.level, random);

  io::FilmFormat format;
  format.width = look.lens.width;
  format.height = look.lens.height;
  format.fps_numerator = static_cast<int>(std::lround(base.file_fps * 1000));
  format.fps_denominator = 1000;
  format.preset = "medium";
  format.crf = order.level == 0 ? random.uniform(16, 20) : random.uniform(18, 22 + 3.5 * order.level);
  format.threads = 1;
  io::FilmWriter writer(order.file.string(), format);
  const fs::path stem = order.file.parent_path() / order.file.stem();
  std::ofstream csv(stem.string() + ".truth.csv");
  csv << "frame,id,u_px,v_px,r_px,visible,x_m,y_m,z_m,theta_rad,vx,vy,glare\n";

  // A camera on a shaky bench: slow sways and a quick tremble.
  const double sway = order.level >= 2 && random.uniform() < 0.5 ? log_uniform(random, 0.2, 1.0 * order.level) : 0;
  const double sway_hz = random.uniform(0.5, 3), tremble_hz = random.uniform(8, 25), phase = random.uniform(0, 6);
  std::vector<std::array<double, 2>> shakes;
  const auto shake_at = [&](double time) -> Eigen::Vector2d {
    const double slow = 2 * kPi * sway_hz * time + phase, quick = 2 * kPi * tremble_hz * time;
    return sway * Eigen::Vector2d(std::sin(slow) + 0.2 * std::sin(quick),
                                  0.7 * std::sin(1.3 * slow + 1) + 0.3 * std::cos(quick));
  };

  render::FilmCamera camera;
  camera.aim(look, scene);
  render::FilmPicture picture;
  int drawn = -1;
  for (std::size_t k = 0; k < base.recorded_of_file.size(); ++k) {
    if (const int recorded = base.recorded_of_file[k]; recorded != drawn) {
      render::FilmMoment moment;
      moment.time = mill.states[0].time + kLead + recorded / order.fps;
      moment.mill_angle = mill.states[0].mill_angle + mill.mill_speed * (moment.time - mill.states[0].time);
      moment.mill_speed = mill.mill_speed;
      moment.shake = shake_at(moment.time);
      moment.ball = [&](std::size_t i, double later) {
        BallState b = state_at(mill, i, moment.time + later);
        b.z = z[i];
        return b;
      };
      picture = camera.draw(moment, static_cast<std::uint64_t>(recorded));
      drawn = recorded;
    }
    const Eigen::Vector2d shake = shake_at(mill.states[0].time + kLead + drawn / order.fps);
    shakes.push_back({shake.x(), shake.y()});
    writer.write(picture.image);
    write_rows(csv, k, picture);
  }
  writer.finish();

  const double speed_error = random.uniform(-0.02, 0.02);
  write_given(stem.string() + ".given.toml", mill, speed_error);
  nlohmann::ordered_json json = {{"seed", order.seed},
                                 {"level", order.level},
                                 {"frames", base.recorded_of_file.size()},
                                 {"fps_recorded", order.fps},
                                 {"fps_file", base.file_fps},
                                 {"duplicated_file_frames", base.duplicated},
                                 {"dropped_recorded_frames", base.dropped},
                                 {"recorded_frame_of_file_frame", base.recorded_of_file},
                                 {"crf", format.crf},
                                 {"direction", scene.clockwise ? "clockwise" : "anticlockwise"},
                                 {"rpm", rpm_from_rad_s(mill.mill_speed)},
                                 {"speed_error_given", speed_error},
                                 {"first_frame_mill_angle_rad", mill.states[0].mill_angle + kLead * mill.mill_speed},
                                 {"mill", json_of(mill)},
                                 {"camera", json_of(look.lens, scene.shape.radius)},
                                 {"look", json_of(look)}};
  if (sway > 0) json["shake_px"] = shakes;
  const ChargeMotion motion = charge_motion_of(staged, frames, order.fps, false);
  const auto known = [](double value) {
    return std::isnan(value) ? nlohmann::ordered_json() : nlohmann::ordered_json(value);
  };
  for (const auto& [name, estimate] :
       {std::pair{"toe_deg", motion.toe_deg}, std::pair{"shoulder_deg", motion.shoulder_deg},
        std::pair{"toe_bulk_deg", motion.toe_bulk_deg}, std::pair{"shoulder_bulk_deg", motion.shoulder_bulk_deg},
        std::pair{"toe_outer_deg", motion.toe_outer_deg}, std::pair{"shoulder_outer_deg", motion.shoulder_outer_deg}})
    json["charge"][name] = known(estimate.value);
  for (const ProfileRow& row : motion.profile) {
    json["charge"]["toe_deg_of_recorded_frame"].push_back(known(row.toe_deg));
    json["charge"]["shoulder_deg_of_recorded_frame"].push_back(known(row.shoulder_deg));
  }
  for (const render::SeenBall& b : picture.balls) {
    json["balls"]["radius_m"].push_back(mill.radius[b.ball]);
    json["balls"]["class"].push_back(mill.ball_class[b.ball]);
    json["balls"]["marked"].push_back(b.marked);
    json["balls"]["tracer"].push_back(b.tracer);
  }
  std::ofstream(stem.string() + ".truth.json") << json.dump(1) << '\n';
  if (!csv.flush()) throw WorkError(stem.string() + ".truth.csv", "could not be written");
}

void make_long_run(const FilmOrder& order, double times) {
  Random random = random_of(order);
  const Staged staged = stage(order, times * order.seconds, random);
  nlohmann::ordered_json json = {
      {"seed", order.seed}, {"fps", order.fps}, {"seconds", order.seconds}, {"times", times}};
  for (const auto& [name, seconds] : {std::pair{"film", order.seconds}, std::pair{"long", times * order.seconds}}) {
    const ChargeMotion m = charge_motion_of(staged, static_cast<int>(seconds * order.fps), order.fps, true);
    for (const auto& [key, e] :
         {std::pair{"toe_deg", m.toe_deg}, std::pair{"shoulder_deg", m.shoulder_deg},
          std::pair{"toe_bulk_deg", m.toe_bulk_deg}, std::pair{"shoulder_bulk_deg", m.shoulder_bulk_deg},
          std::pair{"toe_outer_deg", m.toe_outer_deg}, std::pair{"shoulder_outer_deg", m.shoulder_outer_deg},
          std::pair{"departure_deg", m.departure_deg}, std::pair{"impact_toe_deg", m.impact_toe_deg},
          std::pair{"head_m", m.head}, std::pair{"centre_of_circulation_x_m", m.centre_of_circulation_x},
          std::pair{"centre_of_circulation_y_m", m.centre_of_circulation_y}}) {
      json[name][key] = std::isnan(e.value) ? nlohmann::ordered_json() : nlohmann::ordered_json(e.value);
      json[name][std::string(key) + "_se"] = std::isnan(e.se) ? nlohmann::ordered_json() : nlohmann::ordered_json(e.se);
    }
  }
  std::ofstream out(order.file);
  if (!(out << json.dump(1) << '\n').flush()) throw WorkError(order.file.string(), "could not be written");
}

}  // namespace tumble::films
