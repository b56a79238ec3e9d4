#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "diagnose/check_parts.h"

// How the drum turns: its mean speed against the clock, and whether it turns evenly.
namespace tumble::diagnose {
namespace {

constexpr int kMostOrder = 36;
constexpr double kLeastTurns = 3;  // for ripples to be told from drift
constexpr double kSetTo = 2e-4;    // relative: nearer than that no mill is set, and no frame rate is known
constexpr double kFinest = 1e-7;   // [rad]: what rounding leaves of an angle that was not measured at all
constexpr double kFewest = 4;      // frames for each number that is fitted

// The mill's angle as the frames tell it, and a straight line with waves of all orders through it.
struct Turning {
  std::vector<double> t, angle;      // t: about the middle
  double start = 0, speed = 0;       // of the line at t = 0 [rad], [rad/s]
  std::vector<double> sine, cosine;  // of the angle's waves [rad], by order from 1; of the line's own angle
  std::vector<double> residual;
  double turns = 0;
};

Turning turning_of(const Measurement& m) {
  Turning d;
  for (const SeenFrame& f : m.frames)
    if (!std::isnan(f.mill_angle)) d.t.push_back(f.time), d.angle.push_back(f.mill_angle);
  const std::size_t n = d.t.size();
  if (n < 8) return {};
  const double middle = 0.5 * (d.t.front() + d.t.back());
  for (double& t : d.t) t -= middle;
  d.turns = std::abs(d.angle.back() - d.angle.front()) / (2 * kPi);
  d.speed = (d.angle.back() - d.angle.front()) / (d.t.back() - d.t.front());
  d.start = 0.5 * (d.angle.front() + d.angle.back());
  const int orders = d.turns >= kLeastTurns && double(n) > kFewest * (2 + 2 * kMostOrder) ? kMostOrder : 0;
  const auto rows = static_cast<Eigen::Index>(n);
  Eigen::MatrixXd basis(rows, 2 + 2 * orders);
  const Eigen::Map<const Eigen::VectorXd> seen(d.angle.data(), rows);
  Eigen::VectorXd found;
  // The waves hang on the line's own angle: once more with the line that they leave.
  for (int round = 0; round < 2; ++round) {
    for (Eigen::Index i = 0; i < rows; ++i) {
      const double t = d.t[static_cast<std::size_t>(i)], turned = d.start + d.speed * t;
      basis(i, 0) = 1;
      basis(i, 1) = t;
      for (int k = 1; k <= orders; ++k) {
        basis(i, 2 * k) = std::sin(k * turned);
        basis(i, 2 * k + 1) = std::cos(k * turned);
      }
    }
    found = (basis.transpose() * basis).ldlt().solve(basis.transpose() * seen);
    d.start = found[0];
    d.speed = found[1];
  }
  for (int k = 1; k <= orders; ++k) {
    d.sine.push_back(found[2 * k]);
    d.cosine.push_back(found[2 * k + 1]);
  }
  const Eigen::VectorXd rest = seen - basis * found;
  d.residual.assign(rest.data(), rest.data() + rows);
  return d;
}

// Of the line's slope, with errors that go on from frame to frame.
double error_of_speed(const Turning& d) {
  std::vector<double> pull;
  double spread = 0;
  for (std::size_t i = 0; i < d.t.size(); ++i) {
    pull.push_back(d.t[i] * d.residual[i]);
    spread += d.t[i] * d.t[i];
  }
  return mean_of_series(pull).se * double(d.t.size()) / spread;
}

// Mean square of a wave's two parts where there is none: of waves beside an order that are no whole number a turn, in
// what is left. `used`: of how many parts.
double ground_beside(const Turning& d, int order, int& used) {
  constexpr double kBeside = 2.5, kLowest = 0.4;  // [1/rev]
  const double step = std::max(1 / d.turns, 0.1);
  double sum = 0;
  used = 0;
  for (double k = order - kBeside; k <= order + kBeside; k += step) {
    if (k < kLowest || std::abs(k - std::round(k)) < 0.5 * step) continue;
    double sine = 0, cosine = 0;
    for (std::size_t i = 0; i < d.t.size(); ++i) {
      const double turned = d.start + d.speed * d.t[i];
      sine += d.residual[i] * std::sin(k * turned);
      cosine += d.residual[i] * std::cos(k * turned);
    }
    const double n = 0.5 * double(d.t.size());
    sum += (sine * sine + cosine * cosine) / (n * n);
    used += 2;
  }
  return sum / used;
}

// x with this share of a normal distribution beyond it.
double normal_beyond(double p) {
  double low = -40, high = 40;
  for (int i = 0; i < 80; ++i) {
    const double middle = 0.5 * (low + high);
    (0.5 * std::erfc(middle / std::sqrt(2.0)) > p ? low : high) = middle;
  }
  return low;
}

std::vector<RippleOrder> orders_of(const Turning& d) {
  std::vector<RippleOrder> orders;
  for (std::size_t i = 0; i < d.sine.size(); ++i) {
    RippleOrder r;
    r.order = static_cast<int>(i) + 1;
    // The angle's wave (a / n) sin(n turned + phase) is the speed's a cos(n turned + phase).
    const double wave = std::hypot(d.sine[i], d.cosine[i]), off = std::atan2(d.cosine[i], d.sine[i]);
    r.amplitude = r.order * wave;
    int used = 0;
    const double ground = ground_beside(d, r.order, used) + kFinest * kFinest;
    r.se = r.order * std::sqrt(ground);
    // As strong by chance: two parts against the mean square of `used` others (F distribution of 2 and `used`).
    r.p = std::pow(1 + wave * wave / ground / used, -0.5 * used);
    // `turned` is counted from the mill angle that a mean speed would have: from the ripple's own start it is
    // a / n sin(phase) farther.
    double phase = off;
    for (int round = 0; round < 50; ++round) phase = off - r.amplitude * std::sin(phase);
    r.phase_deg = wrap_360(degrees(phase));
    orders.push_back(r);
  }
  return orders;
}

void check_ripple(const Measurement& m, const Turning& d, std::vector<ExactCheck>& checks) {
  const std::vector<RippleOrder> orders = orders_of(d);
  if (orders.empty()) return;
  const RippleOrder& r =
      *std::min_element(orders.begin(), orders.end(), [](const auto& a, const auto& b) { return a.p < b.p; });
  // The strongest of many: what matters is how often chance alone makes one as strong.
  const double z = normal_beyond(-std::expm1(double(orders.size()) * std::log1p(-r.p)));
  checks.push_back(make_check(
      m, "speed_ripple", r.amplitude, 0, r.se, "", {{"speed_ripple", 1}},
      {fmt::format("of {} orders, the speed varies most {} times a revolution, by a share of", orders.size(), r.order),
       "no more than the errors of the angle make it", "the drive does not turn evenly"},
      z));
}

}  // namespace

std::vector<RippleOrder> ripple_orders(const Measurement& m) { return orders_of(turning_of(m)); }

void check_drum(const Measurement& m, std::vector<ExactCheck>& checks) {
  const double set = speed_rpm(m.config.mill);
  const Turning d = turning_of(m);
  Estimate rpm;
  if (m.is_film)
    rpm = m.motion.speed_rpm;
  else if (!d.t.empty())
    rpm = {rpm_from_rad_s(d.speed), rpm_from_rad_s(error_of_speed(d))};
  if (rpm.se >= 0 && set > 0)
    checks.push_back(make_check(m, "mill_speed", rpm.value, set, std::hypot(rpm.se, kSetTo * set), "rev/min",
                                {{"speed_error", 1 / set}, {"frame_clock", -1 / set}},
                                {"by the clock of the frames the drum turns at", "as it is set",
                                 "the speed that was set is not the mill's, or the clock is wrong"}));
  check_ripple(m, d, checks);
}

}  // namespace tumble::diagnose
