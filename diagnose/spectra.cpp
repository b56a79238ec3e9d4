#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <unsupported/Eigen/FFT>

#include "core/units.h"
#include "diagnose/sampled.h"

// Power spectra by Welch's method (1967): stretches that overlap by half, Hann's window. Over the stretches the mean is
// taken of the power's logarithm, for power comes in bursts, which would rule a plain mean and its error. Stretches
// that overlap by half under this window are correlated by 3 %, which is left out.
namespace tumble::diagnose {
namespace {

constexpr int kStretches = 16;         // of the shorter series, overlapping
constexpr double kLongestStretch = 8;  // [s]: longer ones would only make the lowest band lower
constexpr double kHighest = 0.4;       // of the lower sampling rate: above, what is faster folds back
constexpr double kBandRatio = 1.4;     // of a band's ends
constexpr int kLeastSamples = 96;

struct Series {
  std::vector<double> value;
  double rate = 0;  // [1/s]
  double span() const { return static_cast<double>(value.size()) / rate; }
};

// Nothing where samples are not even in time, or missing.
Series even(const std::vector<double>& time, std::vector<double> value) {
  Series s;
  if (time.size() < kLeastSamples) return s;
  const double step = (time.back() - time.front()) / static_cast<double>(time.size() - 1);
  if (!(step > 0)) return s;
  for (std::size_t i = 0; i < time.size(); ++i)
    if (!std::isfinite(value[i]) || std::abs(time[i] - time.front() - step * static_cast<double>(i)) > 0.3 * step)
      return s;
  s.rate = 1 / step;
  s.value = std::move(value);
  return s;
}

Series torque_of(const ChargeMotion& m) {
  std::vector<double> t, v;
  for (const TorqueRow& row : m.torque_series) t.push_back(row.time), v.push_back(row.torque);
  return even(t, v);
}

Series head_of(const ChargeMotion& m) {
  std::vector<double> t, v;
  for (const ProfileRow& row : m.profile) t.push_back(row.time), v.push_back(row.head);
  return even(t, v);
}

struct Band {
  int from = 0, to = 0;  // multiples of 1 / stretch, `to` excluded
};

// Of each band, power density [unit^2 s], geometric mean over the stretches, with its error.
std::vector<Estimate> densities(const Series& s, double stretch, const std::vector<Band>& bands) {
  const auto n = static_cast<std::size_t>(std::lround(stretch * s.rate));
  std::vector<double> window(n), part(n);
  double norm = 0;
  for (std::size_t i = 0; i < n; ++i) {
    window[i] = 0.5 - 0.5 * std::cos(2 * kPi * (static_cast<double>(i) + 0.5) / static_cast<double>(n));
    norm += window[i] * window[i];
  }
  Eigen::FFT<double> fft;
  std::vector<std::complex<double>> spectrum;
  std::vector<double> sum(bands.size()), squares(bands.size());
  double stretches = 0;
  for (std::size_t from = 0; from + n <= s.value.size(); from += std::max<std::size_t>(1, n / 2)) {
    double mean = 0;
    for (std::size_t i = 0; i < n; ++i) mean += s.value[from + i] / static_cast<double>(n);
    for (std::size_t i = 0; i < n; ++i) part[i] = window[i] * (s.value[from + i] - mean);
    fft.fwd(spectrum, part);
    for (std::size_t b = 0; b < bands.size(); ++b) {
      double power = 0;
      for (int k = bands[b].from; k < bands[b].to; ++k) power += std::norm(spectrum[static_cast<std::size_t>(k)]);
      power *= 2 / (norm * s.rate * (bands[b].to - bands[b].from));
      const double log_power = std::log(power);
      sum[b] += log_power;
      squares[b] += log_power * log_power;
    }
    stretches += 1;
  }
  std::vector<Estimate> result;
  for (std::size_t b = 0; b < bands.size(); ++b) {
    const double mean = sum[b] / stretches;
    const double variance = std::max(0.0, squares[b] / stretches - mean * mean) / (stretches - 1);
    result.push_back({std::exp(mean), std::exp(mean) * std::sqrt(variance)});
  }
  return result;
}

SampledDifference compare_series(const char* name, const char* unit, const Series& a, const Series& b) {
  SampledDifference d{.name = name, .unit = unit, .x_name = "frequency", .x_unit = "1/s"};
  if (a.value.empty() || b.value.empty()) return d;
  const double stretch = std::min(2 * std::min(a.span(), b.span()) / (kStretches + 1), kLongestStretch);
  const int last = static_cast<int>(kHighest * std::min(a.rate, b.rate) * stretch);
  std::vector<Band> bands;
  for (int from = 2; from < last;) {  // the window mixes the mean into the first
    const int to = std::min(last, std::max(from + 1, static_cast<int>(std::lround(from * kBandRatio))));
    bands.push_back({from, to});
    from = to;
  }
  if (bands.empty()) return d;
  const auto pa = densities(a, stretch, bands), pb = densities(b, stretch, bands);
  for (std::size_t i = 0; i < bands.size(); ++i) {
    d.x.push_back(0.5 * (bands[i].from + bands[i].to - 1) / stretch);
    d.a.push_back(pa[i].value);
    d.a_se.push_back(pa[i].se);
    d.b.push_back(pb[i].value);
    d.b_se.push_back(pb[i].se);
  }
  judge(d, {}, true);
  return d;
}

}  // namespace

std::vector<SampledDifference> compare_spectra(const ChargeMotion& a, const ChargeMotion& b) {
  std::vector<SampledDifference> all{compare_series("torque_spectrum", "(N m)2 s", torque_of(a), torque_of(b)),
                                     compare_series("head_spectrum", "m2 s", head_of(a), head_of(b))};
  std::erase_if(all, [](const SampledDifference& d) { return d.a.empty(); });
  return all;
}

}  // namespace tumble::diagnose
