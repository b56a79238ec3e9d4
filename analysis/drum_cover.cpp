#include "analysis/drum_cover.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/quantile.h"
#include "core/units.h"

namespace tumble::analysis {
namespace {

constexpr double kGlare = 240;       // [grey levels]: brighter is glare
constexpr double kSharp = 5;         // step of brightness at the outline of a cover [grey levels per pixel]
constexpr double kSharpShare = 0.6;  // of the outline
constexpr double kUnlike = 6;        // by which a cover differs from what the drum shows at that radius [grey levels]
constexpr int kLeastPixels = 12;     // of a cover
constexpr int kDirections = 720;     // round the drum
constexpr int kAcross = 8;           // places in the ring of the lifters, in one direction
constexpr double kRingShare = 0.5;   // of the directions in which lifters must be seen to pass, for this ring to tell

}  // namespace

cv::Mat hidden_part(const cv::Mat& mean, const cv::Mat& deviation, const DrumPose& pose, double tip, double shell) {
  const MillCamera camera = pose.camera();
  cv::Mat radius(mean.size(), CV_32F);
  std::vector<float> outside;
  for (int v = 0; v < mean.rows; ++v)
    for (int u = 0; u < mean.cols; ++u) {
      const double r = mill_place_at(camera, cv::Point2d(u, v), 0).norm();
      radius.at<float>(v, u) = static_cast<float>(std::isnan(r) ? 1e9 : r);
      if (r > 1.3 * shell) outside.push_back(deviation.at<float>(v, u));
    }
  double noise = 1;  // where nothing moves; of the quieter half: other things may move outside of the drum
  if (outside.size() > 200) noise = quantile_of(std::move(outside), 1.0 / 3);
  cv::Mat smooth, still, edge_u, edge_v, edge;
  cv::GaussianBlur(deviation, smooth, {}, 0.8);
  still = smooth < 1.0 + 1.6 * noise;
  still.setTo(0, radius > shell);
  cv::morphologyEx(still, still, cv::MORPH_CLOSE, cv::Mat::ones(3, 3, CV_8U));
  cv::Sobel(mean, edge_u, CV_32F, 1, 0, 3, 0.125);
  cv::Sobel(mean, edge_v, CV_32F, 0, 1, 3, 0.125);
  cv::magnitude(edge_u, edge_v, edge);
  const cv::Mat sharp = edge > kSharp;

  // Directions in which the whole ring of the lifters stands still, if lifters are seen to pass elsewhere.
  const auto pixel = [&](double r, int k) {
    const double a = 2 * kPi * k / kDirections;
    const cv::Point2d p = picture_of(camera, {r * std::cos(a), r * std::sin(a), 0});
    return cv::Point(static_cast<int>(std::lround(p.x)), static_cast<int>(std::lround(p.y)));
  };
  const cv::Rect frame({0, 0}, mean.size());
  cv::Mat covered = cv::Mat::zeros(mean.size(), CV_8U);
  std::vector<int> blind;
  int in_view = 0;
  for (int k = 0; k < kDirections; ++k) {
    int seen = 0, quiet = 0;
    for (int i = 0; i < kAcross; ++i) {
      const cv::Point p = pixel(tip + (shell - tip) * (0.15 + 0.7 * i / (kAcross - 1)), k);
      if (!frame.contains(p)) continue;
      ++seen;
      quiet += still.at<uchar>(p) != 0;
    }
    in_view += seen > 0;
    if (seen > 0 && quiet >= 0.8 * seen) blind.push_back(k);
  }
  if (static_cast<int>(blind.size()) < (1 - kRingShare) * in_view)
    for (int k : blind)
      for (int i = 0; i < 3 * kAcross; ++i) {
        const cv::Point p = pixel(tip + (shell - tip) * (0.1 + 0.8 * i / (3 * kAcross - 1)), k);
        if (frame.contains(p)) covered.at<uchar>(p) = 255;
      }
  cv::dilate(covered, covered, cv::Mat::ones(3, 3, CV_8U));
  cv::Mat hidden = covered.clone();

  // What the drum looks like at each radius, all round.
  std::vector<double> usual(static_cast<std::size_t>(shell) + 2, 0.0);
  for (std::size_t r = 0; r < usual.size(); ++r) {
    std::vector<float> round;
    for (int k = 0; k < kDirections; ++k) {
      const cv::Point p = pixel(static_cast<double>(r), k);
      if (frame.contains(p)) round.push_back(mean.at<float>(p));
    }
    if (round.empty()) continue;
    usual[r] = median_of(std::move(round));
  }

  cv::Mat near_sharp, labels, stats, centres;
  cv::dilate(sharp, near_sharp, cv::Mat::ones(5, 5, CV_8U));
  const int parts = cv::connectedComponentsWithStats(still & ~sharp, labels, stats, centres, 4, CV_32S);
  for (int part = 1; part < parts; ++part) {
    if (stats.at<int>(part, cv::CC_STAT_AREA) < kLeastPixels) continue;
    const cv::Mat here = labels == part;
    cv::Mat inner;
    cv::erode(here, inner, cv::Mat::ones(3, 3, CV_8U));
    const cv::Mat outline = here & ~inner & (radius < 0.98 * shell);
    double unlike = 0;
    const cv::Rect box(stats.at<int>(part, cv::CC_STAT_LEFT), stats.at<int>(part, cv::CC_STAT_TOP),
                       stats.at<int>(part, cv::CC_STAT_WIDTH), stats.at<int>(part, cv::CC_STAT_HEIGHT));
    for (int v = box.y; v < box.y + box.height; ++v)
      for (int u = box.x; u < box.x + box.width; ++u)
        if (here.at<uchar>(v, u) != 0)
          unlike += std::abs(mean.at<float>(v, u) - usual[static_cast<std::size_t>(radius.at<float>(v, u))]);
    unlike /= stats.at<int>(part, cv::CC_STAT_AREA);
    const int around = cv::countNonZero(outline);
    const bool outlined = around > 0 && cv::countNonZero(outline & near_sharp) > kSharpShare * around;
    const bool glare = cv::mean(mean, here)[0] > kGlare;
    if (glare || (outlined && unlike > kUnlike)) hidden.setTo(255, here);
  }
  cv::dilate(hidden, hidden, cv::Mat::ones(5, 5, CV_8U));  // the edges that were left out
  hidden.setTo(0, ~still & ~sharp);
  hidden.setTo(0, radius > shell);
  return hidden;
}

std::vector<double> hidden_share(const cv::Mat& hidden, const DrumPose& pose, double inner, double outer) {
  const MillCamera camera = pose.camera();
  std::vector<double> share(360, 0.0);
  constexpr int kAcross = 12, kAlong = 3;
  for (int degree = 0; degree < 360; ++degree)
    for (int i = 0; i < kAlong * kAcross; ++i) {
      const double angle = (degree + (i % kAlong + 0.5) / kAlong) * kPi / 180;
      const double r = inner + (outer - inner) * (i / kAlong + 0.5) / kAcross;
      const cv::Point2d p = picture_of(camera, {r * std::cos(angle), r * std::sin(angle), 0});
      const int u = static_cast<int>(std::lround(p.x)), v = static_cast<int>(std::lround(p.y));
      const bool seen = u >= 0 && v >= 0 && u < hidden.cols && v < hidden.rows && hidden.at<uchar>(v, u) == 0;
      share[static_cast<std::size_t>(degree)] += (seen ? 0.0 : 1.0) / (kAlong * kAcross);
    }
  return share;
}

}  // namespace tumble::analysis
