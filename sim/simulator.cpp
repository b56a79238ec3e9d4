#include "sim/simulator.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "core/units.h"
#include "sim/packing.h"
#include "sim/run_state.h"

namespace tumble::sim {
namespace {

constexpr double kSecondsBetweenCheckpoints = 2;  // of wall time: cheap beside what it saves
constexpr double kAutoShortest = 10;              // revolutions of spin-up before "auto" may find a mill steady,
constexpr double kAutoShortestLocked = 30;        // with locked balls: pockets fill over tens of revolutions
constexpr double kAutoLongest = 200;              // and after which it gives up
constexpr double kAutoZ = 2;                      // drift that "auto" takes for none [standard errors]
constexpr double kFewestToJudge = 1.5;            // averaged revolutions that a verdict on drift needs
constexpr double kCaveatZ = 3;                    // drift of the averages that is reported

using Clock = std::chrono::steady_clock;

double period(const MillModel& model) { return 2 * kPi / model.speed; }

std::int64_t frame_count(const Config& config, const MillModel& model) {
  return std::max<std::int64_t>(1, std::llround(config.run.revolutions * period(model) * config.run.frames_per_second));
}

std::int64_t step_after(const MillModel& model, double revolutions) {
  return std::llround(revolutions * period(model) / model.time_step);
}

double revolutions_after(const MillModel& model, std::int64_t step) {
  return double(step) * model.time_step / period(model);
}

// Samples of a run's history: at even mill angles from the start.
std::int64_t sample_step(const MillModel& model, std::size_t sample) {
  return step_after(model, double(sample + 1) / kSamplesPerRevolution);
}

void add(Sums& to, const Ledger& from) {
  to.torque += from.torque;
  to.torque_shear += from.torque_shear;
  to.torque_external += from.torque_external;
  to.mass_moment += from.mass_moment;
  to.steps += from.steps;
}

// Called every so many steps, so that a user sees progress, and can stop, in large mills too.
using Tick = std::function<void()>;
constexpr std::int64_t kBallStepsPerTick = 1'000'000;

void advance_to(RunState& run, std::int64_t step, const Tick& tick) {
  const std::int64_t steps_per_tick = 1 + kBallStepsPerTick / static_cast<std::int64_t>(run.mill.charge.size());
  while (run.mill.step < step) {
    const std::int64_t until = std::min(step, run.mill.step + steps_per_tick);
    while (run.mill.step < until) advance(run.mill);
    tick();
  }
  Ledger& ledger = run.mill.ledger;
  add(run.frame, ledger);
  add(run.sample, ledger);
  ledger.torque = ledger.torque_shear = ledger.torque_external = ledger.mass_moment = 0;
  ledger.steps = 0;
}

void take_sample(RunState& run) {
  const double steps = double(run.sample.steps);
  look_for_locked_balls(run.mill, run.locked);
  run.history.torque.push_back(run.sample.torque / steps);
  run.history.closure.push_back(run.mill.model.gravity * run.sample.mass_moment / steps);
  run.history.locked.push_back(run.locked.count);
  run.sample = {};
}

// Runs to the step, taking the samples on the way.
void run_to(RunState& run, std::int64_t step, const Tick& tick) {
  for (;;) {
    const std::int64_t next = sample_step(run.mill.model, run.history.size());
    if (next > step) break;
    advance_to(run, next, tick);
    take_sample(run);
  }
  advance_to(run, step, tick);
}

Frame frame_of(const RunState& run) {
  const RunningMill& mill = run.mill;
  const MillModel& model = mill.model;
  const Charge& c = mill.charge;
  Frame f;
  f.step = mill.step;
  f.time = double(run.frames_written) * model.steps_per_frame * model.time_step;
  f.mill_angle = mill_angle(model, mill.step);
  for (auto* v : {&f.x, &f.y, &f.angle, &f.vx, &f.vy, &f.spin}) v->resize(c.size());
  for (std::size_t i = 0; i < c.size(); ++i) {  // velocities at the frame's own time
    const auto number = static_cast<std::size_t>(c.id[i]);
    f.x[number] = c.x[i];
    f.y[number] = c.y[i];
    f.angle[number] = c.angle[i];
    f.vx[number] = c.vx[i] - c.ax[i];
    f.vy[number] = c.vy[i] - c.ay[i];
    f.spin[number] = c.spin[i] - c.alpha[i];
  }
  Observables& o = f.observed;
  const double steps = double(run.frame.steps);
  o.torque = run.frame.torque / steps;
  o.torque_shear = run.frame.torque_shear / steps;
  o.torque_closure = model.gravity * run.frame.mass_moment / steps;
  o.torque_external = run.frame.torque_external / steps;
  o.power = (mill.ledger.drive_work - run.work_at_frame) / (steps * model.time_step);
  const Energies e = energies_of(mill);
  o.kinetic = e.kinetic;
  o.potential = e.potential;
  o.elastic = e.elastic;
  o.drive_work = mill.ledger.drive_work;
  for (const Cause cause : causes_of(model))
    o.dissipation.push_back(mill.ledger.dissipated[static_cast<std::size_t>(cause)]);
  o.locked_balls = run.locked.count;
  return f;
}

// The half of the spin-up that lies nearest is what a judgement of "steady now" rests on.
bool spin_up_is_over(const Config& config, RunState& run) {
  const MillModel& model = run.mill.model;
  if (!config.run.spin_up_auto) return run.mill.step >= step_after(model, config.run.spin_up);
  const std::size_t samples = run.history.size();
  const double revolutions = double(samples) / kSamplesPerRevolution;
  if (samples % kSamplesPerRevolution != 0) return false;
  if (revolutions < (run.locked.count > 0 ? kAutoShortestLocked : kAutoShortest)) return false;
  if (judge(run.history, samples / 2, samples, run.mill.charge.size(), kAutoZ).steady) return true;
  run.spin_up_gave_up = revolutions >= kAutoLongest;
  return run.spin_up_gave_up;
}

std::vector<std::string> cause_names(const MillModel& model) {
  std::vector<std::string> names;
  for (const Cause cause : causes_of(model)) names.emplace_back(kCauseNames[static_cast<std::size_t>(cause)]);
  return names;
}

class Checkpoints {
 public:
  explicit Checkpoints(const RunSink& sink) : sink_(sink), last_(Clock::now()) {}
  void maybe(const RunState& run) {
    if (!sink_.checkpoint || Clock::now() - last_ < std::chrono::duration<double>(kSecondsBetweenCheckpoints)) return;
    sink_.checkpoint(checkpoint_of(run));
    last_ = Clock::now();
  }

