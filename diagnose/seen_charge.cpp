#include "diagnose/seen_charge.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace tumble::diagnose {
namespace {

constexpr std::size_t kFewest = 64;  // samples of a torque series, for a balance over the same time
constexpr double kSameTime = 0.04;   // of the duration: clocks may disagree by that and mean the same stretch
constexpr double kReach = 0.008;     // before and after a frame, of velocities [s]: noise of places counts little then

std::vector<double> masses_of(const Config& config, double& mean) {
  const std::vector<int> counts = class_counts(config);
  std::vector<double> masses;
  double balls = 0;
  for (std::size_t k = 0; k < counts.size(); ++k) {
    masses.push_back(config.charge.balls[k].mass);
    balls += counts[k];
  }
  mean = slice_mass(config, counts) / balls;
  return masses;
}

// Sum over the balls in all three frames of mass x (x vy - y vx), and of their masses.
void whirl(const SeenFrame& before, const SeenFrame& here, const SeenFrame& after,
           const std::vector<double>& mass_of_ball, double& sum, double& mass) {
  const double seconds = after.time - before.time;
  std::size_t i = 0, j = 0;
  for (std::size_t k = 0; k < here.balls.size(); ++k) {
    const Sighting& s = here.balls[k];
    while (i < before.balls.size() && before.balls[i].ball < s.ball) ++i;
    while (j < after.balls.size() && after.balls[j].ball < s.ball) ++j;
    if (i == before.balls.size() || j == after.balls.size()) return;
    const Sighting &a = before.balls[i], &b = after.balls[j];
    if (a.ball != s.ball || b.ball != s.ball) continue;
    sum += mass_of_ball[k] * (s.x * (b.y - a.y) - s.y * (b.x - a.x)) / seconds;
    mass += mass_of_ball[k];
  }
}

// Means of what lies in [from, to).
double mean_in(const std::vector<double>& time, const std::vector<double>& value, double from, double to) {
  const auto a = std::lower_bound(time.begin(), time.end(), from) - time.begin();
  const auto b = std::lower_bound(time.begin(), time.end(), to) - time.begin();
  double sum = 0;
  for (auto i = a; i < b; ++i) sum += value[static_cast<std::size_t>(i)];
  return sum / double(b - a);
}

// At a moment: the mean of those around it that are known.
double near(const std::vector<double>& time, const std::vector<double>& value, double at) {
  const auto middle = std::lower_bound(time.begin(), time.end(), at) - time.begin();
  const auto n = static_cast<std::ptrdiff_t>(time.size());
  double sum = 0, known = 0;
  for (std::ptrdiff_t i = std::max<std::ptrdiff_t>(0, middle - 3); i < std::min(n, middle + 3); ++i)
    if (const double v = value[static_cast<std::size_t>(i)]; !std::isnan(v)) sum += v, ++known;
  return sum / known;
}

}  // namespace

int class_of(const Config& config, double radius) {
  int nearest = -1;
  double least = 0;
  for (std::size_t k = 0; k < config.charge.balls.size() && !std::isnan(radius); ++k) {
    const double off = std::abs(config.charge.balls[k].radius - radius);
    if (nearest >= 0 && off >= least) continue;
    nearest = static_cast<int>(k);
    least = off;
  }
  return nearest;
}

SeenCharge see_charge(const Measurement& m) {
  double mean = 0;
  const std::vector<double> masses = masses_of(m.config, mean);
  const double total = slice_mass(m.config, class_counts(m.config));
  SeenCharge seen;
  std::vector<double> mass;
  std::size_t from = 0, to = 0;
  for (std::size_t f = 0; f < m.frames.size(); ++f) {
    const SeenFrame& frame = m.frames[f];
    mass.clear();
    double weight = 0, x = 0, y = 0;
    for (const Sighting& s : frame.balls) {
      const int k = class_of(m.config, s.radius);
      mass.push_back(k < 0 ? mean : masses[static_cast<std::size_t>(k)]);
      weight += mass.back();
      x += mass.back() * s.x;
      y += mass.back() * s.y;
    }
    seen.time.push_back(frame.time);
    seen.balls.push_back(double(frame.balls.size()));
    seen.moment.push_back(total * kGravity * x / weight);
    seen.height.push_back(y / weight);
    while (from < f && frame.time - m.frames[from].time > kReach * 1.001 && from + 1 < f) ++from;
    while (to + 1 < m.frames.size() && m.frames[to].time - frame.time < kReach * 0.999) ++to;
    double sum = 0, known = 0;
    if (from < f && to > f) whirl(m.frames[from], frame, m.frames[to], mass, sum, known);
    seen.angular_momentum.push_back(known > 0 ? sum * total / known : kNotGiven);
  }
  return seen;
}

std::vector<TorqueBlock> torque_blocks(const SeenCharge& charge, const Measurement& m, int blocks) {
  std::vector<double> time, torque;
  for (const TorqueSample& s : m.torque_series) time.push_back(s.time), torque.push_back(s.torque);
  if (time.size() < kFewest || charge.time.empty()) return {};
  const double lasts = charge.time.back() - charge.time.front();
  if (!(std::abs(time.front() - charge.time.front()) < kSameTime * lasts &&
        std::abs(time.back() - charge.time.back()) < kSameTime * lasts))
    return {};
  const double from = std::max(charge.time.front(), time.front()), to = std::min(charge.time.back(), time.back());
  std::vector<TorqueBlock> all;
  for (int b = 0; b < blocks; ++b) {
    const double begin = from + (to - from) * b / blocks, end = from + (to - from) * (b + 1) / blocks;
    const double gained =
        near(charge.time, charge.angular_momentum, end) - near(charge.time, charge.angular_momentum, begin);
    all.push_back(
        {mean_in(time, torque, begin, end), mean_in(charge.time, charge.moment, begin, end) + gained / (end - begin)});
  }
  return all;
}

}  // namespace tumble::diagnose
