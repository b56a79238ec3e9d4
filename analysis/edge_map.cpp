#include "analysis/edge_map.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace tumble::analysis {

double EdgeMap::along(double u, double v, double nu, double nv) const {
  const double x = u - origin.x, y = v - origin.y;
  const int i = static_cast<int>(x), j = static_cast<int>(y);
  if (x < 0 || y < 0 || i + 1 >= gu.cols || j + 1 >= gu.rows) return 0;
  const double fx = x - i, fy = y - j;
  const float* a = gu.ptr<float>(j) + i;
  const float* b = gu.ptr<float>(j + 1) + i;
  const float* c = gv.ptr<float>(j) + i;
  const float* d = gv.ptr<float>(j + 1) + i;
  const double w00 = (1 - fx) * (1 - fy), w10 = fx * (1 - fy), w01 = (1 - fx) * fy, w11 = fx * fy;
  return nu * (w00 * a[0] + w10 * a[1] + w01 * b[0] + w11 * b[1]) +
         nv * (w00 * c[0] + w10 * c[1] + w01 * d[0] + w11 * d[1]);
}

EdgeMap make_edge_map(const cv::Mat& bgr, const cv::Rect& window, double blur, double level) {
  EdgeMap map;
  map.origin = window.tl();
  cv::Mat smooth, su, sv;
  if (blur > 0)
    cv::GaussianBlur(bgr(window), smooth, {}, blur);
  else
    smooth = bgr(window);
  cv::Sobel(smooth, su, CV_16S, 1, 0, 3);
  cv::Sobel(smooth, sv, CV_16S, 0, 1, 3);
  map.gu.create(window.size(), CV_32F);
  map.gv.create(window.size(), CV_32F);
  map.magnitude.create(window.size(), CV_32F);
  for (int v = 0; v < window.height; ++v) {
    const short* a = su.ptr<short>(v);
    const short* b = sv.ptr<short>(v);
    float* gu = map.gu.ptr<float>(v);
    float* gv = map.gv.ptr<float>(v);
    float* m = map.magnitude.ptr<float>(v);
    for (int u = 0; u < window.width; ++u) {
      int best = -1, best_a = 0, best_b = 0;
      for (int c = 0; c < 3; ++c) {
        const int x = a[3 * u + c], y = b[3 * u + c], square = x * x + y * y;
        if (square > best) {
          best = square;
          best_a = x;
          best_b = y;
        }
      }
      gu[u] = 0.125f * static_cast<float>(best_a);  // Sobel's weights sum to 8 per pixel of distance
      gv[u] = 0.125f * static_cast<float>(best_b);
      m[u] = 0.125f * std::sqrt(static_cast<float>(best));
    }
  }
  map.level = level;
  if (level <= 0) {
    std::vector<float> sample;
    for (int v = 0; v < window.height; v += 2)
      for (int u = 0; u < window.width; u += 2) sample.push_back(map.magnitude.at<float>(v, u));
    auto at = sample.begin() + static_cast<std::ptrdiff_t>(0.9 * static_cast<double>(sample.size()));
    std::nth_element(sample.begin(), at, sample.end());
    map.level = std::max(1.0, 0.5 * *at);
  }
  return map;
}

}  // namespace tumble::analysis
