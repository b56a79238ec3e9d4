#include "analysis/ball_rim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/quantile.h"
#include "core/statistics.h"
#include "core/units.h"

namespace tumble::analysis {
namespace {

constexpr int kRays = 72;
constexpr double kStep = 0.2;       // along a ray [px]
constexpr int kHalf = 3;            // steps on either side of an edge that its height is taken over
constexpr double kFaint = 10;       // height of an edge that says nothing [grey levels]
constexpr double kClear = 60;       // height beyond which edges are all the same
constexpr double kOnCircle = 0.25;  // distance from the circle within which an edge lies on it [px]
constexpr double kSharp = 0.58;  // share of such edges from which outlines are sharp: small balls have half by chance
constexpr double kWhole = 0.6;   // share from which the right circle is found for certain
constexpr double kAside = 1.2;   // of other starts for it [px]
constexpr std::size_t kFewest = 12;   // balls to learn from
constexpr std::size_t kEnough = 100;  // their median share is then known to 0.02

// Height of the edge along the rays from a centre, by ray and distance.
class Rays {
 public:
  Rays(double from, double to) : from_(from), count_(static_cast<int>((to - from) / kStep) + 1) {
    for (int i = 0; i < kRays; ++i) {
      const double a = 2 * kPi * (i + 0.5) / kRays;
      way_[static_cast<std::size_t>(i)] = {std::cos(a), std::sin(a)};
    }
    map_u_.create(kRays, count_ + 2 * kHalf, CV_32F);
    map_v_.create(map_u_.size(), CV_32F);
  }

  const cv::Mat& look(const cv::Mat& grey, const cv::Point2d& centre) {
    for (int i = 0; i < kRays; ++i)
      for (int k = 0; k < map_u_.cols; ++k) {
        const double rho = from_ + (k - kHalf) * kStep;
        map_u_.at<float>(i, k) = static_cast<float>(centre.x + rho * way(i).x);
        map_v_.at<float>(i, k) = static_cast<float>(centre.y + rho * way(i).y);
      }
    cv::remap(grey, levels_, map_u_, map_v_, cv::INTER_CUBIC, cv::BORDER_REPLICATE);
    cv::absdiff(levels_.colRange(2 * kHalf, levels_.cols), levels_.colRange(0, count_), heights_);
    return heights_;
  }

  double distance(double k) const { return from_ + k * kStep; }
  const cv::Point2d& way(int ray) const { return way_[static_cast<std::size_t>(ray)]; }

