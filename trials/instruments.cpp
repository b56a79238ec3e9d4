#include "trials/instruments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>
#include <ostream>
#include <utility>

#include "core/angle.h"
#include "core/units.h"

namespace tumble::trials {
namespace {

constexpr double kLoss = 0.002;         // chance that a ball is lost, at every frame
constexpr std::uint64_t kLongest = 10;  // frames that it is away, at most
constexpr int kForgotten = 3;           // away for longer, it comes back with a new number

// Digits beyond a third of the noise say nothing.
int decimals_for(double noise) {
  return noise > 0 ? std::clamp(static_cast<int>(std::ceil(-std::log10(noise / 3))), 3, 8) : 8;
}

}  // namespace

Frame as_seen(Frame f, const diagnose::Observer& o) {
  const double c = std::cos(o.rotation) * (1 + o.scale), s = std::sin(o.rotation) * (1 + o.scale);
  const auto turn = [&](std::vector<double>& x, std::vector<double>& y) {
    for (std::size_t i = 0; i < x.size(); ++i)
      std::tie(x[i], y[i]) = std::pair(c * x[i] - s * y[i], s * x[i] + c * y[i]);
  };
  turn(f.x, f.y);
  turn(f.vx, f.vy);
  for (double& a : f.angle) a += o.rotation;
  f.mill_angle += o.rotation;
  return f;
}

Tracker::Tracker(std::ostream& out, double rate, std::vector<double> radius, const TrackingErrors& errors,
                 std::uint64_t seed)
    : out_(&out),
      rate_(rate),
      radius_(std::move(radius)),
      errors_(errors),
      random_(seed),
      decimals_(decimals_for(errors.place)) {
  *out_ << "frame,time_s,id,x_m,y_m,spin_rad_s,mill_angle_deg" << (radius_.empty() ? "\n" : ",radius_m\n");
}

void Tracker::add(const Frame& frame) {
  const std::size_t n = frame.x.size();
  if (frames_ == 0) {  // numbers in the order in which a program happens upon the balls
    turned_before_ = 2 * kPi * std::floor(frame.mill_angle / (2 * kPi));
    id_.resize(n);
    std::iota(id_.begin(), id_.end(), 0);
    for (std::size_t i = n; i > 1; --i) std::swap(id_[i - 1], id_[random_.below(i)]);
    next_id_ = static_cast<int>(n);
    away_.assign(n, 0);
    back_in_.assign(n, 0);
  }
  std::vector<Row> rows(n);
  for (std::size_t i = 0; i < n; ++i) {
    if (back_in_[i] == 0 && random_.uniform() < kLoss) back_in_[i] = 1 + static_cast<int>(random_.below(kLongest));
    if (back_in_[i] > 0) {
      ++away_[i];
      if (--back_in_[i] > 0) continue;
      if (std::exchange(away_[i], 0) > kForgotten) id_[i] = next_id_++;
      continue;
    }
    rows[i] = {id_[i], frame.x[i] + errors_.place * gaussian(random_), frame.y[i] + errors_.place * gaussian(random_),
               frame.angle[i] + errors_.angle * gaussian(random_)};
  }
  if (!window_.empty()) write(window_.size() > 1 ? &window_[0] : nullptr, window_.back(), &rows, mill_angle_);
  if (window_.size() > 1) window_.erase(window_.begin());
  window_.push_back(std::move(rows));
  mill_angle_ = frame.mill_angle - turned_before_ + errors_.mill_angle * gaussian(random_);
  ++frames_;
}

void Tracker::finish() {
  if (!window_.empty()) write(nullptr, window_.back(), nullptr, mill_angle_);
}

void Tracker::write(const std::vector<Row>* before, const std::vector<Row>& now, const std::vector<Row>* after,
                    double mill_angle) {
  fmt::memory_buffer text;
  auto to = std::back_inserter(text);
  const double time = double(written_) / rate_;
  for (std::size_t i = 0; i < now.size(); ++i) {
    const Row& row = now[i];
    if (row.id < 0) continue;
    fmt::format_to(to, "{},{:.8g},{},{:.{}f},{:.{}f},", written_, time, row.id, row.x, decimals_, row.y, decimals_);
    if (before && after && (*before)[i].id == row.id && (*after)[i].id == row.id)
      fmt::format_to(to, "{:.1f}", ((*after)[i].angle - (*before)[i].angle) * rate_ / 2);
    fmt::format_to(to, ",{:.2f}", degrees(mill_angle));
    if (!radius_.empty()) fmt::format_to(to, ",{:.5f}", radius_[i] + errors_.radius * gaussian(random_));
    fmt::format_to(to, "\n");
  }
  out_->write(text.data(), static_cast<std::streamsize>(text.size()));
  ++written_;
}

void TorqueMeter::add(const Frame& frame) {
  const double last = time_.empty() ? frame.time : time_.back();
  impulse_.push_back((impulse_.empty() ? 0 : impulse_.back()) + frame.observed.torque * (frame.time - last));
  if (time_.empty()) first_ = frame.observed.torque;  // of the interval that ends with the first frame
  time_.push_back(frame.time);
}

double TorqueMeter::impulse_at(double time) const {
  if (time <= time_.front()) return first_ * (time - time_.front());
  const auto next = std::min(
      static_cast<std::size_t>(std::upper_bound(time_.begin(), time_.end(), time) - time_.begin()), time_.size() - 1);
  const double slope = (impulse_[next] - impulse_[next - 1]) / (time_[next] - time_[next - 1]);
  return impulse_[next - 1] + slope * (time - time_[next - 1]);
}

double TorqueMeter::mean(double seconds) const { return impulse_at(seconds) / seconds; }

std::vector<double> TorqueMeter::series(double rate, std::size_t samples) const {
  std::vector<double> means(samples);
  for (std::size_t i = 0; i < samples; ++i)
    means[i] = (impulse_at(double(i) / rate) - impulse_at((double(i) - 1) / rate)) * rate;
  return means;
}

}  // namespace tumble::trials
