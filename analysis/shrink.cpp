#include "analysis/shrink.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace tumble::analysis {
namespace {

struct Share {  // of a source pixel in the pixels of the result
  int to = 0, from = 0;
  float weight = 0;
};

// In the order of the result; weights of one pixel add up to 1.
std::vector<Share> shares_of(int from, int to) {
  std::vector<Share> shares;
  const double ratio = static_cast<double>(from) / to;
  for (int i = 0; i < to; ++i) {
    const double begin = i * ratio, end = std::min<double>(from, (i + 1) * ratio);
    for (int k = static_cast<int>(begin); k < end; ++k) {
      const double covered = std::min<double>(end, k + 1) - std::max<double>(begin, k);
      if (covered > 1e-6) shares.push_back({i, k, static_cast<float>(covered / (end - begin))});
    }
  }
  return shares;
}

}  // namespace

cv::Mat shrink(const cv::Mat& bgr, cv::Size size) {
  CV_Assert(bgr.type() == CV_8UC3 && size.width <= bgr.cols && size.height <= bgr.rows);
  const std::vector<Share> down = shares_of(bgr.rows, size.height), along = shares_of(bgr.cols, size.width);
  cv::Mat small(size, CV_8UC3);
  const int width = 3 * bgr.cols;
  std::vector<float> row(static_cast<std::size_t>(width)), sums(3 * static_cast<std::size_t>(size.width));
  for (auto share = down.begin(); share != down.end();) {
    const int v = share->to;
    std::fill(row.begin(), row.end(), 0.0f);
    for (; share != down.end() && share->to == v; ++share) {
      const uchar* from = bgr.ptr<uchar>(share->from);
      const float weight = share->weight;
      for (int i = 0; i < width; ++i) row[static_cast<std::size_t>(i)] += weight * static_cast<float>(from[i]);
    }
    std::fill(sums.begin(), sums.end(), 0.5f);  // rounds
    for (const Share& s : along) {
      const float* from = row.data() + 3 * s.from;
      float* to = sums.data() + 3 * s.to;
      for (int c = 0; c < 3; ++c) to[c] += s.weight * from[c];
    }
    uchar* to = small.ptr<uchar>(v);
    for (std::size_t i = 0; i < sums.size(); ++i) to[i] = static_cast<uchar>(static_cast<int>(sums[i]));
  }
  return small;
}

}  // namespace tumble::analysis
