#include "diagnose/campaign.h"

#include <atomic>
#include <mutex>
#include <numeric>
#include <optional>

#include "analysis/charge_motion.h"
#include "core/error.h"
#include "core/parallel_for.h"
#include "sim/simulator.h"

namespace tumble::diagnose {
namespace {

double energy(const Observables& o) { return o.kinetic + o.potential + o.elastic; }
double lost(const Observables& o) { return std::accumulate(o.dissipation.begin(), o.dissipation.end(), 0.0); }

// Share of each run that is done, and of the whole.
class Shares {
 public:
  Shares(std::size_t count, const Progress& progress) : count_(double(count)), progress_(progress) {}

  // One run got on from share `from` to share `to`.
  void advance(double from, double to) {
    const std::lock_guard lock(mutex_);
    done_ += to - from;
    report(progress_, done_ / count_);
  }

 private:
  double count_, done_ = 0;
  const Progress& progress_;
  std::mutex mutex_;
};

}  // namespace

RunOutcome run_once(const Config& config, const Progress& progress) {
  RunOutcome outcome;
  std::optional<analysis::FrameMeasurer> measurer;
  Observables first, last;
  std::vector<double> power;
  sim::RunSink sink;
  sink.setup = [&](const RunSetup& setup) { measurer.emplace(setup); };
  sink.frame = [&](const Frame& frame) {
    if (power.empty()) first = frame.observed;
    last = frame.observed;
    power.push_back(frame.observed.power);
    measurer->add(frame);
  };
  sink.progress = progress;
  try {
    const RunResult result = sim::simulate(config, sink);
    const ChargeMotion motion = measurer->finish();
    for (std::size_t i = 0; i < kMotionQuantities.size(); ++i) outcome.motion[i] = motion.*kMotionQuantities[i].of;
    outcome.power = mean_of_series(power);
    outcome.slices = slice_count(config);
    const double work = last.drive_work - first.drive_work;
    outcome.energy_error = (work - (energy(last) - energy(first)) - (lost(last) - lost(first))) / work;
    outcome.locked_balls = last.locked_balls;
    outcome.spin_up_revolutions = result.spin_up_revolutions;
    outcome.steady = result.steady;
  } catch (const Interrupted&) {
    throw;
  } catch (const Error& e) {
    outcome = {};
    outcome.error = e.what();
  }
  return outcome;
}

std::vector<RunOutcome> run_campaign(std::size_t count, const std::function<Config(std::size_t)>& config_of,
                                     const CampaignSink& sink) {
  std::vector<RunOutcome> outcomes(count);
  Shares shares(count, sink.progress);
  std::mutex telling;
  std::atomic<std::size_t> next = 0;
  // Each worker takes the next run in turn: runs differ in length, and a fixed division would leave cores idle.
  const auto work = [&](std::size_t, std::size_t) {
    for (std::size_t i = next++; i < count; i = next++) {
      if (sink.known) {
        const std::lock_guard lock(telling);
        if (sink.known(i, outcomes[i])) {
          shares.advance(0, 1);
          continue;
        }
      }
      const Config config = config_of(i);
      double done = 0;
      outcomes[i] = run_once(config, [&](double share) {
        shares.advance(done, share);
        done = share;
      });
      shares.advance(done, 1);
      const std::lock_guard lock(telling);
      if (sink.finished) sink.finished(i, config, outcomes[i]);
    }
  };
  parallel_for(std::min(count, static_cast<std::size_t>(thread_limit())), 1, work);
  return outcomes;
}

}  // namespace tumble::diagnose
