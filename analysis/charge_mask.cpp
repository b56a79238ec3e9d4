#include "analysis/charge_mask.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/angle.h"
#include "core/config.h"

namespace tumble::analysis {

cv::Mat charge_share(const Detections& seen, cv::Size picture) {
  cv::Mat share = cv::Mat::zeros(picture, CV_32F);
  if (!seen.charge.empty()) {
    cv::Mat part;
    cv::resize(seen.charge, part, seen.window.size(), 0, 0, cv::INTER_LINEAR);
    part.copyTo(share(seen.window));
  }
  return share;
}

void cover_discs(cv::Mat& share, const std::vector<Detection>& balls, const MillView& view) {
  for (const Detection& d : balls) {
    const cv::Point2d at = true_centre(d, view);
    const double r = view.radii[static_cast<std::size_t>(d.size_class)];
    for (int v = std::max(0, cvCeil(at.y - r)); v <= std::min(share.rows - 1, cvFloor(at.y + r)); ++v)
      for (int u = std::max(0, cvCeil(at.x - r)); u <= std::min(share.cols - 1, cvFloor(at.x + r)); ++u)
        if (std::hypot(u - at.x, v - at.y) <= r) share.at<float>(v, u) = 1;
  }
}

void add_charge_colours(std::vector<cv::Mat>& shares, const std::vector<cv::Mat>& pictures, const Circle& mill) {
  constexpr double kClear = 20;   // times as common in the charge as elsewhere
  constexpr float kNone = 0.05f;  // share of the charge where there is surely none
  constexpr int kBins = 16;       // per colour channel
  constexpr double kInside = 0.98;
  const auto cell = [](const cv::Vec3b& c) {
    return static_cast<std::size_t>((c[0] * kBins / 256 * kBins + c[1] * kBins / 256) * kBins + c[2] * kBins / 256);
  };
  const auto over_mill = [&](const auto& visit) {
    for (std::size_t i = 0; i < pictures.size(); ++i)
      for (int v = 0; v < pictures[i].rows; ++v)
        for (int u = 0; u < pictures[i].cols; ++u)
          if (std::hypot(u - mill.u, v - mill.v) < kInside * mill.radius)
            visit(cell(pictures[i].at<cv::Vec3b>(v, u)), shares[i].at<float>(v, u));
  };
  std::vector<double> charge(kBins * kBins * kBins, 0.0), empty(kBins * kBins * kBins, 1.0);  // one seen of each: rare
  double in_charge = 0, in_empty = static_cast<double>(empty.size());
  over_mill([&](std::size_t colour, float share) {
    if (share > 0.5f) charge[colour] += 1, in_charge += 1;
    if (share < kNone) empty[colour] += 1, in_empty += 1;
  });
  over_mill([&](std::size_t colour, float& share) {
    if (charge[colour] * in_empty > kClear * empty[colour] * in_charge) share = 1;
  });
}

std::vector<cv::Mat> two_tone_shares(const std::vector<cv::Mat>& pictures, const Circle& mill) {
  constexpr double kClear = 0.9;   // share of the variance that lies between the tones
  constexpr double kInner = 0.97;  // of the circle: its edge has a tone of its own
  std::vector<cv::Mat> greys;
  std::array<double, 256> histogram{};
  for (const cv::Mat& picture : pictures) {
    cv::Mat grey;
    cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
    for (int v = 0; v < grey.rows; ++v)
      for (int u = 0; u < grey.cols; ++u)
        if (std::hypot(u - mill.u, v - mill.v) < kInner * mill.radius) histogram[grey.at<uchar>(v, u)] += 1;
    greys.push_back(grey);
  }
  // The threshold that parts the pixels best (Otsu 1979), and the tones on its two sides.
  double n = 0, sum = 0, squares = 0;
  for (int i = 0; i < 256; ++i) {
    const double h = histogram[static_cast<std::size_t>(i)];
    n += h;
    sum += h * i;
    squares += h * i * i;
  }
  if (n < 100) return {};
  const double variance = squares / n - sum * sum / (n * n);
  double best = 0, dark = 0, bright = 0, below = 0, sum_below = 0;
  int threshold = 0;
  for (int i = 0; i + 1 < 256; ++i) {
    below += histogram[static_cast<std::size_t>(i)];
    sum_below += histogram[static_cast<std::size_t>(i)] * i;
    if (below == 0 || below == n) continue;
    const double low = sum_below / below, high = (sum - sum_below) / (n - below);
    const double between = below / n * (1 - below / n) * (high - low) * (high - low);
    if (between <= best) continue;
    best = between;
    threshold = i;
    dark = low;
    bright = high;
  }
  if (best < kClear * variance || bright - dark < 30) return {};
  double dark_rows = 0, dark_count = 0, bright_rows = 0, bright_count = 0;
  for (const cv::Mat& grey : greys)
    for (int v = 0; v < grey.rows; ++v)
      for (int u = 0; u < grey.cols; ++u) {
        if (std::hypot(u - mill.u, v - mill.v) >= kInner * mill.radius) continue;
        const bool is_dark = grey.at<uchar>(v, u) <= threshold;
        (is_dark ? dark_rows : bright_rows) += v;
        (is_dark ? dark_count : bright_count) += 1;
      }
  const bool bed_is_dark = dark_rows / dark_count > bright_rows / bright_count;
  std::vector<cv::Mat> shares;
  for (const cv::Mat& grey : greys) {
    cv::Mat share;
    const double slope = (bed_is_dark ? -1 : 1) / (bright - dark), air = bed_is_dark ? bright : dark;
    grey.convertTo(share, CV_32F, slope, -slope * air);
    shares.push_back(cv::max(0.0, cv::min(1.0, share)));
  }
  return shares;
}

ChargeShape charge_shape(const cv::Mat& share, const Circle& mill) {
  ChargeShape shape;
  double n = 0, u_sum = 0, v_sum = 0;
  for (int v = 0; v < share.rows; ++v)
    for (int u = 0; u < share.cols; ++u) {
      if (share.at<float>(v, u) <= 0.5f || std::hypot(u - mill.u, v - mill.v) > mill.radius) continue;
      n += 1;
      u_sum += u - mill.u;
      v_sum += v - mill.v;
    }
  shape.area = n;
  if (n > 0) shape.lean_deg = degrees(std::atan2(u_sum, v_sum));
  return shape;
}

RingProfile mask_occupancy(const cv::Mat& share, const Circle& mill, const Ring& ring, bool mirror) {
  RingProfile profile;
  constexpr int kPerBin = 8;
  constexpr double kSeen = 0.9;  // of a bin, by the picture: the part inside it is not like the rest
  const int radii = std::max(4, static_cast<int>(std::ceil(2 * (ring.outer - ring.inner))));
  for (std::size_t bin = 0; bin < profile.size(); ++bin) {
    double sum = 0, seen = 0, all = 0;
    for (int k = 0; k < kPerBin; ++k) {
      const double a = radians(static_cast<double>(bin) + (k + 0.5) / kPerBin);
      for (int j = 0; j < radii; ++j) {
        const double r = ring.inner + (ring.outer - ring.inner) * (j + 0.5) / radii;
        const int u = static_cast<int>(std::lround(mill.u + (mirror ? -1 : 1) * r * std::cos(a)));
        const int v = static_cast<int>(std::lround(mill.v - r * std::sin(a)));
        all += r;
        if (u < 0 || v < 0 || u >= share.cols || v >= share.rows) continue;
        seen += r;
        if (share.at<float>(v, u) > 0.5f) sum += r;
      }
    }
    profile[bin] = seen > kSeen * all ? sum / seen : kNotGiven;
  }
  return profile;
}

}  // namespace tumble::analysis
