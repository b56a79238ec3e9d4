#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/angle.h"
#include "core/effects.h"
#include "core/mill_shape.h"
#include "core/quantile.h"
#include "diagnose/check_parts.h"
#include "diagnose/free_flight.h"
#include "diagnose/lost_balls.h"
#include "diagnose/seen_charge.h"
#include "diagnose/seen_motion.h"

// What acts on balls that touch nothing. Their acceleration is, in the coordinates of the frames,
//
//   a = scale / clock^2 R(roll) g  -  6 pi eta r / m v  -  c g s / |s|  +  [in the pool] (rho g V / m up - 6 pi eta_p r
//   / m v)
//
// with s the slip against the end walls, which turn with the drum: drag, friction of the ends and pool are told from
// each other by what they go with, and so is gravity from them.
namespace tumble::diagnose {
namespace {

constexpr double kHit = 1.6;         // times the usual misfit: something was hit on the way
constexpr std::size_t kFewest = 30;  // windows, for each kind of place
constexpr double kSlowSlip = 0.15;   // [m/s]: below, the slip's direction is not known
constexpr double kFar = 4;           // standard deviations that a window may be off
constexpr double kGentleHits = 1.3;  // on variances: hits too gentle to show (20 runs, 0.3 mm noise: 1.0 to 1.8)
enum Term { kRight, kUp, kViscosity, kEnds, kPoolDensity, kPoolViscosity, kTerms };

struct Row {  // one window's two equations
  Eigen::Matrix<double, 2, kTerms> basis = Eigen::Matrix<double, 2, kTerms>::Zero();
  Eigen::Vector2d a;
  double velocity_error = 0;  // of a velocity [m/s]
  double drag = 0;            // 6 pi r / m
};

struct FlightFit {
  Eigen::VectorXd value;  // of the terms that are looked at
  Eigen::MatrixXd covariance;
  std::vector<int> terms;
  int at(Term t) const {
    const auto it = std::find(terms.begin(), terms.end(), t);
    return it == terms.end() ? -1 : static_cast<int>(it - terms.begin());
  }
};

std::vector<Row> rows_of(const Measurement& m, const std::vector<FreeFall>& windows, std::size_t& in_pool) {
  const double omega = turning_speed(m.frames, m.config);
  const double level = find_parameter(*find_effect("slurry_pool"), "level")->typical * make_mill_shape(m.config).radius;
  std::vector<double> misfits;
  for (const FreeFall& w : windows) misfits.push_back(w.misfit);
  const double noise = median_of(std::move(misfits));
  std::vector<Row> rows;
  in_pool = 0;
  for (const FreeFall& w : windows) {
    const int k = class_of(m.config, w.radius);
    if (k < 0) continue;
    const BallClass& ball = m.config.charge.balls[static_cast<std::size_t>(k)];
    const Eigen::Vector2d v(w.vx, w.vy), slip(w.vx + omega * w.y, w.vy - omega * w.x);
    if (slip.norm() < kSlowSlip) continue;
    Row row;
    row.a << w.ax, w.ay;
    row.drag = 6 * kPi * ball.radius / ball.mass;
    row.velocity_error = w.velocity_error * noise;
    row.basis.col(kRight) << 1, 0;
    row.basis.col(kUp) << 0, 1;
    row.basis.col(kViscosity) = -row.drag * v;
    row.basis.col(kEnds) = -kGravity * slip.normalized();
    if (const double h = std::min(level - (w.y - ball.radius), 2 * ball.radius); h > 0) {  // depth that is immersed
      const double volume = kPi * h * h * (3 * ball.radius - h) / 3, whole = 4.0 / 3 * kPi * std::pow(ball.radius, 3);
      row.basis.col(kPoolDensity) << 0, volume * kGravity / ball.mass;
      row.basis.col(kPoolViscosity) = -row.drag * volume / whole * v;
      ++in_pool;
    }
    rows.push_back(row);
  }
  return rows;
}

// Least squares; the errors of velocities are taken out of the sums that they swell (errors in variables), windows that
// lie far off are left out, and each window's own deviation tells its error.
FlightFit fit(const std::vector<Row>& all, const std::vector<int>& terms) {
  FlightFit f;
  f.terms = terms;
  const auto n = static_cast<Eigen::Index>(terms.size());
  const auto basis_of = [&](const Row& r) {
    Eigen::MatrixXd b(2, n);
    for (Eigen::Index k = 0; k < n; ++k) b.col(k) = r.basis.col(terms[static_cast<std::size_t>(k)]);
    return b;
  };
  std::vector<char> used(all.size(), 1);
  for (int round = 0; round < 4; ++round) {
    Eigen::MatrixXd information = Eigen::MatrixXd::Zero(n, n), spread = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (!used[i]) continue;
      const Eigen::MatrixXd b = basis_of(all[i]);
      information += b.transpose() * b;
      right += b.transpose() * all[i].a;
      for (const Term t : {kViscosity, kPoolViscosity})
        if (const int k = f.at(t); k >= 0 && !b.col(k).isZero())
          information(k, k) -= 2 * std::pow(all[i].drag * all[i].velocity_error, 2);
    }
    const Eigen::MatrixXd inverse = information.inverse();
    f.value = inverse * right;
    std::vector<double> off;
    for (const Row& r : all) off.push_back((r.a - basis_of(r) * f.value).norm());
    // The median of the length of two normal deviations is 1.1774 of one.
    const double sigma = median_of(off) / 1.1774;
    double kept = 0;
    for (std::size_t i = 0; i < all.size(); ++i) {
      used[i] = off[i] < kFar * sigma + 1e-9;
      if (!used[i]) continue;
      const Eigen::VectorXd score = basis_of(all[i]).transpose() * (all[i].a - basis_of(all[i]) * f.value);
      spread += score * score.transpose();
      ++kept;
    }
    f.covariance = kGentleHits * inverse * spread * inverse * (kept / std::max(1.0, kept - double(n) / 2));
  }
  return f;
}

Estimate part(const FlightFit& f, Term t) {
  const int k = f.at(t);
  return k < 0 ? Estimate{} : Estimate{f.value[k], std::sqrt(f.covariance(k, k))};
}

}  // namespace

