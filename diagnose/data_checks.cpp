#include "diagnose/data_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/error.h"
#include "core/mill_shape.h"
#include "core/quantile.h"
#include "diagnose/check_parts.h"
#include "diagnose/seen_charge.h"
#include "diagnose/seen_motion.h"

namespace tumble::diagnose {
namespace {

// What no suspect does: twice what is looked for (suspects.cpp), or more.
constexpr double kLength = 0.1, kSpeed = 0.08, kBalls = 0.2, kGravityOff = 0.3, kTurnedDeg = 12;
// Of the torque, by which it may miss what the charge's weight takes: as a mean (what else lies in a mill takes torque
// and gives none), and as a series that does not follow the charge. One that does is this charge's, whatever else
// takes torque (a pool, a fluid, a magnet).
constexpr double kLess = 0.25, kMore = 0.5, kMost = 1, kClosureOfStranger = 0.08;
constexpr double kFollows = 0.8;  // correlation of one run's, or more; of two runs' 0.5 or less: they share the lifters
constexpr double kSurely = 2.5;   // standard errors
constexpr double kBlocks = 6;     // a revolution: a clock that errs moves them little against each other
constexpr double kLeastShare = 0.01, kMostShare = 1.0;  // of M g R: torques that a charge can need
constexpr double kUnit = 30;                            // a factor as large is another unit
constexpr std::size_t kFewestFrames = 8, kFewestFlights = 40, kFewestBlocks = 6;

// "; are these ms?" where a factor of a thousand would set it right.
std::string unit_hint(double factor, const char* smaller, const char* larger) {
  if (factor > kUnit) return fmt::format(" ({:.3g} times too large: as if given in {})", factor, smaller);
  if (factor < 1 / kUnit) return fmt::format(" ({:.3g} times too small: as if given in {})", 1 / factor, larger);
  return "";
}

void check_lengths(const Measurement& m, const MillShape& shape) {
  std::vector<double> reach;
  double mean = 0, balls = 0;
  for (const SeenFrame& f : m.frames)
    for (const Sighting& s : f.balls) reach.push_back(std::hypot(s.x, s.y));
  const std::vector<int> counts = class_counts(m.config);
  for (std::size_t k = 0; k < counts.size(); ++k) {
    mean += counts[k] * m.config.charge.balls[k].radius;
    balls += counts[k];
  }
  const double most = shape.radius - mean / balls, far = quantile_of(std::move(reach), 0.99);
  if (std::abs(far / most - 1) > kLength)
    throw InputError(
        m.frames_file,
        fmt::format("balls come as far as {:.4g} m from the mill's axis, in MILL.toml's mill of radius "
                    "{:.4g} m it must be {:.4g} m{}; give x_m and y_m in metres about the axis, of this mill",
                    far, shape.radius, most, unit_hint(far / most, "mm", "km")));
}

// Angular speed of the balls nearest to the shell, which ride on it.
double carried_speed(const Measurement& m, const MillShape& shape) {
  std::vector<double> rates;
  for (std::size_t i = 1; i < m.frames.size(); ++i) {
    const SeenFrame &a = m.frames[i - 1], &b = m.frames[i];
    for (std::size_t j = 0, k = 0; j < a.balls.size() && k < b.balls.size();) {
      const Sighting &p = a.balls[j], &q = b.balls[k];
      j += p.ball <= q.ball;
      k += q.ball <= p.ball;
      if (p.ball != q.ball || std::hypot(q.x, q.y) < 0.85 * shape.radius) continue;
      rates.push_back((p.x * q.y - p.y * q.x) / (q.x * q.x + q.y * q.y) / (b.time - a.time));
    }
  }
  return rates.size() < 100 ? kNotGiven : median_of(std::move(rates));
}

void check_times(const Measurement& m, const MillShape& shape) {
  const double set = speed_rpm(m.config.mill);
  const bool told = !std::isnan(m.frames.front().mill_angle + m.frames.back().mill_angle);
  const double carried = rpm_from_rad_s(carried_speed(m, shape));
  const double seen = told ? rpm_from_rad_s(turning_speed(m.frames, m.config)) : carried;
  if (std::isnan(seen) || !(set > 0)) return;
  if (seen < 0 || carried < -kSpeed * set)
    throw InputError(
        m.frames_file,
        fmt::format(
            "{} turn{} clockwise, by {:.4g} rev/min; mirror the data (x_m -> -x_m, angles -> 180 - angle), so that "
            "the mill turns counter-clockwise",
            seen < 0 && told ? "the mill" : "the balls", seen < 0 && told ? "s" : "", std::min(seen, carried)));
  // Balls that ride on the shell slip: they tell the unit of time, and no more.
  const double ratio = seen / set, most = told ? 1 + kSpeed : 4, least = told ? 1 - kSpeed : 0.2;
  if (ratio > least && ratio < most) return;
  throw InputError(m.frames_file, fmt::format("{} at {:.4g} rev/min, MILL.toml and set have {:.4g}{}; give time_s in "
                                              "seconds, and the frames of the experiment's own speed",
                                              told ? "the mill turns" : "balls at the shell go round", seen, set,
                                              unit_hint(1 / ratio, "ms", "ks")));
}

void check_down(const Measurement& m) {
  const std::vector<FreeFall> windows = clean_flights(m);
  if (windows.size() < kFewestFlights) return;
  std::vector<double> ax, ay;
  for (const FreeFall& w : windows) ax.push_back(w.ax), ay.push_back(w.ay);
  const double x = median_of(std::move(ax)), y = median_of(std::move(ay)), g = std::hypot(x, y);
  const double turned = degrees(std::atan2(x, -y));
  if (std::abs(turned) > kTurnedDeg)
    throw InputError(
        m.frames_file,
        fmt::format("balls fall {:.0f} degrees counter-clockwise of straight down; give y_m upwards, x_m to the right",
                    turned));
  if (std::abs(g / kGravity - 1) > kGravityOff)
    throw InputError(
        m.frames_file,
        fmt::format(
            "balls in flight fall with {:.3g} m/s2 instead of {:.3g}; give x_m and y_m in metres and time_s in seconds",
            g, kGravity));
}

void check_charge(const Measurement& m, const MillShape& shape) {
  if (m.is_film) {
    const int seen = m.motion.lifters_seen, drawn = shape.lifter_count;
    // Every second lifter alike is seen as half as many.
    if (seen > 0 && drawn > 0 && seen % drawn != 0 && drawn % seen != 0)
      throw InputError(
          m.frames_file,
          fmt::format(
              "the film's drum repeats {} times a turn, which MILL.toml's mill.lifters.count = {} does not; give "
              "the film of this mill, or its number of lifters",
              seen, drawn));
    if (slice_rule(m.config) == SliceRule::kWeight) return;  // the foremost layer of several
  }
  std::vector<double> counts;
  for (const SeenFrame& f : m.frames) counts.push_back(double(f.balls.size()));
  double expected = 0;
  for (const int n : class_counts(m.config)) expected += n;
  const double seen = median_of(std::move(counts));
  if (std::abs(seen / expected - 1) > kBalls)
    throw InputError(
        m.frames_file,
        fmt::format(
            "shows {:.0f} balls where MILL.toml and set have {:.0f}; give all balls of this experiment's charge, "
            "or its charge.count",
            seen, expected));
}

double correlation(const std::vector<TorqueBlock>& blocks) {
  const double n = double(blocks.size());
  double read = 0, needed = 0, both = 0, read2 = 0, needed2 = 0;
  for (const TorqueBlock& b : blocks) read += b.read / n, needed += b.needed / n;
  for (const TorqueBlock& b : blocks) {
    both += (b.read - read) * (b.needed - needed);
    read2 += (b.read - read) * (b.read - read);
    needed2 += (b.needed - needed) * (b.needed - needed);
  }
  return both / std::sqrt(read2 * needed2);
}

void check_torque(const Measurement& m, const MillShape& shape) {
  if (std::isnan(m.torque.value)) return;
  const double slices = slice_count(m.config), weight = slice_mass(m.config, class_counts(m.config)) * kGravity;
  const double share = m.torque.value / (weight * shape.radius);
  const auto place = m.experiment.place;
  if (!(share > kLeastShare && share < kMostShare))
    throw InputError(
        place, fmt::format("the torque is {:.4g} N m (power over speed, where power is given), the charge weighs "
                           "{:.4g} N in a mill of radius {:.4g} m, "
                           "so it must lie between {:.3g} and {:.3g} N m; give the whole mill's, in N m or W",
                           m.torque.value * slices, weight * slices, shape.radius,
                           kLeastShare * weight * shape.radius * slices, kMostShare * weight * shape.radius * slices));
  if (m.frames.size() < kFewestFrames || m.revolutions < 1 || (m.is_film && slice_rule(m.config) == SliceRule::kWeight))
    return;
  const SeenCharge charge = see_charge(m);
  const double held = mean_of_series(charge.moment).value;
  const double off = m.torque.value / held - 1;
  const std::string missed =
      fmt::format("the torque is {:.4g} N m, but to hold the charge where {} shows it takes {:.4g} N m ({:+.0f} %)",
                  m.torque.value * slices, m.frames_file, held * slices, 100 * off);
  const auto blocks = torque_blocks(charge, m, static_cast<int>(kBlocks * m.revolutions));
  const bool series = blocks.size() >= kFewestBlocks;
  if (off < -kLess || off > (series ? kMost : kMore))
    throw InputError(place, missed + "; give torque and frames of the same experiment");
  if (!series) return;
  // Fisher's z, whose standard error depends on the number alone.
  const double follows = correlation(blocks), error = 1 / std::sqrt(double(blocks.size()) - 3);
  if (std::atanh(kFollows) - std::atanh(follows) > kSurely * error && std::abs(off) > kClosureOfStranger)
    throw InputError(place,
                     fmt::format("{}, and the torque series does not follow that charge (correlation {:.2f}); give "
                                 "torque and frames of the same experiment",
                                 missed, follows));
}

}  // namespace

void check_data(const Measurement& m) {
  const MillShape shape = make_mill_shape(m.config);
  if (m.frames.size() >= kFewestFrames) {
    check_lengths(m, shape);
    check_times(m, shape);
    check_down(m);
    check_charge(m, shape);
  }
  check_torque(m, shape);
}

}  // namespace tumble::diagnose
