#pragma once
#include <opencv2/core.hpp>
#include <vector>

namespace tumble::analysis {

// Gradients of a colour picture: of every pixel those of the channel that changes most there, so that balls of any
// colour stand out from any ground.
struct EdgeMap {
  cv::Mat gradient;  // CV_32FC2 (along u, along v), grey levels per pixel, towards the brighter side
  cv::Point origin;  // of the window within the picture [px]
  double level = 1;  // magnitude that counts as half a full edge: weight = m / (m + level)

  // Gradient component along (nu, nv) at a place of the picture, bilinear; 0 outside the window.
  float along(float u, float v, float nu, float nv) const {
    const float x = u - static_cast<float>(origin.x), y = v - static_cast<float>(origin.y);
    const int i = static_cast<int>(x), j = static_cast<int>(y);
    if (!(x >= 0 && y >= 0) || i + 1 >= gradient.cols || j + 1 >= gradient.rows) return 0;
    const float fx = x - static_cast<float>(i), fy = y - static_cast<float>(j);
    const float* a = gradient.ptr<float>(j) + 2 * i;
    const float* b = gradient.ptr<float>(j + 1) + 2 * i;
    const float above = (1 - fx) * (nu * a[0] + nv * a[1]) + fx * (nu * a[2] + nv * a[3]);
    const float below = (1 - fx) * (nu * b[0] + nv * b[1]) + fx * (nu * b[2] + nv * b[3]);
    return (1 - fy) * above + fy * below;
  }
};

// `window`: the part of the picture to look at. `level` <= 0: found from the window itself.
EdgeMap make_edge_map(const cv::Mat& bgr, const cv::Rect& window, double blur, double level);

}  // namespace tumble::analysis
