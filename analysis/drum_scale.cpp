#include "analysis/drum_scale.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <opencv2/imgproc.hpp>

#include "core/units.h"

namespace tumble::analysis {
namespace {

constexpr int kSectors = 36;               // round the drum, in which the charge's end is looked for
constexpr std::size_t kFewestSectors = 5;  // in which it must be seen
constexpr double kEnd = 0.15;              // of the charge's changes: what is left of them at its end
constexpr double kLeastStep = 3;           // times by which the charge changes more than what lies outside of it
constexpr double kNearRing = 0.012;        // between the end of the charge and the shell's edge, as a share
constexpr double kEndError = 0.012;        // of the shell by the end of the charge, as a share
constexpr double kRingError = 0.008;       // of an edge near there: it may be the bore of the flange
constexpr int kMostLifters = 60;
constexpr double kLeastPeriodic = 0.35;  // share of the pattern that a lifter count must explain beyond chance

cv::Range rows_between(const PolarGrid& grid, double inner, double outer) {
  const int first = std::clamp(static_cast<int>(std::ceil(inner - grid.inner)), 0, grid.rows);
  return {first, std::clamp(static_cast<int>(std::floor(outer - grid.inner)) + 1, first, grid.rows)};
}

}  // namespace

ShellGuess find_shell(const DrumReader& reader, const std::vector<RingEdgePoints>& rings, double ball) {
  ShellGuess guess;
  const PolarGrid& grid = reader.unroll().grid();
  const MillCamera camera = reader.unroll().pose().camera();
  const cv::Mat &deviation = reader.still().deviation, &in_view = reader.unroll().in_view();
  struct End {
    double radius, weight;
  };
  std::vector<End> ends;
  for (int sector = 0; sector < kSectors; ++sector) {
    const int first = sector * grid.columns / kSectors, last = (sector + 1) * grid.columns / kSectors;
    std::vector<double> charge;  // deviation of what does not turn with the drum, by row
    for (int r = 0; r < grid.rows; ++r) {
      double sum = 0;
      for (int k = first; k < last; ++k)
        sum += in_view.at<uchar>(r, k) != 0 ? deviation.at<float>(r, k) * deviation.at<float>(r, k) : kNotGiven;
      charge.push_back(std::sqrt(sum / (last - first) * std::max(0.0, 1 - reader.texture().coherence(r))));
      if (std::isnan(charge.back())) {
        charge.pop_back();
        break;
      }
    }
    if (charge.size() < 20) continue;
    const auto top = std::max_element(charge.begin(), charge.end());
    const double most = *top;
    auto end = static_cast<std::size_t>(top - charge.begin());
    while (end + 1 < charge.size() && charge[end + 1] >= kEnd * most) ++end;
    if (end + 6 >= charge.size() || end < 4) continue;
    double outside = 0;  // what is left beyond: texture that light changes, noise
    for (std::size_t r = end + 3; r < std::min(charge.size(), end + 9); ++r) outside = std::max(outside, charge[r]);
    if (charge[end - 4] < kLeastStep * outside) continue;
    const double share = (charge[end] - kEnd * most) / std::max(1e-9, charge[end] - charge[end + 1]);
    const double seen = grid.radius(static_cast<double>(end) + std::clamp(share, 0.0, 1.0));
    // Where a shell of that radius would be seen to end, in this direction.
    const double a = 0.5 * (first + last) * grid.pitch();
    const cv::Point2d edge = picture_of(camera, {seen * std::cos(a), seen * std::sin(a), -ball});
    // Light that plays on a flange changes less than a charge does.
    ends.push_back({seen * seen / std::min(seen, mill_place_at(camera, edge, 0).norm()), most * most});
  }
  if (ends.size() < kFewestSectors) return guess;
  std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) { return a.radius < b.radius; });
  double half = 0;
  for (const End& e : ends) half += 0.5 * e.weight;
  for (const End& e : ends) {
    guess.radius = e.radius;
    if ((half -= e.weight) <= 0) break;
  }
  guess.deviation = kEndError;
  const RingEdgePoints* nearest = nullptr;
  for (const RingEdgePoints& ring : rings) {
    if (ring.coverage < 0.5 || std::abs(ring.radius / guess.radius - 1) > kNearRing) continue;
    if (nearest == nullptr || std::abs(ring.strength) > std::abs(nearest->strength)) nearest = &ring;
  }
  if (nearest != nullptr) {
    // Halfway where they differ by more than their errors would explain: neither is sure.
    const double miss = nearest->radius / guess.radius - 1, trust = 1 / (1 + std::pow(miss / 0.006, 4));
    guess.deviation = kRingError + 0.5 * std::abs(miss);
    guess.radius *= 1 + trust * miss;
    guess.on_ring = trust > 0.5;
  }
  return guess;
}

