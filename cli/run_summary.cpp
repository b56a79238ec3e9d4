#include "cli/run_summary.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <vector>

#include "core/units.h"

namespace tumble::cli {
namespace {

double energy(const Observables& o) { return o.kinetic + o.potential + o.elastic; }
double lost(const Observables& o) { return std::accumulate(o.dissipation.begin(), o.dissipation.end(), 0.0); }

nlohmann::json number(double v) { return std::isfinite(v) ? nlohmann::json(v) : nlohmann::json(nullptr); }

}  // namespace

RunSummary summarise(const io::RunReader& run) {
  RunSummary s;
  const std::size_t n = run.frame_count();
  if (n == 0) return s;
  std::vector<double> torque, closure, power;
  for (std::size_t i = 0; i < n; ++i) {
    const Observables o = run.observables(i);
    torque.push_back(o.torque);
    closure.push_back(o.torque_closure);
    power.push_back(o.power);
  }
  s.torque = mean_of_series(torque);
  s.torque_closure = mean_of_series(closure);
  s.power = mean_of_series(power);
  s.slices = slice_count(run.setup().config);
  s.mill_power = {s.power.value * s.slices, s.power.se * s.slices};
  const Observables first = run.observables(0), last = run.observables(n - 1);
  const double work = last.drive_work - first.drive_work;
  s.energy_error = (work - (energy(last) - energy(first)) - (lost(last) - lost(first))) / work;
  s.locked_balls = last.locked_balls;
  return s;
}

std::string to_json(const RunSummary& s, const io::RunReader& run) {
  const RunSetup& setup = run.setup();
  const nlohmann::ordered_json j = {
      {"balls", setup.balls.size()},
      {"frames", run.frame_count()},
      {"time_step_s", setup.time_step},
      {"speed_rpm", number(rpm_from_rad_s(setup.mill_speed))},
      {"spin_up_revolutions", run.result().spin_up_revolutions},
      {"steady", run.result().steady},
      {"torque_N_m", number(s.torque.value)},
      {"torque_N_m_se", number(s.torque.se)},
      {"torque_closure_N_m", number(s.torque_closure.value)},
      {"power_W", number(s.power.value)},
      {"power_W_se", number(s.power.se)},
      {"slices", s.slices},
      {"mill_power_W", number(s.mill_power.value)},
      {"mill_power_W_se", number(s.mill_power.se)},
      {"energy_error", number(s.energy_error)},
      {"locked_balls", s.locked_balls},
      {"caveat", run.result().caveat},
  };
  return j.dump(2) + "\n";
}

}  // namespace tumble::cli
