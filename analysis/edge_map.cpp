#include "analysis/edge_map.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace tumble::analysis {

EdgeMap make_edge_map(const cv::Mat& bgr, const cv::Rect& window, double blur, double level) {
  EdgeMap map;
  map.origin = window.tl();
  cv::Mat smooth;
  if (blur > 0)
    cv::GaussianBlur(bgr(window), smooth, {3, 3}, blur);
  else
    smooth = bgr(window);
  std::vector<cv::Mat> planes;
  cv::split(smooth, planes);
  map.gradient = cv::Mat::zeros(window.size(), CV_32FC2);
  std::vector<int> best_u(static_cast<std::size_t>(window.width)), best_v(best_u), best(best_u);
  for (int v = 1; v + 1 < window.height;
       ++v) {  // Sobel of every channel, the strongest kept; plain loops that vectorise
    std::fill(best.begin(), best.end(), -1);
    for (const cv::Mat& plane : planes) {
      const uchar* a = plane.ptr<uchar>(v - 1);
      const uchar* b = plane.ptr<uchar>(v);
      const uchar* c = plane.ptr<uchar>(v + 1);
      for (int u = 1; u + 1 < window.width; ++u) {
        const int x = a[u + 1] + 2 * b[u + 1] + c[u + 1] - a[u - 1] - 2 * b[u - 1] - c[u - 1];
        const int y = c[u - 1] + 2 * c[u] + c[u + 1] - a[u - 1] - 2 * a[u] - a[u + 1];
        const int square = x * x + y * y;
        const bool more = square > best[u];
        best_u[u] = more ? x : best_u[u];
        best_v[u] = more ? y : best_v[u];
        best[u] = more ? square : best[u];
      }
    }
    float* g = map.gradient.ptr<float>(v);
    for (int u = 1; u + 1 < window.width; ++u) {
      g[2 * u] = 0.125f * static_cast<float>(best_u[u]);  // Sobel's weights sum to 8 per pixel of distance
      g[2 * u + 1] = 0.125f * static_cast<float>(best_v[u]);
    }
  }
  map.level = level;
  if (level <= 0) {
    std::vector<float> sample;
    for (int v = 0; v < window.height; v += 2)
      for (int u = 0; u < window.width; u += 2) {
        const auto& g = map.gradient.at<cv::Vec2f>(v, u);
        sample.push_back(std::hypot(g[0], g[1]));
      }
    auto at = sample.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(sample.size()));
    std::nth_element(sample.begin(), at, sample.end());
    map.level = std::max(1.0, 0.5 * *at);
  }
  return map;
}

}  // namespace tumble::analysis
