#include "sim/history.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "core/statistics.h"
#include "core/units.h"

namespace tumble::sim {

void look_for_locked_balls(const RunningMill& mill, LockedBalls& locked) {
  const Charge& c = mill.charge;
  const double angle = mill_angle(mill.model, mill.step);
  if (locked.home.size() != c.size()) {
    locked.home.assign(c.size(), INFINITY);
    locked.since.assign(c.size(), angle);
  }
  const int n = mill.model.shell.lifter_count;
  const double tolerance = std::min(n > 0 ? 2 * kPi / n : kPi, kPi / 6);
  locked.count = 0;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const double in_mill = std::atan2(c.y[i], c.x[i]) - angle;
    const auto number = static_cast<std::size_t>(c.id[i]);
    if (!(std::abs(std::remainder(in_mill - locked.home[number], 2 * kPi)) < tolerance)) {
      locked.home[number] = in_mill;
      locked.since[number] = angle;
    }
    if (angle - locked.since[number] > 2 * kPi) ++locked.count;
  }
}

Steadiness judge(const History& history, std::size_t from, std::size_t to, std::size_t balls, double z_limit) {
  const auto stretch = [&](const std::vector<double>& v) {
    return std::span<const double>(v).subspan(from, to - from);
  };
  const auto mean = [](std::span<const double> v) {
    return v.empty() ? 0.0 : std::accumulate(v.begin(), v.end(), 0.0) / double(v.size());
  };
  Steadiness s;
  s.torque_z = drift_z(stretch(history.torque));
  s.closure_z = drift_z(stretch(history.closure));
  const auto locked = stretch(history.locked);
  if (!locked.empty()) s.locked_change = locked.back() - mean(locked.first((locked.size() + 3) / 4));
  s.steady = std::abs(s.torque_z) < z_limit && std::abs(s.closure_z) < z_limit &&
             std::abs(s.locked_change) < std::max(1.0, 0.01 * double(balls));
  return s;
}

}  // namespace tumble::sim
