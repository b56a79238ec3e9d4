#include "analysis/drum_motion.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "core/config.h"
#include "core/units.h"

namespace tumble::analysis {
namespace {

using Complex = std::complex<double>;
using Spectrum = std::vector<Complex>;  // orders 0 .. kOrders

constexpr int kOrders = 120;       // finest detail: 3 degrees
constexpr int kSamplesAcross = 4;  // of an annulus

std::vector<Spectrum> spectra(const cv::Mat& rows) {
  cv::Mat f;
  cv::dft(rows, f, cv::DFT_ROWS | cv::DFT_COMPLEX_OUTPUT);
  std::vector<Spectrum> result(static_cast<std::size_t>(rows.rows), Spectrum(kOrders + 1));
  for (int a = 0; a < rows.rows; ++a)
    for (int m = 0; m <= kOrders; ++m) {
      const auto& c = f.at<cv::Vec2f>(a, m);
      result[a][m] = Complex(c[0], c[1]) / static_cast<double>(DrumStrip::kAngles);
    }
  return result;
}

// Value of sum_m Re(s[m] exp(i m delta)): how well two patterns match when one is turned by delta.
double match(const Spectrum& s, double delta) {
  double sum = 0;
  const Complex turn = std::polar(1.0, delta);
  Complex power = 1;
  for (std::size_t m = 1; m < s.size(); ++m) {
    power *= turn;
    sum += (s[m] * power).real();
  }
  return sum;
}

double best_match(const Spectrum& s, double middle, double reach) {
  const double step = kPi / kOrders / 4;  // a quarter of the finest half period
  double best = middle, most = -1e300;
  const int n = static_cast<int>(std::ceil(reach / step));
  for (int k = -n; k <= n; ++k) {
    const double value = match(s, middle + k * step);
    if (value > most) {
      most = value;
      best = middle + k * step;
    }
  }
  const double l = match(s, best - step), h = match(s, best + step), curve = l - 2 * most + h;
  return curve < 0 ? best + std::clamp(0.5 * (l - h) / curve, -1.0, 1.0) * step : best;
}

}  // namespace

DrumUnroller::DrumUnroller(const Circle& centre, double inner, double outer, cv::Size picture) {
  const int rows = DrumStrip::kAnnuli * kSamplesAcross;
  map_u_.create(rows, DrumStrip::kAngles, CV_32F);
  map_v_.create(rows, DrumStrip::kAngles, CV_32F);
  for (int r = 0; r < rows; ++r) {
    const double radius = inner + (outer - inner) * (r + 0.5) / rows;
    for (int k = 0; k < DrumStrip::kAngles; ++k) {
      const double a = 2 * kPi * k / DrumStrip::kAngles;
      map_u_.at<float>(r, k) =
          static_cast<float>(std::clamp(centre.u + radius * std::cos(a), 0.0, picture.width - 1.0));
      map_v_.at<float>(r, k) =
          static_cast<float>(std::clamp(centre.v - radius * std::sin(a), 0.0, picture.height - 1.0));
    }
  }
}

DrumStrip DrumUnroller::operator()(const cv::Mat& bgr) const {
  cv::Mat fine, grey;
  cv::remap(bgr, fine, map_u_, map_v_, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::cvtColor(fine, grey, cv::COLOR_BGR2GRAY);
  DrumStrip strip;
  strip.rows.create(DrumStrip::kAnnuli, DrumStrip::kAngles, CV_32F);
  for (int a = 0; a < DrumStrip::kAnnuli; ++a)
    cv::reduce(grey.rowRange(a * kSamplesAcross, (a + 1) * kSamplesAcross), strip.rows.row(a), 0, cv::REDUCE_AVG,
               CV_32F);
  return strip;
}

DrumPattern learn_drum(const std::vector<DrumStrip>& strips, int known_lifters, double expected_step) {
  DrumPattern pattern;
  const std::size_t n = strips.size();
  if (n < 3) return pattern;
  pattern.still = cv::Mat::zeros(strips[0].rows.size(), CV_32F);
  for (const DrumStrip& s : strips) pattern.still += s.rows;
  pattern.still /= static_cast<double>(n);
  std::vector<std::vector<Spectrum>> f;
  for (const DrumStrip& s : strips) f.push_back(spectra(s.rows - pattern.still));
  const std::size_t annuli = f[0].size();

  // Turn from frame to frame, then over longer and longer gaps, each within what the last one left open.
  const auto cross = [&](std::size_t lag) {
    Spectrum s(kOrders + 1);
    for (std::size_t a = 0; a < annuli; ++a) {
      double power = 1e-9;
      Spectrum here(kOrders + 1);
      for (std::size_t t = 0; t + lag < n; ++t)
        for (int m = 1; m <= kOrders; ++m) {
          here[m] += f[t][a][m] * std::conj(f[t + lag][a][m]);
          power += std::norm(f[t][a][m]);
        }
      for (int m = 1; m <= kOrders; ++m) s[m] += here[m] / power;  // annuli of equal say
    }
    return s;
  };
  // F(t + lag) = F(t) exp(-i m delta) for a pattern turned by delta: match() peaks at -(-delta).
  double step;
  if (std::isnan(expected_step)) {
    const Spectrum s = cross(1);
    // Strictly periodic patterns match at any whole number of spacings: of near equals take the slowest turn.
    const double fine = kPi / kOrders / 2;
    double most = 0;
    for (double d = 0; d < kPi; d += fine) most = std::max({most, match(s, -d), match(s, d)});
    step = kNotGiven;
    for (double d = 0; d < kPi && std::isnan(step); d += fine)
      for (double signed_d : {d, -d}) {
        const double value = match(s, -signed_d);
        if (value > 0.8 * most && value >= match(s, -signed_d - fine) && value >= match(s, -signed_d + fine)) {
          step = signed_d;
          break;
        }
      }
    if (std::isnan(step)) return pattern;
    step = -best_match(s, -step, fine);
  } else {
    step = -best_match(cross(1), -expected_step, std::abs(expected_step) * 0.1 + 0.005);
  }
  for (std::size_t lag = 2; lag <= n / 2; lag *= 2) {
    const double reach = kPi / kOrders * 1.5;
    step = -best_match(cross(lag), -step * static_cast<double>(lag), reach) / static_cast<double>(lag);
  }
  pattern.step = step;

  // The co-turning mean keeps the drum and washes out the charge.
  pattern.harmonics.assign(annuli, Spectrum(kOrders + 1));
  double coherent = 0, all = 1e-12;
  for (std::size_t a = 0; a < annuli; ++a) {
    for (int m = 1; m <= kOrders; ++m) {
      Complex sum = 0;
      for (std::size_t t = 0; t < n; ++t) {
        sum += f[t][a][m] * std::polar(1.0, m * step * static_cast<double>(t));
        all += std::norm(f[t][a][m]) / static_cast<double>(n);
      }
      pattern.harmonics[a][m] = sum / static_cast<double>(n);
      coherent += std::norm(pattern.harmonics[a][m]);
    }
  }
  // Noise alone would leave 1 / n of its power in the mean.
  pattern.contrast = std::sqrt(coherent / all * static_cast<double>(n)) / 3.0;
  pattern.found = pattern.contrast > 1.0;

  // Lifter count: the order whose multiples hold most of the pattern, against what a random pattern would put there.
  std::vector<double> power(kOrders + 1, 0.0);
  double total = 1e-12;
  for (int m = 1; m <= kOrders; ++m) {
    for (std::size_t a = 0; a < annuli; ++a) power[m] += std::norm(pattern.harmonics[a][m]);
    total += power[m];
  }
  double best_score = 0;
  for (int k = 3; k <= 60; ++k) {
    double held = 0;
    int orders = 0;
    for (int m = k; m <= kOrders; m += k) {
      held += power[m];
      ++orders;
    }
    const double score = held / total - static_cast<double>(orders) / kOrders;
    if (score > best_score) {
      best_score = score;
      pattern.lifter_count = k;
    }
  }
  if (best_score < 0.35) pattern.lifter_count = 0;
  if (known_lifters > 0) pattern.lifter_count = known_lifters;
  return pattern;
}

double drum_angle(const DrumPattern& pattern, const DrumStrip& strip, double expected) {
  const auto f = spectra(strip.rows - pattern.still);
  Spectrum s(kOrders + 1);
  for (std::size_t a = 0; a < f.size(); ++a)
    for (int m = 1; m <= kOrders; ++m) s[m] += pattern.harmonics[a][m] * std::conj(f[a][m]);
  const int period = pattern.lifter_count > 0 ? pattern.lifter_count : 12;
  return -best_match(s, -expected, 0.35 * 2 * kPi / period);
}

double lifter_phase(const DrumPattern& pattern, const std::vector<DrumStrip>& strips, const cv::Range& rows) {
  if (!pattern.found || pattern.lifter_count < 1 || rows.empty()) return kNotGiven;
  const std::size_t n = DrumStrip::kAngles;
  std::vector<double> sum(n, 0.0), squares(n, 0.0);
  Complex phase = 0;
  for (int a = rows.start; a < rows.end; ++a) {
    std::fill(sum.begin(), sum.end(), 0.0);
    std::fill(squares.begin(), squares.end(), 0.0);
    for (std::size_t t = 0; t < strips.size(); ++t) {
      const auto turn =
          static_cast<long>(std::lround(pattern.step * static_cast<double>(t) / (2 * kPi) * static_cast<double>(n)));
      const float* row = strips[t].rows.ptr<float>(a);
      for (std::size_t k = 0; k < n; ++k) {
        const auto from = static_cast<std::size_t>(
            ((static_cast<long>(k) + turn) % static_cast<long>(n) + static_cast<long>(n)) % static_cast<long>(n));
        sum[k] += row[from];
        squares[k] += row[from] * row[from];
      }
    }
    const double frames = static_cast<double>(strips.size());
    for (std::size_t k = 0; k < n; ++k) {
      const double spread = std::sqrt(std::max(0.0, squares[k] / frames - sum[k] * sum[k] / (frames * frames)));
      phase -=
          spread * std::polar(1.0, -2 * kPi * pattern.lifter_count * static_cast<double>(k) / static_cast<double>(n));
    }
  }
  // spread ~ -cos(count (k - middle)): the sum's phase is -count x middle.
  const double spacing = 2 * kPi / pattern.lifter_count;
  const double middle = -std::arg(phase) / pattern.lifter_count;
  return middle < 0 ? middle + spacing : middle;
}

}  // namespace tumble::analysis