 private:
  const RunSink& sink_;
  Clock::time_point last_;
};

void spin_up(const Config& config, RunState& run, Checkpoints& checkpoints, const Progress& progress) {
  const MillModel& model = run.mill.model;
  const Tick tick = [&] {
    const double done = revolutions_after(model, run.mill.step);
    const double expected = config.run.spin_up_auto ? std::max(3 * kAutoShortest, 1.5 * done) : config.run.spin_up;
    report(progress, done / (expected + config.run.revolutions));
  };
  while (!spin_up_is_over(config, run)) {
    std::int64_t next = sample_step(model, run.history.size());
    if (!config.run.spin_up_auto) next = std::min(next, step_after(model, config.run.spin_up));
    run_to(run, next, tick);
    checkpoints.maybe(run);
  }
  run.averaging_from = run.mill.step;
  run.sampled_before = static_cast<std::int64_t>(run.history.size());
  run.frame = {};
  run.work_at_frame = run.mill.ledger.drive_work;
  run.mill.ledger.counting_impacts = true;
}

template <class Counts>
std::vector<double> per_second(const Counts& counts, double seconds) {
  std::vector<double> rates(counts.begin(), counts.end());
  for (double& r : rates) r /= seconds;
  return rates;
}

std::vector<double> even_edges(double last, int bins) {
  std::vector<double> edges;
  for (int b = 0; b <= bins; ++b) edges.push_back(last * b / bins);
  return edges;
}

void add_impacts(RunResult& result, const Impacts& n, double seconds, double diameter) {
  ImpactSpectrum& s = result.spectrum;
  for (int b = 0; b <= kBins; ++b) s.edges_J.push_back(std::pow(10.0, kLowestDecade + double(b) / kBinsPerDecade));
  s.ball_ball = per_second(n.ball_ball.total, seconds);
  s.ball_ball_normal = per_second(n.ball_ball.normal, seconds);
  s.ball_ball_tangential = per_second(n.ball_ball.tangential, seconds);
  s.ball_wall = per_second(n.ball_wall.total, seconds);
  s.ball_wall_normal = per_second(n.ball_wall.normal, seconds);
  s.ball_wall_tangential = per_second(n.ball_wall.tangential, seconds);

  result.falls = {even_edges(diameter, kFallBins), per_second(n.falls, seconds)};

  ImpactPlaces& p = result.places;
  p.angle_edges_deg = even_edges(360, kAngleBins);
  static_assert(kFaces == kFaceNames.size() && kFaces == static_cast<int>(Face::kCount));
  for (std::size_t f = 0; f < kFaceNames.size(); ++f) {
    const auto of_face = [&](const std::array<double, kPlaces>& all) {
      return std::vector<double>(all.begin() + f * kAngleBins, all.begin() + (f + 1) * kAngleBins);
    };
    p.frequency[f] = per_second(of_face(n.wall_number), seconds);
    p.power[f] = per_second(of_face(n.wall_energy), seconds);
  }
  p.lifter_frequency = per_second(n.lifter_number, seconds);
  p.lifter_power = per_second(n.lifter_energy, seconds);
}

RunResult result_of(const Config& config, const RunState& run) {
  const MillModel& model = run.mill.model;
  RunResult result;
  result.spin_up_revolutions = revolutions_after(model, run.averaging_from);
  const double seconds = double(run.mill.step - run.averaging_from) * model.time_step;
  add_impacts(result, run.mill.ledger.impacts, seconds, 2 * model.shell.radius);

  const Steadiness s = judge(run.history, static_cast<std::size_t>(run.sampled_before), run.history.size(),
                             run.mill.charge.size(), kCaveatZ);
  const auto say = [&](const std::string& sentence) { result.caveat += (result.caveat.empty() ? "" : " ") + sentence; };
  if (run.spin_up_gave_up) say(fmt::format("The mill was not steady after {:g} revolutions of spin-up.", kAutoLongest));
  const double revolutions = revolutions_after(model, run.mill.step - run.averaging_from);
  result.steady = s.steady && !run.spin_up_gave_up && revolutions >= kFewestToJudge;
  if (revolutions < kFewestToJudge)
    say(fmt::format("{:.3g} averaged revolutions are too few to tell whether the mill is steady.", revolutions));
  else if (!s.steady)
    say(fmt::format(
        "The averages drift: against the first half of the revolutions, the second half's torque lies {:+.1f} and its "
        "centre of mass {:+.1f} standard errors off, and {:.0f} more balls are locked; {}.",
        s.torque_z, s.closure_z, s.locked_change,
        config.run.spin_up_auto ? "average more revolutions (run.revolutions)"
                                : "run.spin_up = \"auto\" waits until they are steady"));
  if (run.locked.count > 0 && speed_fraction(config.mill) < 1)
    say(fmt::format(
        "{} of {} balls are locked between the lifters and turn with the shell: an artefact of the plane slice "
        "that lowers the torque.",
        run.locked.count, run.mill.charge.size()));
  return result;
}

}  // namespace

RunResult simulate(const Config& config, const RunSink& sink, std::optional<StoredCheckpoint> resume,
                   OutsideForce outside) {
  check_complete(config);
  const MillModel model = make_mill_model(config);
  Balls balls = draw_balls(config);

  // Settling may take minutes with many small balls: it has its share of the progress, by simulated time.
  const double spin_up_expected = config.run.spin_up_auto ? 3 * kAutoShortest : config.run.spin_up;
  const double settling = longest_settling(model);
  const double share = settling / (settling + (spin_up_expected + config.run.revolutions) * period(model));
  const Progress settled = [&](double done) { report(sink.progress, share * done); };
  const Progress turned = [&](double done) { report(sink.progress, share + (1 - share) * done); };

  const int threads = threads_for(balls.size());
  RunState run;
  if (resume) {
    run.mill = start_mill(model, make_charge(balls), threads);
    restore(run, *resume);
    resume.reset();  // it may hold memory
  } else {
    run.mill = start_mill(model, settle(model, place_loosely(config, model, balls), settled), threads);
  }
  run.mill.outside = std::move(outside);
  const std::int64_t frames = frame_count(config, model);
  if (sink.setup) sink.setup({config, std::move(balls), model.time_step, model.speed, frames, cause_names(model)});

  Checkpoints checkpoints(sink);
  if (run.averaging_from < 0) spin_up(config, run, checkpoints, turned);
  const double spun_up = revolutions_after(model, run.averaging_from);
  const Tick tick = [&] {
    report(turned, revolutions_after(model, run.mill.step) / (spun_up + config.run.revolutions));
  };
  while (run.frames_written < frames) {
    run_to(run, run.averaging_from + (run.frames_written + 1) * model.steps_per_frame, tick);
    if (sink.frame) sink.frame(frame_of(run));
    run.frame = {};
    run.work_at_frame = run.mill.ledger.drive_work;
    ++run.frames_written;
    checkpoints.maybe(run);
  }
  return result_of(config, run);
}

std::size_t checkpoint_capacity(const Config& config) {
  std::size_t balls = 0;
  for (const int n : class_counts(config)) balls += static_cast<std::size_t>(n);
  const double revolutions = (config.run.spin_up_auto ? kAutoLongest : config.run.spin_up) + config.run.revolutions + 2;
  return most_words(balls, static_cast<std::size_t>(std::ceil(revolutions * kSamplesPerRevolution)),
                    static_cast<std::size_t>(std::max(0, config.mill.lifters.count)));
}

}  // namespace tumble::sim
