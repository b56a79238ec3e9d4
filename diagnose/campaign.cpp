#include "diagnose/campaign.h"

#include <mutex>
#include <numeric>
#include <optional>

#include "analysis/charge_motion.h"
#include "core/error.h"
#include "diagnose/in_turns.h"
#include "sim/simulator.h"

namespace tumble::diagnose {
namespace {

double energy(const Observables& o) { return o.kinetic + o.potential + o.elastic; }
double lost(const Observables& o) { return std::accumulate(o.dissipation.begin(), o.dissipation.end(), 0.0); }

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
  std::mutex telling;
  in_turns(count, sink.progress, [&](std::size_t i, const Progress& own) {
    if (sink.known) {
      const std::lock_guard lock(telling);
      if (sink.known(i, outcomes[i])) return;
    }
    const Config config = config_of(i);
    outcomes[i] = run_once(config, own);
    const std::lock_guard lock(telling);
    if (sink.finished) sink.finished(i, config, outcomes[i]);
  });
  return outcomes;
}

}  // namespace tumble::diagnose