std::vector<FreeFall> clean_flights(const Measurement& m) {
  FreeFlights flights(make_mill_shape(m.config).tip_radius);
  for (const SeenFrame& f : with_lost_balls(m.frames)) flights.add(f.time, f.balls);
  std::vector<FreeFall> windows = flights.windows();
  std::erase_if(windows, [](const FreeFall& w) { return std::isnan(w.radius); });
  if (windows.empty()) return windows;
  std::vector<double> misfits;
  for (const FreeFall& w : windows) misfits.push_back(w.misfit);
  const double most = kHit * median_of(std::move(misfits)) + 1e-6;
  std::erase_if(windows, [&](const FreeFall& w) { return w.misfit > most; });
  return windows;
}

void check_flights(const Measurement& m, std::vector<ExactCheck>& checks) {
  // What the model itself has act on flying balls would have to be taken off first; it is not known exactly.
  for (const char* own : {"fluid_drag", "slurry_pool", "end_wall_friction"})
    if (has_effect(m.config, own)) return;
  std::size_t in_pool = 0;
  const std::vector<Row> rows = rows_of(m, clean_flights(m), in_pool);
  if (rows.size() < kFewest) return;
  std::vector<int> terms{kRight, kUp, kViscosity, kEnds};
  if (in_pool >= kFewest) terms.insert(terms.end(), {kPoolDensity, kPoolViscosity});
  const FlightFit f = fit(rows, terms);
  const double ax = f.value[0], ay = f.value[1], g = std::hypot(ax, ay);
  const Eigen::Vector2d along(ax / g, ay / g), across(-ay / (g * g), ax / (g * g));
  const Eigen::Matrix2d error = f.covariance.topLeftCorner<2, 2>();
  const std::string of = fmt::format("in {} stretches of free flight, ", rows.size());
  checks.push_back(make_check(
      m, "flight_gravity", g, kGravity, std::sqrt(along.dot(error * along)), "m/s2",
      {{"camera_scale", 1 / kGravity}, {"frame_clock", -0.5 / kGravity}},
      {of + "balls fall with", "scale and clock fit together", "lengths are out of scale, or the clock is wrong"}));
  checks.push_back(make_check(m, "flight_down", degrees(std::atan2(ax, -ay)), 0,
                              degrees(std::sqrt(across.dot(error * across))), "deg", {{"camera_rotation", 1}},
                              {of + "down lies, counter-clockwise of straight down, at", "the camera stands upright",
                               "the camera is turned, or the mill's axis is not level"}));
  const auto check = [&](const char* name, Term t, const char* unit, const char* suspect, const Saying& saying) {
    const Estimate e = part(f, t);
    if (!std::isnan(e.value)) checks.push_back(make_check(m, name, e.value, 0, e.se, unit, {{suspect, 1}}, saying));
  };
  check("flight_drag", kViscosity, "Pa s", "fluid_drag",
        {of + "balls are slowed as by a fluid of viscosity", "no fluid brakes them", "something brakes them"});
  check("flight_ends", kEnds, "", "end_wall_friction",
        {of + "balls are dragged along by the ends with, over their weight,", "the ends do not rub",
         "the ends rub on them"});
  check("flight_pool", kPoolDensity, "kg/m3", "slurry_pool",
        {of + fmt::format("({} of them low in the mill) balls are lifted as by a fluid of density", in_pool),
         "there is no pool", "something lifts them there"});
}

}  // namespace tumble::diagnose
