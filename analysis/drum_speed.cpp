#include "analysis/drum_speed.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/angle.h"
#include "core/units.h"

namespace tumble::analysis {
namespace {

struct Line {
  double middle = 0, level = 0, slope = 0, spread = 0;  // spread: weighted sum of (time - middle)^2
};

Line fit_line(std::span<const double> time, std::span<const double> y, std::span<const double> weight) {
  Line line;
  double sum = 0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    sum += weight[i];
    line.middle += weight[i] * time[i];
    line.level += weight[i] * y[i];
  }
  if (!(sum > 0)) return line;
  line.middle /= sum;
  line.level /= sum;
  double product = 0;
  for (std::size_t i = 0; i < time.size(); ++i) {
    const double t = time[i] - line.middle;
    line.spread += weight[i] * t * t;
    product += weight[i] * t * (y[i] - line.level);
  }
  if (line.spread > 0) line.slope = product / line.spread;
  return line;
}

// Standard error of the common slope, from how the slopes of the drum's parts scatter (each part a cluster: what errs
// within it errs alike).
double error_between_parts(std::span<const double> time, std::span<const DrumAngle> angles) {
  double spread = 0, squares = 0, parts = 0;
  std::vector<double> turn(angles.size()), say(angles.size());
  for (std::size_t part = 0; part < DrumAngle::kParts; ++part) {
    for (std::size_t i = 0; i < angles.size(); ++i) {
      turn[i] = angles[i].part_turn[part];
      say[i] = angles[i].part_say[part];
    }
    const Line line = fit_line(time, turn, say);
    if (!(line.spread > 0)) continue;
    spread += line.spread;
    squares += line.spread * line.spread * line.slope * line.slope;
    parts += 1;
  }
  return parts > 1 ? std::sqrt(squares * parts / (parts - 1)) / spread : 0.0;
}

// Relative error of the turn by directions that err alike.
double error_of_directions(std::span<const DrumAngle> angles, double alike) {
  constexpr std::size_t kSectors = DrumAngle::kParts;
  constexpr double kWide = 2 * kPi / kSectors;
  std::array<double, kSectors> say{}, shift{};
  for (const DrumAngle& a : angles)
    for (std::size_t part = 0; part < DrumAngle::kParts; ++part) {
      const double direction = wrap_360(degrees((static_cast<double>(part) + 0.5) * kWide + a.angle));
      const std::size_t sector = std::min(kSectors - 1, static_cast<std::size_t>(radians(direction) / kWide));
      say[sector] += a.part_say[part];
      shift[sector] += a.part_say[part] * a.part_turn[part];
    }
  double total = 0, squares = 0, steps = 0;
  for (std::size_t i = 0; i < kSectors; ++i) {
    total += say[i];
    squares += say[i] > 0 ? shift[i] * shift[i] / say[i] : 0.0;
    // The mean slope of the shift over what is seen is its sum over the ends of what is seen.
    steps += std::pow(say[i] - say[(i + 1) % kSectors], 2);
  }
  if (!(total > 0)) return 0;
  const double turns = std::abs(angles.back().angle - angles.front().angle) / (2 * kPi);
  const double again = std::max(1.0, turns * turns);  // a shift that is periodic tilts a line by so much less
  return std::sqrt((alike * alike + squares / total) * steps) / (kWide * total) / again;
}

}  // namespace

Estimate slope_of_series(std::span<const double> time, std::span<const double> y) {
  const std::size_t n = time.size();
  if (n < 3) return {};
  const std::vector<double> even(n, 1.0);
  const Line line = fit_line(time, y, even);
  if (!(line.spread > 0)) return {};
  std::vector<double> rest;
  double squares = 0;
  for (std::size_t i = 0; i < n; ++i) {
    rest.push_back(y[i] - line.level - line.slope * (time[i] - line.middle));
    squares += rest.back() * rest.back() / static_cast<double>(n);
  }
  // Level and slope both take from the residuals what varies slowly; the mean's error knows of the level alone:
  // c T / (n - T) for a variance c and a correlation time T, where c T / (n - 2 T) is right.
  const double of_mean = std::pow(mean_of_series(rest).se, 2), frames = static_cast<double>(n);
  const double time_alike = squares > 0 ? frames * of_mean / (squares + of_mean) : 1.0;
  const double variance = squares * time_alike / std::max(frames - 2 * time_alike, 1.0);
  return {line.slope, std::sqrt(variance * frames / line.spread)};
}

Estimate turn_of_drum(std::span<const double> time, std::span<const DrumAngle> angles, double alike) {
  std::vector<double> times, turned;
  std::vector<DrumAngle> seen;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    if (std::isnan(angles[i].error)) continue;
    times.push_back(time[i]);
    turned.push_back(angles[i].angle);
    seen.push_back(angles[i]);
  }
  Estimate turn = slope_of_series(times, turned);
  if (std::isnan(turn.value)) return turn;
  turn.se = std::hypot(turn.se, error_between_parts(times, seen), turn.value * error_of_directions(seen, alike));
  return turn;
}

}  // namespace tumble::analysis
