#pragma once
#include <opencv2/core.hpp>
#include <vector>

namespace tumble::analysis {

// Gradients of a colour picture: of every pixel those of the channel that changes most there, so that balls of any
// colour stand out from any ground.
struct EdgeMap {
  cv::Mat gu, gv;     // CV_32F, grey levels per pixel, towards the brighter side
  cv::Mat magnitude;  // CV_32F
  cv::Point origin;   // of the window within the picture [px]
  double level = 1;   // magnitude that counts as half a full edge: weight = m / (m + level)

  // Gradient component along (nu, nv) at a place of the picture, bilinear; 0 outside the window.
  double along(double u, double v, double nu, double nv) const;
};

// `window`: the part of the picture to look at. `level` <= 0: found from the window itself.
EdgeMap make_edge_map(const cv::Mat& bgr, const cv::Rect& window, double blur, double level);

}  // namespace tumble::analysis
