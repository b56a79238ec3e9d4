#include "analysis/circles.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/quantile.h"
#include "core/units.h"

namespace tumble::analysis {
namespace {

constexpr int kSectors = 72;   // of the radial profiles, 5 degrees each
constexpr double kCell = 4.0;  // of the coarse vote for the centre [px]

struct EdgePixel {
  float u, v, du, dv, weight;  // place, unit gradient, strength
};

std::vector<EdgePixel> strong_edges(const cv::Mat& grey, const cv::Mat& where) {
  cv::Mat smooth, gu, gv;
  cv::GaussianBlur(grey, smooth, {}, 1.5);
  cv::Sobel(smooth, gu, CV_32F, 1, 0, 3, 0.125);
  cv::Sobel(smooth, gv, CV_32F, 0, 1, 3, 0.125);
  cv::Mat magnitude;
  cv::magnitude(gu, gv, magnitude);
  // Threshold: the strongest tenth of the pixels, but never plain noise.
  std::vector<float> sample;
  for (int v = 0; v < magnitude.rows; v += 3)
    for (int u = 0; u < magnitude.cols; u += 3)
      if (where.empty() || where.at<uchar>(v, u) != 0) sample.push_back(magnitude.at<float>(v, u));
  if (sample.empty()) return {};
  const float threshold = std::max(0.4f, quantile_of(std::move(sample), 0.9));
  std::vector<EdgePixel> edges;
  for (int v = 2; v < magnitude.rows - 2; ++v) {
    for (int u = 2; u < magnitude.cols - 2; ++u) {
      const float m = magnitude.at<float>(v, u);
      if (m < threshold || (!where.empty() && where.at<uchar>(v, u) == 0)) continue;
      edges.push_back({static_cast<float>(u), static_cast<float>(v), gu.at<float>(v, u) / m, gv.at<float>(v, u) / m,
                       std::min(m, 4 * threshold)});  // capped: one bright sign must not outvote a drum
    }
  }
  return edges;
}

// Every edge votes for the places along its gradient; a drum's circles meet in its centre.
cv::Point2d vote_for_centre(const std::vector<EdgePixel>& edges, cv::Size size, double least_radius) {
  const int w = static_cast<int>(size.width / kCell) + 1, h = static_cast<int>(size.height / kCell) + 1;
  cv::Mat votes = cv::Mat::zeros(h, w, CV_32F);
  const double most = 0.75 * std::max(size.width, size.height);
  for (const EdgePixel& e : edges) {
    for (int sign : {-1, 1}) {
      for (double r = least_radius; r < most; r += kCell) {
        const double u = e.u + sign * r * e.du, v = e.v + sign * r * e.dv;
        const int i = static_cast<int>(u / kCell), j = static_cast<int>(v / kCell);
        if (u < 0 || v < 0 || i >= w || j >= h) break;
        votes.at<float>(j, i) += e.weight;
      }
    }
  }
  // Random lines pile up in the middle of the picture: judge each place against its surroundings.
  cv::Mat near, far;
  cv::GaussianBlur(votes, near, {}, 1.5);
  cv::GaussianBlur(votes, far, {}, 8.0);
  cv::Mat contrast = near - far;
  cv::Point place;
  cv::minMaxLoc(contrast, nullptr, nullptr, nullptr, &place);
  return {(place.x + 0.5) * kCell, (place.y + 0.5) * kCell};
}

// Least squares on the distances of the gradient lines from the centre, with a window that closes in.
cv::Point2d refine_centre(const std::vector<EdgePixel>& edges, cv::Point2d centre, double least_radius) {
  for (double window : {12.0, 8.0, 5.0, 4.0, 4.0, 4.0}) {
    double a = 0, b = 0, c = 0, p = 0, q = 0;
    for (const EdgePixel& e : edges) {
      const double du = centre.x - e.u, dv = centre.y - e.v;
      if (du * du + dv * dv < least_radius * least_radius) continue;
      const double tu = -e.dv, tv = e.du;  // tangent
      const double miss = tu * du + tv * dv;
      if (std::abs(miss) > window) continue;
      const double k = 1 - miss * miss / (window * window), w = e.weight * k * k;
      a += w * tu * tu;
      b += w * tu * tv;
      c += w * tv * tv;
      p -= w * tu * miss;
      q -= w * tv * miss;
    }
    const double det = a * c - b * b;
    if (!(det > 1e-9 * a * c)) break;
    centre.x += (c * p - b * q) / det;
    centre.y += (a * q - b * p) / det;
  }
  return centre;
}

// Brightness by direction (rows, kSectors) and radius (columns, 1 px).
cv::Mat sector_profiles(const cv::Mat& grey, cv::Point2d centre, int radii) {
  constexpr int kPerSector = 10;
  cv::Mat polar(kSectors * kPerSector, radii, CV_32F), map_u(polar.size(), CV_32F), map_v(polar.size(), CV_32F);
  for (int s = 0; s < polar.rows; ++s) {
    const double a = 2 * kPi * (s + 0.5) / polar.rows;
    for (int r = 0; r < radii; ++r) {
      map_u.at<float>(s, r) = static_cast<float>(centre.x + r * std::cos(a));
      map_v.at<float>(s, r) = static_cast<float>(centre.y - r * std::sin(a));
    }
  }
  cv::remap(grey, polar, map_u, map_v, cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar::all(-1e6));
  cv::Mat profiles(kSectors, radii, CV_32F);
  for (int s = 0; s < kSectors; ++s)
    cv::reduce(polar.rowRange(s * kPerSector, (s + 1) * kPerSector), profiles.row(s), 0, cv::REDUCE_AVG);
  return profiles;
}

// Places of the strongest step of the given sign within `reach` of `radius`, by direction; then a robust circle.
RingEdge fit_ring(const cv::Mat& grey, cv::Point2d centre, double radius, double sign, double reach) {
  constexpr int kDirections = 720;
  RingEdge ring;
  std::vector<cv::Point2d> points;
  std::vector<double> steps;
  const auto sample = [&](double u, double v) -> double {
    const int i = static_cast<int>(std::floor(u)), j = static_cast<int>(std::floor(v));
    if (i < 0 || j < 0 || i + 1 >= grey.cols || j + 1 >= grey.rows) return std::nan("");
    const double x = u - i, y = v - j;
    return (1 - y) * ((1 - x) * grey.at<float>(j, i) + x * grey.at<float>(j, i + 1)) +
           y * ((1 - x) * grey.at<float>(j + 1, i) + x * grey.at<float>(j + 1, i + 1));
  };
  constexpr double kStep = 0.5;
  const int n = static_cast<int>(2 * reach / kStep) + 1;
  std::vector<double> line(static_cast<std::size_t>(n) + 4);
  int visible = 0;
  for (int k = 0; k < kDirections; ++k) {
    const double a = 2 * kPi * k / kDirections, c = std::cos(a), s = -std::sin(a);
    bool whole = true;
    for (int i = 0; i < n + 4; ++i) {
      const double r = radius - reach + (i - 2) * kStep;
      line[i] = sample(centre.x + r * c, centre.y + r * s);
      whole = whole && !std::isnan(line[i]);
    }
    if (!whole) continue;
    ++visible;
    double best = 0;
    int at = -1;
    for (int i = 0; i < n; ++i) {
      const double step = sign * (line[i + 4] + line[i + 3] - line[i + 1] - line[i]);
      if (step > best) {
        best = step;
        at = i;
      }
    }
    if (at < 1 || at + 1 >= n) continue;
    const auto step_at = [&](int i) { return line[i + 4] + line[i + 3] - line[i + 1] - line[i]; };
    const double l = sign * step_at(at - 1), m = best, h = sign * step_at(at + 1);
    const double peak = l - 2 * m + h < 0 ? 0.5 * (l - h) / (l - 2 * m + h) : 0.0;
    const double r = radius - reach + (at + std::clamp(peak, -0.5, 0.5)) * kStep;
    points.push_back({centre.x + r * c, centre.y + r * s});
    steps.push_back(best / 2);
  }
  if (points.size() < 40) return ring;
  const double typical = median_of(steps);
  std::vector<double> weights(points.size());
  Circle circle{centre.x, centre.y, radius};
  double scale = reach;
  for (int round = 0; round < 12; ++round) {
    std::vector<double> misses;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double miss = std::hypot(points[i].x - circle.u, points[i].y - circle.v) - circle.radius;
      misses.push_back(std::abs(miss));
      const double k = miss / scale;
      weights[i] = std::abs(k) < 1 ? std::min(steps[i], typical) * (1 - k * k) * (1 - k * k) : 0.0;
    }
    const Circle next = fit_circle(points, weights);
    if (!(next.radius > 0) || std::hypot(next.u - centre.x, next.v - centre.y) > 2 * reach) break;
    circle = next;
    scale = std::clamp(4.0 * median_of(std::move(misses)), 1.5, reach);
  }
  int on = 0;
  double strength = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double miss = std::hypot(points[i].x - circle.u, points[i].y - circle.v) - circle.radius;
    if (std::abs(miss) > 1.5 || steps[i] < 0.25 * typical) continue;
    ++on;
    strength += steps[i];
  }
  ring.circle = circle;
  ring.coverage = visible > 0 ? static_cast<double>(on) / visible : 0.0;
  ring.strength = on > 0 ? sign * strength / on : 0.0;
  return ring;
}

}  // namespace

