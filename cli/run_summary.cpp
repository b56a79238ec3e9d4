#include "cli/run_summary.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <vector>

#include "core/effects.h"
#include "core/units.h"

namespace tumble::cli {
namespace {

using Json = nlohmann::ordered_json;

double energy(const Observables& o) { return o.kinetic + o.potential + o.elastic; }
double lost(const Observables& o) { return std::accumulate(o.dissipation.begin(), o.dissipation.end(), 0.0); }
double sum(const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0); }
Estimate times(const Estimate& e, double factor) { return {e.value * factor, e.se * factor}; }

Json number(double v) { return std::isfinite(v) ? Json(v) : Json(nullptr); }

// The effects that are on, with every parameter in force.
Json effects_of(const Config& config) {
  Json all = Json::object();
  for (const Effect& effect : all_effects()) {
    if (!has_effect(config, effect.name)) continue;
    Json& of = all[effect.name] = Json::object();
    for (const EffectParameter& p : effect.parameters) {
      if (p.is_column())
        of[p.name] = effect_column(config, effect.name, p.name);
      else if (p.list)
        of[p.name] = effect_list(config, effect.name, p.name);
      else
        of[p.name] = effect_value(config, effect.name, p.name);
    }
  }
  return all;
}

const char* name_of(SliceRule rule) {
  switch (rule) {
    case SliceRule::kGiven:
      return "mill.slices";
    case SliceRule::kNoLength:
      return "no mill.length";
    case SliceRule::kThin:
      return "one layer";
    case SliceRule::kWeight:
      break;
  }
  return "ball weights";
}

}  // namespace

RunSummary summarise(const io::RunReader& run) {
  RunSummary s;
  const std::size_t n = run.frame_count();
  if (n == 0) return s;
  std::vector<double> torque, closure, power;
  const std::size_t causes = run.setup().dissipation_causes.size();
  std::vector<std::vector<double>> dissipated(causes);
  Observables first, last;
  s.time = run.time();
  for (std::size_t i = 0; i < n; ++i) {
    const Observables o = run.observables(i);
    torque.push_back(o.torque);
    closure.push_back(o.torque_closure);
    power.push_back(o.power);
    s.external.push_back(o.torque_external);
    s.locked.push_back(o.locked_balls);
    for (std::size_t c = 0; i > 0 && c < causes; ++c)
      dissipated[c].push_back((o.dissipation[c] - last.dissipation[c]) / (s.time[i] - s.time[i - 1]));
    if (i == 0) first = o;
    last = o;
  }
  s.torque = mean_of_series(torque);
  s.torque_closure = mean_of_series(closure);
  s.torque_external = mean_of_series(s.external);
  s.power = mean_of_series(power);
  for (const auto& series : dissipated) s.dissipation.push_back(mean_of_series(series));
  s.slices = slice_count(run.setup().config);
  s.mill_torque = times(s.torque, s.slices);
  s.mill_power = times(s.power, s.slices);
  const double work = last.drive_work - first.drive_work;
  s.energy_error = (work - (energy(last) - energy(first)) - (lost(last) - lost(first))) / work;
  if (n > 1) s.stored_power = (energy(last) - energy(first)) / (s.time.back() - s.time.front());
  s.locked_balls = last.locked_balls;
  if (run.complete()) {
    s.ball_impacts = sum(run.result().spectrum.ball_ball);
    s.wall_impacts = sum(run.result().spectrum.ball_wall);
  }
  return s;
}

std::string to_json(const RunSummary& s, const io::RunReader& run) {
  const RunSetup& setup = run.setup();
  Json dissipation = Json::object();
  for (std::size_t c = 0; c < s.dissipation.size(); ++c)
    dissipation[setup.dissipation_causes[c]] = number(s.dissipation[c].value);
  const Json j = {
      {"balls", setup.balls.size()},
      {"frames", run.frame_count()},
      {"time_step_s", setup.time_step},
      {"speed_rpm", number(rpm_from_rad_s(setup.mill_speed))},
      {"spin_up_revolutions", run.result().spin_up_revolutions},
      {"steady", run.result().steady},
      {"torque_N_m", number(s.torque.value)},
      {"torque_N_m_se", number(s.torque.se)},
      {"torque_closure_N_m", number(s.torque_closure.value)},
      {"torque_external_N_m", number(s.torque_external.value)},
      {"power_W", number(s.power.value)},
      {"power_W_se", number(s.power.se)},
      {"slices", s.slices},
      {"slices_by", name_of(slice_rule(setup.config))},
      {"mill_torque_N_m", number(s.mill_torque.value)},
      {"mill_torque_N_m_se", number(s.mill_torque.se)},
      {"mill_power_W", number(s.mill_power.value)},
      {"mill_power_W_se", number(s.mill_power.se)},
      {"dissipation_W", dissipation},
      {"impacts_per_s", {{"ball_ball", number(s.ball_impacts)}, {"ball_wall", number(s.wall_impacts)}}},
      {"energy_error", number(s.energy_error)},
      {"locked_balls", s.locked_balls},
      {"effects", effects_of(setup.config)},
      {"caveat", run.result().caveat},
  };
  return j.dump(2) + "\n";
}

}  // namespace tumble::cli
