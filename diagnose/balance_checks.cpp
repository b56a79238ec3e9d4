#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.h"
#include "diagnose/check_parts.h"
#include "diagnose/seen_charge.h"
#include "diagnose/seen_motion.h"

// Torque against the charge's weight: T = M g x_com + dL/dt, L the charge's angular momentum. Contacts, whatever their
// law, are within the charge or are the torque itself, so they leave this at zero.
namespace tumble::diagnose {
namespace {

constexpr std::size_t kFewest = 64;   // frames
constexpr double kInstrument = 5e-4;  // of the torque

struct Balance {
  double off = kNotGiven, se = kNotGiven;  // T - M g x_com - dL/dt [N m]
};

// Over the same stretch of time the two are equal but for what the instruments err. Noise of the torque goes with the
// number of blocks, noise of L, which ends one block and begins the next, with its square: two ways to cut the time
// tell them apart.
Balance balance_over(const SeenCharge& charge, const Measurement& m) {
  const auto residuals = [&](int blocks) {
    std::vector<double> off;
    for (const TorqueBlock& b : torque_blocks(charge, m, blocks)) off.push_back(b.read - b.needed);
    return off;
  };
  constexpr int kFew = 12, kMany = 48;
  const auto variance = [](const std::vector<double>& x) {
    double mean = 0, sum = 0;
    for (const double v : x) mean += v / double(x.size());
    for (const double v : x) sum += (v - mean) * (v - mean);
    return sum / double(x.size() - 1);
  };
  const double few = variance(residuals(kFew)), many = variance(residuals(kMany));
  const double by_square = std::max(0.0, (many / kMany - few / kFew) / (kMany - kFew));
  const double by_number = std::max(0.0, few / kFew - by_square * kFew);
  return {residuals(1).front(), std::sqrt(by_number + by_square)};
}

}  // namespace

void check_balance(const Measurement& m, std::vector<ExactCheck>& checks) {
  const double omega = turning_speed(m.frames, m.config);
  const bool in_view = !m.frames.empty() && (!m.is_film || slice_rule(m.config) != SliceRule::kWeight);
  if (in_view && m.frames.size() >= kFewest && m.torque.value > 0 && m.torque.se >= 0) {
    const SeenCharge charge = see_charge(m);
    const Estimate weight = mean_of_series(charge.moment);
    const double height = mean_of_series(charge.height).value;
    const bool together = !torque_blocks(charge, m, 1).empty();
    Balance balance{m.torque.value - weight.value, std::hypot(m.torque.se, weight.se)};
    if (together) balance = balance_over(charge, m);
    balance.se = std::hypot(balance.se, m.torque_error, kInstrument * m.torque.value);
    const double mass_gravity = slice_mass(m.config, class_counts(m.config)) * kGravity;
    const std::vector<MovedBy> by{{"torque_offset", 1 / m.torque.value},
                                  {"camera_rotation", 180 / kPi / (mass_gravity * height)},
                                  {"camera_scale", -1 / weight.value},
                                  {"filling_error", 1 / weight.value},
                                  {"fluid_drag"},
                                  {"slurry_pool"}};
    checks.push_back(make_check(
        m, "torque_closure", weight.value + balance.off, weight.value, balance.se, "N m", by,
        {together ? "with what the charge gains in angular momentum taken off, the torque is" : "the torque is",
         "it holds the charge's weight", "it does not hold the charge's weight where the frames show it"}));
  }
  // Power is read by another instrument than a torque series.
  const Estimate& power = m.experiment.power;
  if (m.torque_series.empty() || std::isnan(power.value) || std::isnan(power.se)) return;
  std::vector<double> torque;
  for (const TorqueSample& s : m.torque_series) torque.push_back(s.torque);
  const Estimate mean = mean_of_series(torque);
  const double slices = slice_count(m.config), by_torque = mean.value * omega * slices;
  checks.push_back(make_check(
      m, "power_balance", power.value, by_torque,
      std::hypot(power.se, mean.se * omega * slices, kInstrument * by_torque), "W",
      {{"torque_offset", -1 / by_torque}, {"speed_error", 1 / by_torque}},
      {"the power is, by torque and speed,", "the instruments agree", "the instruments contradict each other"}));
}

}  // namespace tumble::diagnose