Circle fit_circle(const std::vector<cv::Point2d>& points, const std::vector<double>& weights) {
  double sum = 0, mu = 0, mv = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    sum += weights[i];
    mu += weights[i] * points[i].x;
    mv += weights[i] * points[i].y;
  }
  if (!(sum > 0)) return {};
  mu /= sum;
  mv /= sum;
  // Rows (x^2 + y^2 - mean, x, y): the smallest singular direction after Taubin's scaling of the first column.
  double mz = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = points[i].x - mu, y = points[i].y - mv;
    mz += weights[i] / sum * (x * x + y * y);
  }
  if (!(mz > 0)) return {};
  Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = points[i].x - mu, y = points[i].y - mv;
    const Eigen::Vector3d row((x * x + y * y - mz) / (2 * std::sqrt(mz)), x, y);
    m += weights[i] / sum * row * row.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(m);
  const Eigen::Vector3d e = solver.eigenvectors().col(0);
  const double a0 = e[0] / (2 * std::sqrt(mz));
  if (std::abs(a0) < 1e-12) return {};
  const double x = -e[1] / (2 * a0), y = -e[2] / (2 * a0);
  const double r2 = x * x + y * y + mz;
  return {x + mu, y + mv, r2 > 0 ? std::sqrt(r2) : 0.0};
}

