#include "analysis/drum_rings.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "analysis/circles.h"
#include "core/quantile.h"
#include "core/units.h"

namespace tumble::analysis {
namespace {

constexpr int kDirections = 720;
constexpr int kPerPixel = 2;          // samples along the radius
constexpr double kLeastStep = 1.0;    // of brightness across a ring [grey levels]
constexpr double kMovingShare = 0.4;  // of the directions, for a circle to be within the drum: its flange may be plain
constexpr double kMostCounted = 20.0;

// Edge of a row of samples near `at`, sub-sample: where the step is largest.
double edge_near(const float* step, int from, int to, double sign, double& height) {
  int best = -1;
  height = 0;
  for (int i = from; i <= to; ++i)
    if (sign * step[i] > height) {
      height = sign * step[i];
      best = i;
    }
  if (best <= from || best >= to) return std::nan("");
  const double l = sign * step[best - 1], h = sign * step[best + 1], curve = l - 2 * height + h;
  return best + (curve < 0 ? std::clamp(0.5 * (l - h) / curve, -0.5, 0.5) : 0.0);
}

}  // namespace

std::vector<RingEdgePoints> find_rings(const cv::Mat& grey, const DrumPose& pose, double inner, double outer,
                                       double reach) {
  const int samples = static_cast<int>((outer - inner) * kPerPixel) + 1;
  const MillCamera camera = pose.camera();
  DrumPose still = pose;  // edges of the mean picture do not turn
  still.numbers[DrumPose::kTwist] = 0;
  cv::Mat u(kDirections, samples, CV_32F), v(kDirections, samples, CV_32F), polar;
  for (int k = 0; k < kDirections; ++k)
    for (int i = 0; i < samples; ++i) {
      const cv::Point2d p =
          still.picture_of(camera, inner + static_cast<double>(i) / kPerPixel, 2 * kPi * k / kDirections, 0);
      u.at<float>(k, i) = static_cast<float>(p.x);
      v.at<float>(k, i) = static_cast<float>(p.y);
    }
  cv::remap(grey, polar, u, v, cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar::all(-1e6));
  cv::Mat along;  // neighbours in direction agree on an edge, texture and noise do not
  cv::blur(polar, along, {1, 9}, {-1, -1}, cv::BORDER_REPLICATE);
  cv::Mat step = cv::Mat::zeros(polar.size(), CV_32F);
  cv::Mat seen = cv::Mat::zeros(polar.size(), CV_8U);
  for (int k = 0; k < kDirections; ++k)
    for (int i = 3; i + 3 < samples; ++i) {
      const float* p = along.ptr<float>(k);
      if (p[i - 3] < -100 || p[i + 3] < -100) continue;
      seen.at<uchar>(k, i) = 1;
      step.at<float>(k, i) = 0.5F * (p[i + 2] + p[i + 1] - p[i - 1] - p[i - 2]);
    }
  const int wide = std::max(1, static_cast<int>(std::lround(reach * kPerPixel)));
  std::vector<RingEdgePoints> rings;
  for (double sign : {-1.0, 1.0}) {
    cv::Mat signed_step = sign * step, capped, spread;
    cv::min(cv::max(signed_step, 0), kMostCounted, capped);
    cv::dilate(capped, spread, cv::Mat::ones(1, 2 * wide + 1, CV_8U));
    std::vector<double> common(static_cast<std::size_t>(samples), 0.0);
    for (int i = 0; i < samples; ++i) {
      double sum = 0;
      int count = 0;
      for (int k = 0; k < kDirections; ++k) {
        if (seen.at<uchar>(k, i) == 0) continue;
        ++count;
        sum += spread.at<float>(k, i) + capped.at<float>(k, i);  // the latter prefers the middle
      }
      if (count > kDirections / 5) common[static_cast<std::size_t>(i)] = 0.5 * sum / count;
    }
    for (int i = wide; i + wide < samples; ++i) {
      const double here = common[static_cast<std::size_t>(i)];
      bool peak = here > 0.5 * kLeastStep;
      for (int d = 1; d <= wide && peak; ++d)
        peak = here >= common[static_cast<std::size_t>(i - d)] && here > common[static_cast<std::size_t>(i + d)];
      if (!peak) continue;
      RingEdgePoints ring;
      std::vector<double> radii, heights;
      std::vector<int> directions;
      int in_view = 0;
      for (int k = 0; k < kDirections; k += 3) {
        if (seen.at<uchar>(k, i) == 0) continue;
        ++in_view;
        double height = 0;
        const double at =
            edge_near(step.ptr<float>(k), std::max(0, i - wide - 1), std::min(samples - 1, i + wide + 1), sign, height);
        if (std::isnan(at) || height < 0.7 * kLeastStep) continue;
        radii.push_back(inner + at / kPerPixel);
        heights.push_back(height);
        directions.push_back(k);
      }
      if (radii.size() < 24) continue;
      const double radius = median_of(radii);
      double sum = 0, squares = 0;
      for (std::size_t p = 0; p < radii.size(); ++p) {
        if (std::abs(radii[p] - radius) > reach) continue;
        ring.points.push_back(still.picture_of(camera, radii[p], 2 * kPi * directions[p] / kDirections, 0));
        sum += heights[p];
        squares += std::pow(radii[p] - radius, 2);
      }
      const double n = static_cast<double>(ring.points.size());
      ring.radius = radius;
      ring.strength = sign * sum / std::max(1.0, n);
      ring.coverage = n / std::max(1, in_view);
      ring.roughness = std::sqrt(squares / std::max(1.0, n));
      if (ring.coverage > 0.4) rings.push_back(std::move(ring));
    }
  }
  std::sort(rings.begin(), rings.end(), [](const auto& a, const auto& b) { return a.radius < b.radius; });
  return rings;
}

TurningDisc find_turning_disc(const cv::Mat& mean, const cv::Mat& deviation) {
  TurningDisc disc;
  std::vector<float> sample;
  for (int v = 0; v < deviation.rows; v += 3)
    for (int u = 0; u < deviation.cols; u += 3) sample.push_back(deviation.at<float>(v, u));
  const double threshold = 1.0 + 1.6 * std::min<double>(quantile_of(std::move(sample), 0.05), 6.0);
  cv::Mat smooth, moving, near;
  cv::GaussianBlur(deviation, smooth, {}, 1.0);
  moving = smooth > threshold;
  cv::morphologyEx(moving, moving, cv::MORPH_OPEN, cv::Mat::ones(3, 3, CV_8U));
  if (cv::countNonZero(moving) < 0.01 * moving.rows * moving.cols) return disc;
  cv::dilate(moving, near, cv::Mat::ones(9, 9, CV_8U));
  cv::Mat capped = cv::min(deviation, 8 * threshold);  // the charge must not outshout the rim
  disc.axis = centre_of_circles({mean, capped}, near, 0.12 * std::min(mean.rows, mean.cols));
  if (!(disc.axis.x > -0.2 * mean.cols && disc.axis.y > -0.2 * mean.rows && disc.axis.x < 1.2 * mean.cols &&
        disc.axis.y < 1.2 * mean.rows))
    return disc;
  // The outermost circle that moves nearly all round. One that lies mostly outside of the picture comes second: what
  // else moves in the film may well fill the little of it that is in view.
  const int most = static_cast<int>(std::hypot(mean.cols, mean.rows));
  const auto outermost = [&](double least_in_view) {
    for (int r = most; r > 0.1 * std::min(mean.rows, mean.cols); --r) {
      int in_view = 0, moves = 0;
      for (int k = 0; k < kDirections; ++k) {
        const int u = static_cast<int>(std::lround(disc.axis.x + r * std::cos(2 * kPi * k / kDirections)));
        const int v = static_cast<int>(std::lround(disc.axis.y - r * std::sin(2 * kPi * k / kDirections)));
        if (u < 0 || v < 0 || u >= mean.cols || v >= mean.rows) continue;
        ++in_view;
        moves += moving.at<uchar>(v, u) != 0;
      }
      if (in_view >= least_in_view * kDirections && moves >= kMovingShare * in_view) return r;
    }
    return 0;
  };
  const int whole = outermost(0.55), part = outermost(0.2);
  disc.radius = whole > 0 ? whole : part;
  if (disc.radius == 0) return disc;
  if (part > disc.radius) disc.wider = part;
  double besides = 0;
  for (int v = 0; v < moving.rows; ++v)
    for (int u = 0; u < moving.cols; ++u)
      besides += moving.at<uchar>(v, u) != 0 && std::hypot(u - disc.axis.x, v - disc.axis.y) > 1.05 * disc.radius;
  disc.moving_besides = besides / (kPi * disc.radius * disc.radius);
  disc.found = true;
  return disc;
}

}  // namespace tumble::analysis
