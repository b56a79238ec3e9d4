#include "trials/trial_data.h"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <memory>
#include <optional>

#include "analysis/charge_motion.h"
#include "cli/steps.h"
#include "core/angle.h"
#include "core/error.h"
#include "io/config_file.h"
#include "io/output.h"
#include "io/run_file.h"
#include "sim/simulator.h"
#include "trials/unknown_effects.h"

namespace tumble::trials {
namespace fs = std::filesystem;
namespace {

// A mill is watched for a little longer than it is filmed: a camera whose clock is slow films more of it than it
// believes, and the torque must be known for as long as the longest film.
constexpr double kMargin = 1.03;
constexpr double kScalarRate = 50;  // frames per second that toe and shoulder are read off

struct Seeds {
  std::uint64_t packing, instruments;
};

// The torque scale of the mill as handed out: all its balls at the shell, at 3 o'clock [N m].
double torque_scale(const Config& mill) {
  return slice_mass(mill, class_counts(mill)) * kGravity * mill.mill.diameter / 2;
}

// Where frames of one experiment go, by tier.
class Watch {
 public:
  Watch(const LabPlan& plan, const TrialKey& key, const Errors& errors, const fs::path& folder, const std::string& stem,
        std::size_t frames, const Seeds& seeds)
      : plan_(plan),
        tier_(key.tier),
        camera_(errors.camera),
        folder_(folder),
        stem_(stem),
        frames_(frames),
        seeds_(seeds) {}

  void setup(const RunSetup& setup) {
    if (tier_ == Tier::kScalars) return measurer_.emplace(setup), void();
    if (tier_ == Tier::kTracks) {
      std::vector<double> radius;
      if (plan_.mill.charge.balls.size() > 1)
        for (const double r : setup.balls.radius) radius.push_back(r * (1 + camera_.scale));
      out_.open(folder_ / (stem_ + ".csv"), std::ios::binary);
      tracker_.emplace(out_, plan_.mill.run.frames_per_second, std::move(radius), plan_.tracking, seeds_.instruments);
      return;
    }
    RunSetup seen = setup;  // balls nearer to the camera than the rim look larger, and farther from the axis
    for (double& r : seen.balls.radius) r *= 1 + camera_.scale;
    for (BallClass& b : seen.config.charge.balls) b.radius *= 1 + camera_.scale;
    seen.frame_count = static_cast<std::int64_t>(frames_);
    seen.mill_speed /= 1 + camera_.clock;
    seen.config.run.frames_per_second = plan_.mill.run.frames_per_second;
    writer_ = std::make_unique<io::RunWriter>(run_path(), seen, 0);
  }

  void add(const Frame& frame) {
    torque_.add(frame);
    if (measurer_) measurer_->add(frame);
    if (seen_ == frames_ || measurer_) return;
    Frame seen = as_seen(frame, camera_);
    seen.time *= 1 + camera_.clock;
    if (tracker_) tracker_->add(seen);
    if (writer_) writer_->write(seen);
    ++seen_;
  }

  // The file's line of EXPERIMENTS.toml.
  std::string finish(const RunResult& result) {
    if (measurer_) return angles(measurer_->finish());
    if (tracker_) {
      tracker_->finish();
      out_.close();
      if (!out_) throw WorkError((folder_ / (stem_ + ".csv")).string(), "cannot be written; is the disk full?");
      return fmt::format("tracks = \"{}.csv\"\n", stem_);
    }
    writer_->finish(result);
    writer_.reset();
    film();
    return fmt::format("film = \"{}.mp4\"\n", stem_);
  }

  const TorqueMeter& torque() const { return torque_; }

 private:
  fs::path run_path() const { return folder_ / (stem_ + ".h5"); }

  void film() const {
    cli::FilmPlan film;
    film.format.width = film.style.width = plan_.width;
    film.format.height = film.style.height = plan_.height;
    film.format.fps_numerator = static_cast<int>(std::lround(plan_.mill.run.frames_per_second * 1000));
    film.format.fps_denominator = 1000;
    film.style.colour = render::Colour::kSteel;
    film.style.overlay = {.toe = false, .shoulder = false, .text = false};  // words would tell the true speed
    cli::CommonOptions quiet;
    quiet.quiet = true;
    cli::render_run(io::RunReader(run_path()), {}, film, folder_ / (stem_ + ".mp4"), quiet);
    for (const char* end : {".h5", ".xdmf"}) fs::remove(folder_ / (stem_ + end));
  }

  std::string angles(const ChargeMotion& motion) const {
    Random random(seeds_.instruments);
    std::string lines;
    const auto read_off = [&](const char* name, double deg) {
      const double read = wrap_360(deg + degrees(camera_.rotation) + plan_.angle_error_deg * gaussian(random));
      lines += fmt::format("{0}_deg = {1:.1f}\n{0}_uncertainty_deg = {2:g}\n", name, read, plan_.angle_error_deg);
    };
    read_off("toe", motion.toe_deg.value);
    read_off("shoulder", motion.shoulder_deg.value);
    return lines;
  }