cv::Point2d centre_of_circles(const std::vector<cv::Mat>& greys, const cv::Mat& where, double least_radius) {
  std::vector<EdgePixel> edges;
  for (const cv::Mat& picture : greys) {
    cv::Mat grey;
    picture.convertTo(grey, CV_32F);
    const auto more = strong_edges(grey, where);
    edges.insert(edges.end(), more.begin(), more.end());
  }
  if (edges.size() < 100) return {std::nan(""), std::nan("")};
  return refine_centre(edges, vote_for_centre(edges, greys[0].size(), least_radius), least_radius);
}

std::vector<RingEdge> find_concentric_circles(const cv::Mat& picture, double least_radius) {
  cv::Mat grey;
  picture.convertTo(grey, CV_32F);
  const auto edges = strong_edges(grey, {});
  if (edges.size() < 100) return {};
  cv::Point2d centre = vote_for_centre(edges, grey.size(), least_radius);
  centre = refine_centre(edges, centre, least_radius);
  if (centre.x < 0 || centre.y < 0 || centre.x >= grey.cols || centre.y >= grey.rows) return {};

  const int radii = static_cast<int>(std::max(grey.cols, grey.rows));
  const cv::Mat profiles = sector_profiles(grey, centre, radii);
  // For each radius: in how many directions does brightness step the same way, and by how much.
  struct Step {
    double up = 0, down = 0;
  };
  std::vector<Step> steps(static_cast<std::size_t>(radii));
  for (int r = static_cast<int>(least_radius); r + 4 < radii; ++r) {
    int seen = 0;
    std::vector<double> d;
    for (int s = 0; s < kSectors; ++s) {
      const float* p = profiles.ptr<float>(s);
      if (p[r + 4] < -1e3f || p[r - 4] < -1e3f) continue;
      ++seen;
      double up = 0, down = 0;
      for (int k = -1; k <= 1; ++k) {  // the circle need not be round to the pixel
        const double step = 0.5 * (p[r + k + 2] + p[r + k + 1] - p[r + k - 1] - p[r + k - 2]);
        up = std::max(up, step);
        down = std::max(down, -step);
      }
      steps[r].up += std::min(up, 20.0);
      steps[r].down += std::min(down, 20.0);
    }
    if (seen < kSectors / 2) {
      steps[r] = {};
      continue;
    }
    steps[r].up /= seen;
    steps[r].down /= seen;
  }
  std::vector<RingEdge> rings;
  for (int r = static_cast<int>(least_radius) + 3; r + 4 < radii; ++r) {
    for (int sign : {-1, 1}) {
      const auto at = [&](int i) { return sign > 0 ? steps[i].up : steps[i].down; };
      bool peak = at(r) > 1.0;
      for (int k = 1; k <= 3 && peak; ++k) peak = at(r) >= at(r - k) && at(r) > at(r + k);
      if (!peak) continue;
      const RingEdge ring = fit_ring(grey, centre, r, sign, std::max(4.0, 0.02 * r));
      if (ring.coverage > 0.3) rings.push_back(ring);
    }
  }
  std::sort(rings.begin(), rings.end(), [](const RingEdge& a, const RingEdge& b) {
    return std::abs(a.strength) * a.coverage > std::abs(b.strength) * b.coverage;
  });
  // The same edge found from two starts.
  std::vector<RingEdge> distinct;
  for (const RingEdge& ring : rings) {
    const bool known = std::any_of(distinct.begin(), distinct.end(), [&](const RingEdge& d) {
      return std::abs(d.circle.radius - ring.circle.radius) < 2.0 && d.strength * ring.strength > 0;
    });
    if (!known) distinct.push_back(ring);
  }
  return distinct;
}

}  // namespace tumble::analysis