 private:
  double from_;
  int count_;
  std::array<cv::Point2d, kRays> way_;
  cv::Mat map_u_, map_v_, levels_, heights_;
};

// Where a row of values is highest, between its samples; NaN at its ends.
double peak_of(const float* values, int n) {
  const int i = static_cast<int>(std::max_element(values, values + n) - values);
  if (i == 0 || i == n - 1) return kNotGiven;
  const double bend = values[i - 1] - 2.0 * values[i] + values[i + 1];
  return i + (bend < 0 ? 0.5 * (values[i - 1] - values[i + 1]) / bend : 0.0);
}

}  // namespace

cv::Mat grey_of(const cv::Mat& bgr) {
  cv::Mat grey;
  cv::cvtColor(bgr, grey, cv::COLOR_BGR2GRAY);
  grey.convertTo(grey, CV_32F);
  return grey;
}

namespace {

RimFit fit_from(const cv::Mat& grey, const cv::Point2d& near, double rim) {
  RimFit fit{near.x, near.y};
  for (const double reach : {1.6, 1.0, 0.8}) {
    Rays rays(rim - reach, rim + reach);
    const cv::Mat& heights = rays.look(grey, {fit.u, fit.v});
    std::array<double, kRays> off, say;
    for (int i = 0; i < kRays; ++i) {
      const auto* row = heights.ptr<float>(i);
      const double at = peak_of(row, heights.cols);
      const bool seen = !std::isnan(at) && row[static_cast<int>(at + 0.5)] > kFaint;
      say[static_cast<std::size_t>(i)] =
          seen ? std::pow(std::min(1.0f, row[static_cast<int>(at + 0.5)] / 50.0f), 2) : 0.0;
      off[static_cast<std::size_t>(i)] = seen ? rays.distance(at) - rim : kNotGiven;
    }
    // Least squares for the shift; edges of neighbours and marks lose their say step by step.
    double du = 0, dv = 0;
    for (double spread = 0.5; spread > 0.06; spread *= 0.75) {
      double uu = 1e-9, uv = 0, vv = 1e-9, bu = 0, bv = 0;
      for (int i = 0; i < kRays; ++i) {
        const double b = off[static_cast<std::size_t>(i)];
        if (std::isnan(b)) continue;
        const cv::Point2d& n = rays.way(i);
        const double miss = (b - n.x * du - n.y * dv) / spread,
                     w = say[static_cast<std::size_t>(i)] / ((1 + miss * miss) * (1 + miss * miss));
        uu += w * n.x * n.x;
        uv += w * n.x * n.y;
        vv += w * n.y * n.y;
        bu += w * n.x * b;
        bv += w * n.y * b;
      }
      const double det = uu * vv - uv * uv;
      du = (vv * bu - uv * bv) / det;
      dv = (uu * bv - uv * bu) / det;
    }
    fit.u += du;
    fit.v += dv;
    int on_circle = 0;
    double squares = 0;
    for (int i = 0; i < kRays; ++i) {
      const double miss = off[static_cast<std::size_t>(i)] - rays.way(i).x * du - rays.way(i).y * dv;
      if (!(std::abs(miss) < kOnCircle)) continue;
      ++on_circle;
      squares += miss * miss;
    }
    fit.share = static_cast<double>(on_circle) / kRays;
    fit.spread = std::sqrt(squares / std::max(1, on_circle));
  }
  return fit;
}

}  // namespace

RimFit fit_rim(const cv::Mat& grey, const cv::Point2d& near, double rim) {
  RimFit best = fit_from(grey, near, rim);
  // Outlines may be lines with two edges: from far off, half of one and half of the other fit best.
  for (int k = 0; k < 8 && best.share < kWhole; ++k) {
    const double a = k * kPi / 4;
    const RimFit fit = fit_from(grey, near + kAside * cv::Point2d(std::cos(a), std::sin(a)), rim);
    if (fit.share > best.share) best = fit;
  }
  return best;
}

namespace {

// Median share of the outlines' directions that lie on circles of this radius; moves the centres there.
double share_on(const std::vector<cv::Mat>& greys, std::vector<std::vector<cv::Point2d>>& centres, double rim,
                double radius) {
  std::vector<double> shares;
  for (std::size_t g = 0; g < greys.size(); ++g)
    for (cv::Point2d& p : centres[g]) {
      const RimFit fit = fit_rim(greys[g], p, rim);
      shares.push_back(fit.share);
      if (std::hypot(fit.u - p.x, fit.v - p.y) < 0.15 * radius) p = {fit.u, fit.v};
    }
  return median_of(shares);
}

}  // namespace

double learn_rim(const std::vector<cv::Mat>& greys, const std::vector<std::vector<cv::Point2d>>& centres,
                 double radius) {
  std::size_t count = 0;
  for (const auto& p : centres) count += p.size();
  if (count < kFewest) return kNotGiven;
  std::vector<std::vector<cv::Point2d>> places(centres.size());
  const std::size_t taken = std::min(count, kEnough);
  std::size_t met = 0, kept = 0;
  for (std::size_t g = 0; g < centres.size(); ++g)
    for (const cv::Point2d& p : centres[g]) {
      if (met++ < kept * count / taken) continue;
      places[g].push_back(p);
      ++kept;
    }
  const auto first = places;
  double best = 0, rim = 0;
  for (double r = 0.86 * radius; r < 1.1 * radius; r += 1.6 * kOnCircle) {
    auto moved = first;
    const double share = share_on(greys, moved, r, radius);
    if (share <= best) continue;
    best = share;
    rim = r;
    places = std::move(moved);
  }
  for (int round = 0; round < 2; ++round) {  // where the mean edge is, and the centres once more
    Rays rays(rim - 1.2, rim + 1.2);
    cv::Mat sum;
    for (std::size_t g = 0; g < greys.size(); ++g)
      for (const cv::Point2d& p : places[g]) {
        cv::Mat heights;
        cv::reduce(cv::min(rays.look(greys[g], p), kClear), heights, 0, cv::REDUCE_SUM);
        sum = sum.empty() ? heights.clone() : cv::Mat(sum + heights);
      }
    const double better = rays.distance(peak_of(sum.ptr<float>(0), sum.cols));
    if (std::isnan(better)) break;
    auto moved = places;
    const double share = share_on(greys, moved, better, radius);
    if (share < best) break;
    best = share;
    rim = better;
    places = std::move(moved);
  }
  return best > kSharp ? rim : kNotGiven;
}

}  // namespace tumble::analysis
