#include "analysis/time_base.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/units.h"

namespace tumble::analysis {
namespace {

constexpr double kNominalError = 0.03;     // of a speed that stands on a drawing or a dial
constexpr double kWorstFall = 0.06;        // relative error beyond which flights do not overrule a file
constexpr double kContradiction = 3;       // sigmas
constexpr double kLeastDifference = 0.02;  // nothing smaller is a contradiction: nobody films at 31 frames/s
constexpr double kSlowMotion = 1.4;        // least ratio of rates at which a nominal speed alone overrules a file

// Rates that cameras offer, 1/s. Each also stands for itself x 1000/1001, which no flight can tell apart.
constexpr std::array kCameraRates = {24.0,  25.0,  30.0,  48.0,  50.0,  60.0,  90.0,  100.0, 120.0, 180.0,
                                     200.0, 240.0, 300.0, 400.0, 480.0, 500.0, 600.0, 960.0, 1000.0};

double z_of(const Estimate& a, const Estimate& b) { return (a.value - b.value) / std::hypot(a.se, b.se); }

bool contradicts(double rate, const Estimate& e) {
  return std::abs(rate - e.value) > std::max(kContradiction * e.se, kLeastDifference * e.value);
}

// "119 +- 2", "29.97 +- 0.03": one digit of the error, two from 10 on.
std::string shown(const Estimate& e) {
  const int decimals = std::clamp(-static_cast<int>(std::floor(std::log10(e.se))), 0, 3);
  return fmt::format("{:.{}f} +- {:.{}f}", e.value, decimals, e.se, decimals);
}

// The one camera rate that fits, if no other could be meant. A file of a x 1000/1001 rate tells which kind of clock the
// camera has.
std::optional<double> camera_rate(const Estimate& e, double file_rate) {
  constexpr double kNear = 2, kFar = 4;  // sigmas
  std::optional<double> fits;
  for (const double rate : kCameraRates) {
    const double z = std::abs(rate - e.value) / e.se;
    if (z < kNear && !fits)
      fits = rate;
    else if (z < kFar)
      return {};
  }
  for (const double rate : {24.0, 30.0, 60.0, 120.0})
    if (fits && std::abs(file_rate - rate * 1000 / 1001) < 2e-4 * rate) *fits *= 1000.0 / 1001;
  return fits;
}

// As the camera's own rate where that is clear: a wide error would take in one of them wherever it lay.
Estimate snapped(const Estimate& e, double file_rate) {
  constexpr double kSharp = 0.015;
  const auto rate = e.se < kSharp * e.value ? camera_rate(e, file_rate) : std::nullopt;
  return rate ? Estimate{*rate, 1e-3 * *rate} : e;
}

}  // namespace

TimeBase judge_time_base(const TimeWitnesses& w) {
  TimeBase base;
  const auto say = [&](std::string text) { base.caveats.push_back(std::move(text)); };
  Estimate falling = w.falling_rate;
  falling.se = std::hypot(falling.se, 0.5 * w.scale_error * falling.value);
  const bool falls = falling.se < kWorstFall * falling.value;
  Estimate nominal;
  if (w.turn_per_frame.value > 0 && w.nominal_rpm > 0) {
    nominal.value = rad_s_from_rpm(w.nominal_rpm) / w.turn_per_frame.value;
    const double turn_error = std::isnan(w.turn_per_frame.se) ? 0.0 : w.turn_per_frame.se / w.turn_per_frame.value;
    nominal.se = nominal.value * std::hypot(kNominalError, turn_error);
  }
  const bool turns = !std::isnan(nominal.value);
  const auto rpm_at = [&](double rate) { return rpm_from_rad_s(w.turn_per_frame.value * rate); };
  // For a rate that is used: does the mill turn as its drawing says?
  const auto check_speed = [&](double rate) {
    if (turns && contradicts(rate, nominal))
      say(fmt::format("at {:.4g} frames/s the mill turns at {:.3g} rev/min, while {:.3g} are given for it", rate,
                      rpm_at(rate), w.nominal_rpm));
  };

  if (!std::isnan(w.told_rate)) {
    base.frames_per_second = {w.told_rate, 0.0};
    if (falls && contradicts(w.told_rate, falling))
      say(fmt::format("--recorded-fps {:.4g} is believed, but balls in flight fall as at {} frames/s", w.told_rate,
                      shown(falling)));
    check_speed(w.told_rate);
    return base;
  }

  const bool file = !std::isnan(w.file_rate);
  if (falls) {
    if (file && !contradicts(w.file_rate, falling)) {
      base.frames_per_second = {w.file_rate, 0.0};
      check_speed(w.file_rate);
      return base;
    }
    if (file && turns && !contradicts(w.file_rate, nominal) && std::abs(z_of(falling, nominal)) > kContradiction) {
      // Two against one: hops that never were free fall agree among themselves, file and dial not by chance.
      base.frames_per_second = {w.file_rate, 0.0};
      say(
          fmt::format("balls in flight fall as at {} frames/s, but the file's {:.4g} and the {:.3g} rev/min that are "
                      "given for the mill agree: the file is believed",
                      shown(falling), w.file_rate, w.nominal_rpm));
      return base;
    }
    Estimate best = falling;
    std::string grounds = fmt::format("balls in flight fall as at {}", shown(falling));
    if (turns && std::abs(z_of(falling, nominal)) < kContradiction) {
      const double a = 1 / (falling.se * falling.se), b = 1 / (nominal.se * nominal.se);
      best = {(a * falling.value + b * nominal.value) / (a + b), 1 / std::sqrt(a + b)};
      grounds += fmt::format(", and {:.3g} rev/min would be {}", w.nominal_rpm, shown(nominal));
    }
    base.frames_per_second = snapped(best, w.file_rate);
    const double rate = base.frames_per_second.value;
    if (file)
      say(fmt::format("the file says {:.4g} frames/s; {}: taken as {}, recorded at {:.4g}", w.file_rate, grounds,
                      rate > w.file_rate ? "slow motion" : "time lapse", rate));
    else
      say(fmt::format("{}: taken as recorded at {:.4g} frames/s", grounds, rate));
    check_speed(rate);
    return base;
  }

  if (file) {
    base.frames_per_second = {w.file_rate, kNotGiven};
    const double ratio = turns ? nominal.value / w.file_rate : 1.0;
    if (ratio > kSlowMotion || ratio < 1 / kSlowMotion) {
      // No dial is that wrong. Where no rate of cameras is clearly meant, the dial alone is still the better witness.
      base.frames_per_second = {camera_rate(nominal, w.file_rate).value_or(nominal.value), nominal.se};
      say(fmt::format(
          "the file says {:.4g} frames/s, at which the mill would turn at {:.3g} rev/min instead of the {:.3g} "
          "given for it, and too few balls fly to tell: taken as recorded at {:.4g}; give --recorded-fps",
          w.file_rate, rpm_at(w.file_rate), w.nominal_rpm, base.frames_per_second.value));
      return base;
    }
    // Two witnesses that agree settle it; of two that do not, either may be right.
    if (turns)
      base.frames_per_second.se = contradicts(w.file_rate, nominal) ? std::abs(w.file_rate - nominal.value) : 0;
    say(fmt::format("too few balls fly to check the file's {:.4g} frames/s", w.file_rate));
    check_speed(w.file_rate);
  } else if (turns) {
    base.frames_per_second = nominal;
    say(fmt::format("too few balls fly to tell the frame rate: {} by the {:.3g} rev/min given for the mill",
                    shown(nominal), w.nominal_rpm));
  } else {
    say("the frame rate is not known and cannot be told from flights; give --recorded-fps");
  }
  return base;
}

}  // namespace tumble::analysis