  const LabPlan& plan_;
  Tier tier_;
  diagnose::Observer camera_;
  fs::path folder_;
  std::string stem_;
  std::size_t frames_, seen_ = 0;
  Seeds seeds_;
  std::ofstream out_;
  std::optional<Tracker> tracker_;
  std::unique_ptr<io::RunWriter> writer_;
  std::optional<analysis::FrameMeasurer> measurer_;
  TorqueMeter torque_;
};

struct Seen {
  TorqueMeter torque;
  std::string data;  // lines of EXPERIMENTS.toml
  double seconds = 0;
  std::size_t frames = 0;
};

Seen watch(const LabPlan& plan, const TrialKey& key, const Condition& condition, const Errors& errors,
           const fs::path& folder, const std::string& stem, const Seeds& seeds, const Progress& progress) {
  const Config stated = stated_config(plan.mill, condition);
  const double rate = key.tier == Tier::kScalars ? kScalarRate : plan.mill.run.frames_per_second;
  Seen seen;
  seen.seconds = plan.mill.run.revolutions * 60 / speed_rpm(stated.mill);
  seen.frames = static_cast<std::size_t>(std::llround(seen.seconds * rate));

  Config config = true_config(plan.mill, condition, key);
  config.run.seed = seeds.packing;
  config.run.frames_per_second = rate * (1 + errors.camera.clock);
  const double watched = kMargin * seen.seconds;
  config.run.revolutions = watched * speed_rpm(config.mill) / 60;

  sim::OutsideForce outside;
  for (const Hidden& h : key.hidden)
    if (h.nature == Nature::kUnknown) outside = force_of(h.name, h.value, config);
  Watch camera(plan, key, errors, folder, stem, seen.frames, seeds);
  sim::RunSink sink;
  sink.setup = [&](const RunSetup& setup) { camera.setup(setup); };
  sink.frame = [&](const Frame& frame) { camera.add(frame); };
  sink.progress = progress;
  const RunResult result = sim::simulate(config, sink, {}, std::move(outside));
  seen.data = camera.finish(result);
  seen.torque = camera.torque();
  return seen;
}

std::string series_text(const Seen& seen, double rate, double factor, double offset, double noise, Random& random) {
  std::string text = "time_s,torque_N_m\n";
  const std::vector<double> torque = seen.torque.series(rate, seen.frames);
  for (std::size_t i = 0; i < torque.size(); ++i)
    text += fmt::format("{:.8g},{:#.6g}\n", double(i) / rate, factor * torque[i] + offset + noise * gaussian(random));
  return text;
}

std::string experiments_text(const LabPlan& plan, const std::vector<std::string>& experiments) {
  std::string text;
  for (const std::string& e : experiments) text += e + "\n";
  text += "[uncertain]\n";
  for (const UncertainKey& u : plan.uncertain) text += fmt::format("\"{}\" = {:g}\n", u.key, u.sd);
  return text;
}

void bear_no_date(const fs::path& folder) {
  using namespace std::chrono;
  const auto then = file_clock::from_sys(sys_seconds(sys_days{year{2000} / 1 / 1}));
  for (const auto& entry : fs::directory_iterator(folder)) fs::last_write_time(entry.path(), then);
  fs::last_write_time(folder, then);
}

}  // namespace

void write_trial(const LabPlan& plan, const TrialKey& key, const fs::path& folder, const Progress& progress) {
  fs::path staged = folder;
  staged += ".part";
  fs::remove_all(staged);
  fs::create_directory(staged);
  const Errors errors = errors_of(key);
  Random random(key.seed);

  std::vector<Seen> seen;
  const auto stem = [](std::size_t i) { return fmt::format("experiment_{}", i + 1); };
  for (std::size_t i = 0; i < plan.conditions.size(); ++i) {
    const Seeds seeds{random.next() >> 1, random.next()};
    seen.push_back(watch(plan, key, plan.conditions[i], errors, staged, stem(i), seeds,
                         [&](double done) { report(progress, (double(i) + done) / double(plan.conditions.size())); }));
  }

  // A sensor's zero is one torque, whatever the mill does.
  double fitted = 0, number = 0;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (plan.conditions[i].hold_out) continue;
    fitted += seen[i].torque.mean(seen[i].seconds);
    ++number;
  }
  const double slices = slice_count(plan.mill), scale = slices * torque_scale(plan.mill);
  const double zero = slices * errors.torque_offset * fitted / number;
  std::vector<std::string> experiments;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    const Condition& c = plan.conditions[i];
    const double offset = zero + plan.torque_error * scale * gaussian(random);
    std::string text = fmt::format("[[experiment]]\nname = \"{}\"\nset = {{ ", c.name);
    for (std::size_t k = 0; k < c.sets.size(); ++k)
      text += fmt::format("{}\"{}\" = {}", k == 0 ? "" : ", ", c.sets[k].first, c.sets[k].second);
    text += fmt::format(" }}\nhold_out = {}\ntorque_N_m = {:#.6g}\ntorque_uncertainty_N_m = {:#.6g}\n", c.hold_out,
                        slices * seen[i].torque.mean(seen[i].seconds) + offset, plan.torque_error * scale);
    text += seen[i].data;
    if (key.tier != Tier::kScalars) {
      const std::string file = stem(i) + "_torque.csv";
      text += fmt::format("torque_series = \"{}\"\n", file);
      io::write_text(staged / file, series_text(seen[i], plan.mill.run.frames_per_second, slices, offset,
                                                plan.torque_noise * scale, random));
    }
    experiments.push_back(std::move(text));
  }
  io::write_text(staged / "experiments.toml", experiments_text(plan, experiments));
  io::write_text(staged / "mill.toml", io::to_toml(plan.mill));
  bear_no_date(staged);
  fs::rename(staged, folder);
}

}  // namespace tumble::trials
