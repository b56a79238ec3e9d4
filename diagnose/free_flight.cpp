#include "diagnose/free_flight.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace tumble::diagnose {
namespace {

constexpr double kClearance = 0.15;  // of the radii: farther than tracking errs
constexpr double kWindow = 0.045;    // [s]: long enough for an acceleration, short beside a flight
constexpr int kLeastFrames = 5;
constexpr std::size_t kLeastWindows = 12;

}  // namespace

FreeFlights::FreeFlights(double tip_radius) : tip_radius_(tip_radius) {}

void FreeFlights::add(double time, std::span<const Sighting> balls) {
  std::vector<const Sighting*> by_x;
  for (const Sighting& s : balls) by_x.push_back(&s);
  std::sort(by_x.begin(), by_x.end(), [](const auto* a, const auto* b) { return a->x < b->x; });
  double widest = 0;
  for (const Sighting& s : balls) widest = std::max(widest, s.radius);
  std::vector<char> touched(by_x.size(), 0);
  for (std::size_t i = 0; i < by_x.size(); ++i) {
    const Sighting& a = *by_x[i];
    if (std::sqrt(a.x * a.x + a.y * a.y) + (1 + kClearance) * a.radius > tip_radius_) touched[i] = 1;
    for (std::size_t j = i + 1; j < by_x.size(); ++j) {
      const Sighting& b = *by_x[j];
      if (b.x - a.x > (1 + kClearance) * (a.radius + widest)) break;
      const double dx = b.x - a.x, dy = b.y - a.y, clear = (1 + kClearance) * (a.radius + b.radius);
      if (dx * dx + dy * dy < clear * clear) touched[i] = touched[j] = 1;
    }
  }
  std::map<int, Window> going_on;
  for (std::size_t i = 0; i < by_x.size(); ++i) {
    const Sighting& s = *by_x[i];
    if (touched[i] || s.guessed) continue;
    Window w;
    if (const auto before = open_.find(s.ball); before != open_.end() && time - before->second.t.back() < kWindow / 2)
      w = std::move(before->second);
    w.radius = s.radius;
    w.t.push_back(time);
    w.x.push_back(s.x);
    w.y.push_back(s.y);
    if (w.t.back() - w.t.front() >= kWindow && static_cast<int>(w.t.size()) >= kLeastFrames) {
      use(w);
      continue;  // the next begins afresh: two that share a place would share its error
    }
    going_on[s.ball] = std::move(w);
  }
  open_ = std::move(going_on);
}

void FreeFlights::use(const Window& w) {
  const auto n = static_cast<Eigen::Index>(w.t.size());
  const double middle = 0.5 * (w.t.front() + w.t.back());
  Eigen::MatrixXd basis(n, 3);
  Eigen::MatrixXd place(n, 2);
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i);
    const double t = w.t[k] - middle;
    basis.row(i) << 1, t, t * t / 2;
    place.row(i) << w.x[k], w.y[k];
  }
  const Eigen::MatrixXd information = basis.transpose() * basis;
  const Eigen::MatrixXd fit = information.ldlt().solve(basis.transpose() * place);
  const double misfit = std::sqrt((place - basis * fit).squaredNorm() / double(2 * (n - 3)));
  windows_.push_back({middle, fit(0, 0), fit(0, 1), fit(1, 0), fit(1, 1), fit(2, 0), fit(2, 1), w.radius, misfit,
                      std::sqrt(information.inverse()(1, 1))});
}

void FreeFlights::finish(const ObservationLayout& layout, const Observer& observer, Observation& into) const {
  into.value.resize(layout.size(), kNotGiven);
  into.noise.resize(layout.size(), 0);
  if (windows_.size() < kLeastWindows) return;
  const auto n = static_cast<Eigen::Index>(windows_.size());
  const std::size_t first = layout.first(Observable::kFlight);
  const double longer = 1 + observer.scale, slower = 1 + observer.clock, c = std::cos(observer.rotation),
               s = std::sin(observer.rotation);
  const auto seen = [&](double x, double y, int axis) { return (axis == 0 ? c * x - s * y : s * x + c * y) * longer; };
  for (int axis = 0; axis < 2; ++axis) {
    Eigen::MatrixXd basis(n, 2);
    Eigen::VectorXd acceleration(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const FreeFall& w = windows_[static_cast<std::size_t>(i)];
      basis.row(i) << 1, seen(w.vx, w.vy, axis) / slower;
      acceleration[i] = seen(w.ax, w.ay, axis) / (slower * slower);
    }
    const Eigen::MatrixXd information = basis.transpose() * basis;
    const Eigen::Vector2d fit = information.ldlt().solve(basis.transpose() * acceleration);
    const double variance = (acceleration - basis * fit).squaredNorm() / double(n - 2);
    const Eigen::Matrix2d covariance = variance * information.inverse();
    for (int k = 0; k < 2; ++k) {
      const std::size_t at = first + static_cast<std::size_t>(2 * k + axis);
      into.value[at] = fit[k];
      into.noise[at] = std::sqrt(covariance(k, k));
    }
  }
}

}  // namespace tumble::diagnose