int count_lifters(const DrumReader& reader, double inner, double outer) {
  const cv::Range rows = rows_between(reader.unroll().grid(), inner, outer);
  if (rows.size() < 2) return 0;
  cv::Mat f;
  cv::dft(reader.texture().pattern().rowRange(rows), f, cv::DFT_ROWS | cv::DFT_COMPLEX_OUTPUT);
  const int orders = std::min(2 * kMostLifters, f.cols / 3);
  std::vector<double> power(static_cast<std::size_t>(orders) + 1, 0.0);
  double total = 1e-9;
  for (int m = 3; m <= orders; ++m) {  // light and a drum that wobbles are of lower orders
    for (int r = 0; r < f.rows; ++r) {
      const auto c = f.at<cv::Vec2f>(r, m);
      power[static_cast<std::size_t>(m)] += c[0] * c[0] + c[1] * c[1];
    }
    total += power[static_cast<std::size_t>(m)];
  }
  int best = 0;
  double most = kLeastPeriodic;
  for (int k = 3; k <= kMostLifters; ++k) {
    double held = 0;
    int count = 0;
    for (int m = k; m <= orders; m += k, ++count) held += power[static_cast<std::size_t>(m)];
    const double score = held / total - static_cast<double>(count) / (orders - 2);
    if (score > most) {
      most = score;
      best = k;
    }
  }
  return best;
}

double lifter_angle(const DrumReader& reader, const std::vector<cv::Mat>& strips, const std::vector<double>& angles,
                    int count, double inner, double outer) {
  const PolarGrid& grid = reader.unroll().grid();
  const cv::Range rows = rows_between(grid, inner, outer);
  if (count < 1 || rows.size() < 2 || strips.empty()) return kNotGiven;
  const int n = grid.columns;
  std::complex<double> phase = 0;
  double total = 0;
  for (int r = rows.start; r < rows.end; ++r) {
    std::vector<double> sum(static_cast<std::size_t>(n), 0.0), squares(static_cast<std::size_t>(n), 0.0);
    for (std::size_t t = 0; t < strips.size(); ++t) {
      const long turn = std::lround(angles[t] / grid.pitch());
      const uchar* strip = strips[t].ptr<uchar>(r);
      const float* mean = reader.still().mean.ptr<float>(r);
      for (int k = 0; k < n; ++k) {
        const int from = static_cast<int>((((k + turn) % n) + n) % n);
        const double value = strip[from] - mean[from];
        sum[static_cast<std::size_t>(k)] += value;
        squares[static_cast<std::size_t>(k)] += value * value;
      }
    }
    const double frames = static_cast<double>(strips.size());
    for (int k = 0; k < n; ++k) {
      const auto i = static_cast<std::size_t>(k);
      const double change = std::sqrt(std::max(0.0, squares[i] / frames - std::pow(sum[i] / frames, 2)));
      phase += std::polar(change, -count * k * grid.pitch());
      total += change;
    }
  }
  if (std::abs(phase) < 0.02 * total) return kNotGiven;
  // change ~ cos(count (a - a0)) is least half a spacing from a0.
  const double spacing = 2 * kPi / count, least = -std::arg(phase) / count + 0.5 * spacing;
  return least - spacing * std::floor(least / spacing);
}

}  // namespace tumble::analysis
