#include "analysis/still_view.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <opencv2/imgproc.hpp>

#include "core/units.h"

namespace tumble::analysis {
namespace {

constexpr int kAngles = 720;

// Rows: directions, counter-clockwise; columns: radii [px].
cv::Mat unroll(const cv::Mat& picture, const Circle& centre, int radii) {
  cv::Mat u(kAngles, radii, CV_32F), v(kAngles, radii, CV_32F), polar;
  for (int k = 0; k < kAngles; ++k) {
    const double a = 2 * kPi * (k + 0.5) / kAngles;
    for (int r = 0; r < radii; ++r) {
      u.at<float>(k, r) = static_cast<float>(centre.u + r * std::cos(a));
      v.at<float>(k, r) = static_cast<float>(centre.v - r * std::sin(a));
    }
  }
  cv::remap(picture, polar, u, v, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return polar;
}

double row_mean(const cv::Mat& polar, int row, int from, int to) {
  return cv::mean(polar.row(row).colRange(from, std::max(from + 1, to)))[0];
}

// Where a pattern of this power begins: the radius that best parts powers without it from those with it, by magnitude
// (least squares of the logarithm). No share of the strongest would do: between the lifters' tips and the shell's edge
// the pattern is weaker than at both.
double begins_at(const std::vector<double>& power, int inner) {
  const auto magnitude = [&](int r) { return std::log1p(power[static_cast<std::size_t>(r)]); };  // from a grey level on
  const int n = static_cast<int>(power.size());
  double all = 0, within = 0, best = 0;
  for (int r = inner; r < n; ++r) all += magnitude(r);
  int at = inner;
  for (int r = inner; r + 1 < n; ++r) {
    within += magnitude(r);
    const double left = r + 1 - inner, right = n - r - 1, step = (all - within) / right - within / left;
    const double parted = step * step * left * right;
    if (step <= 0 || parted <= best) continue;
    best = parted;
    at = r + 1;
  }
  return at - 0.5;
}

}  // namespace

double charge_reach(const std::vector<cv::Mat>& shares, const Circle& centre) {
  const int radii = static_cast<int>(1.1 * centre.radius);
  const int width = std::max(3, static_cast<int>(0.02 * centre.radius));
  std::vector<double> step(static_cast<std::size_t>(radii), 0.0);
  for (const cv::Mat& share : shares) {
    cv::Mat polar = unroll(share, centre, radii);
    cv::threshold(polar, polar, 0.5, 1.0, cv::THRESH_BINARY);
    for (int k = 0; k < kAngles; ++k) {
      cv::Mat sum;
      cv::integral(polar.row(k), sum, CV_64F);
      const double* s = sum.ptr<double>(1);
      for (int r = static_cast<int>(0.4 * centre.radius); r + width < radii; ++r) {
        const double inside = (s[r] - s[r - width]) / width, outside = (s[r + width] - s[r]) / width;
        // Squared, so that many directions with a clean end outweigh the ragged free surface.
        if (inside > outside) step[static_cast<std::size_t>(r)] += (inside - outside) * (inside - outside);
      }
    }
  }
  const auto best = std::max_element(step.begin(), step.end());
  return *best > 0 ? static_cast<double>(best - step.begin()) : 0.0;
}

StillLifters find_still_lifters(const std::vector<cv::Mat>& pictures, const std::vector<cv::Mat>& shares,
                                const Circle& mill, int known_count) {
  const int outer = static_cast<int>(mill.radius) - 1, inner = static_cast<int>(0.7 * mill.radius);
  const int wide = static_cast<int>(0.85 * mill.radius);
  constexpr int kLeast = 6, kMost = 60;
  std::vector<std::vector<double>> power(kMost + 1, std::vector<double>(static_cast<std::size_t>(outer) + 1, 0.0));
  int used = 0;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    cv::Mat grey;
    cv::cvtColor(pictures[i], grey, cv::COLOR_BGR2GRAY);
    grey.convertTo(grey, CV_32F);
    const cv::Mat polar = unroll(grey, mill, outer + 1), charge = unroll(shares[i], mill, outer + 1);
    const cv::Rect2d seen_whole(0, 0, grey.cols - 1, grey.rows - 1);
    std::vector<int> free;  // directions without charge, in the picture
    for (int k = 0; k < kAngles; ++k) {
      const double a = 2 * kPi * (k + 0.5) / kAngles;
      const cv::Point2d end(mill.u + outer * std::cos(a), mill.v - outer * std::sin(a));
      if (seen_whole.contains(end) && row_mean(charge, k, wide, outer) < 0.05) free.push_back(k);
    }
    if (static_cast<int>(free.size()) < kAngles / 4) continue;
    ++used;
    for (int r = inner; r <= outer; ++r) {
      std::vector<double> value(kAngles, 0.0), seen(kAngles, 0.0);
      for (int k : free) {
        value[static_cast<std::size_t>(k)] = polar.at<float>(k, r);
        seen[static_cast<std::size_t>(k)] = 1;
      }
      std::vector<double> flat(kAngles, 0.0);  // slow changes of light taken out: mean over 60 degrees
      for (int k : free) {
        double sum = 0, n = 0;
        for (int j = k - 60; j <= k + 60; ++j) {
          const auto at = static_cast<std::size_t>((j + kAngles) % kAngles);
          sum += value[at];
          n += seen[at];
        }
        flat[static_cast<std::size_t>(k)] = value[static_cast<std::size_t>(k)] - sum / n;
      }
      for (int m = kLeast; m <= kMost; ++m) {
        std::complex<double> c = 0;
        for (int k : free) c += flat[static_cast<std::size_t>(k)] * std::polar(1.0, -2 * kPi * m * k / kAngles);
        power[static_cast<std::size_t>(m)][static_cast<std::size_t>(r)] +=
            std::norm(c) / static_cast<double>(free.size());
      }
    }
  }
  StillLifters lifters;
  if (used == 0) return lifters;
  std::vector<double> total;
  for (int m = kLeast; m <= kMost; ++m) {
    const auto& p = power[static_cast<std::size_t>(m)];
    total.push_back(std::accumulate(p.begin() + wide, p.end(), 0.0));
  }
  std::vector<double> ordered = total;
  std::sort(ordered.begin(), ordered.end());
  auto best = std::max_element(total.begin(), total.end());
  if (*best < 8 * ordered[ordered.size() / 2]) return lifters;
  // Short lifters hold as much in the second harmonic as in the first.
  const auto order = kLeast + (best - total.begin());
  if (order % 2 == 0 && order / 2 >= kLeast && total[static_cast<std::size_t>(order / 2 - kLeast)] > 0.2 * *best)
    best = total.begin() + (order / 2 - kLeast);
  lifters.count = known_count > 0 ? known_count : kLeast + static_cast<int>(best - total.begin());
  if (lifters.count < kLeast || lifters.count > kMost) return lifters;
  lifters.tip_radius = begins_at(power[static_cast<std::size_t>(lifters.count)], inner);
  return lifters;
}

}  // namespace tumble::analysis
