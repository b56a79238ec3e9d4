#include "diagnose/seen_charge.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace tumble::diagnose {
namespace {

constexpr double kReach = 0.008;  // before and after a frame, of velocities [s]: noise of places counts little then

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

}  // namespace tumble::diagnose
