#include "core/sharp_edge.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tumble {
namespace {

constexpr int kBins = 120;

double normal_above(double x) { return 0.5 * std::erfc(x / std::sqrt(2.0)); }

// Density of (an exponential with mean `length`, above zero) + (a normal with deviation `sigma`).
double blurred_tail(double x, double sigma, double length) {
  const double a = sigma / length, exponent = 0.5 * a * a - x / length;
  return exponent > 60 ? 0.0 : std::exp(exponent) / length * normal_above(a - x / sigma);
}

double normal(double x, double sigma) {
  return std::exp(-0.5 * x * x / (sigma * sigma)) / (sigma * 2.5066282746310002);
}

struct Crowd {
  double edge = 0, sigma = 1, length = 1, at_edge = 0.5, ground = 0.1;
};

class Histogram {
 public:
  Histogram(const std::vector<double>& values, double from, double to, int tail)
      : from_(from), width_((to - from) / kBins), tail_(tail), counts_(kBins, 0.0) {
    for (double v : values)
      if (v > from && v < to) {
        counts_[std::min<std::size_t>(kBins - 1, static_cast<std::size_t>((v - from) / width_))] += 1;
        total_ += 1;
      }
  }
  double total() const { return total_; }

  double log_likelihood(const Crowd& c) const {
    double sum = 0, density = 0;
    std::array<double, kBins> p{};
    for (std::size_t i = 0; i < kBins; ++i) {
      const double x = tail_ * (from_ + (static_cast<double>(i) + 0.5) * width_ - c.edge);
      const double crowd = c.at_edge * normal(x, c.sigma) + (1 - c.at_edge) * blurred_tail(x, c.sigma, c.length);
      p[i] = (1 - c.ground) * crowd * width_ + c.ground / kBins;
      density += p[i];
    }
    for (std::size_t i = 0; i < kBins; ++i)
      if (counts_[i] > 0) sum += counts_[i] * std::log(std::max(1e-12, p[i] / density));
    return sum;
  }

 private:
  double from_, width_;
  int tail_;
  std::vector<double> counts_;
  double total_ = 0;
};

// One number after the other, each by halving steps, round and round: five numbers on a smooth hill.
Crowd climb(const Histogram& histogram, Crowd c, double span) {
  double best = histogram.log_likelihood(c);
  double step = 0.1;
  for (int round = 0; round < 200 && step > 1e-4; ++round) {
    bool better = false;
    for (int k = 0; k < 5; ++k)
      for (const double sign : {1.0, -1.0}) {
        Crowd t = c;
        if (k == 0) t.edge += sign * step * span;
        if (k == 1) t.sigma *= std::exp(sign * 4 * step);
        if (k == 2) t.length *= std::exp(sign * 4 * step);
        if (k == 3) t.at_edge = std::clamp(t.at_edge + sign * step, 0.02, 0.98);
        if (k == 4) t.ground = std::clamp(t.ground + sign * step, 0.001, 0.9);
        t.sigma = std::clamp(t.sigma, 0.002 * span, 0.3 * span);
        t.length = std::clamp(t.length, 0.005 * span, 2 * span);
        const double value = histogram.log_likelihood(t);
        if (value <= best) continue;
        best = value;
        c = t;
        better = true;
        break;
      }
    if (!better) step *= 0.5;
  }
  return c;
}

}  // namespace

Estimate sharp_edge(const std::vector<double>& values, double from, double to, int tail) {
  const Histogram histogram(values, from, to, tail);
  if (histogram.total() < 100) return {};
  const double span = to - from;
  Crowd best;
  double most = -1e300;
  for (const double at : {0.3, 0.5, 0.7}) {
    const Crowd c = climb(histogram, {from + at * span, 0.05 * span, 0.1 * span, 0.5, 0.1}, span);
    const double value = histogram.log_likelihood(c);
    if (value <= most) continue;
    most = value;
    best = c;
  }
  if (best.edge < from + 0.03 * span || best.edge > to - 0.03 * span || best.ground > 0.85) return {};
  // Sightings of one ball in neighbouring frames say the same: taken as one in ten that is new.
  const double fresh = std::max(10.0, 0.1 * histogram.total() * (1 - best.ground));
  return {best.edge, best.sigma / std::sqrt(fresh)};
}

}  // namespace tumble
