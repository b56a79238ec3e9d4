#include "analysis/charge_mask.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/angle.h"
#include "core/config.h"

namespace tumble::analysis {
namespace {

constexpr int kLevels = 16;  // of each colour channel
constexpr int kRounds = 4;   // of learning from what was just recognised

using Histogram = std::vector<double>;  // over kLevels^3 colours

std::size_t colour_bin(const cv::Vec3b& lab) {
  return (static_cast<std::size_t>(lab[0]) / 16 * kLevels + lab[1] / 16u) * kLevels + lab[2] / 16u;
}

// Neighbouring colours vouch for each other.
Histogram smoothed(const Histogram& h) {
  Histogram result(h.size(), 0.0);
  const auto at = [&](int a, int b, int c) {
    if (a < 0 || b < 0 || c < 0 || a >= kLevels || b >= kLevels || c >= kLevels) return 0.0;
    return h[(static_cast<std::size_t>(a) * kLevels + b) * kLevels + c];
  };
  double total = 0;
  for (int a = 0; a < kLevels; ++a)
    for (int b = 0; b < kLevels; ++b)
      for (int c = 0; c < kLevels; ++c) {
        double sum = 4 * at(a, b, c);
        sum +=
            at(a - 1, b, c) + at(a + 1, b, c) + at(a, b - 1, c) + at(a, b + 1, c) + at(a, b, c - 1) + at(a, b, c + 1);
        result[(static_cast<std::size_t>(a) * kLevels + b) * kLevels + c] = sum;
        total += sum;
      }
  for (double& v : result) v /= std::max(1.0, total);
  return result;
}

}  // namespace

std::vector<cv::Mat> charge_shares(const std::vector<cv::Mat>& pictures,
                                   const std::vector<std::vector<Detection>>& balls, const Circle& mill) {
  std::vector<cv::Mat> lab(pictures.size()), charge(pictures.size());
  cv::Mat inside = cv::Mat::zeros(pictures.at(0).size(), CV_8U);
  constexpr int kShift = 4;
  const auto fixed = [](double x) { return static_cast<int>(std::lround(x * (1 << kShift))); };
  cv::circle(inside, {fixed(mill.u), fixed(mill.v)}, fixed(mill.radius), 255, cv::FILLED, cv::LINE_8, kShift);
  double radius = 0, count = 0;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    cv::cvtColor(pictures[i], lab[i], cv::COLOR_BGR2Lab);
    charge[i] = cv::Mat::zeros(inside.size(), CV_32F);
    for (const Detection& d : balls[i]) {
      cv::circle(charge[i], {fixed(d.u), fixed(d.v)}, fixed(0.8 * d.radius), 1.0, cv::FILLED, cv::LINE_8, kShift);
      radius += d.radius;
      count += 1;
    }
  }
  if (count > 0) radius /= count;
  // Start: balls found are charge, what is well away from them is not. Then what looks like charge around, is charge:
  // so the balls that were missed stop counting against their own colours.
  for (int round = 0; round < kRounds; ++round) {
    Histogram on(kLevels * kLevels * kLevels, 0.0), off = on;
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      cv::Mat around;
      if (round == 0) {
        const int reach = 2 * static_cast<int>(std::ceil(radius)) + 1;
        cv::dilate(charge[i], around, cv::getStructuringElement(cv::MORPH_ELLIPSE, {reach, reach}));
      } else {
        around = charge[i];
      }
      for (int v = 0; v < inside.rows; ++v)
        for (int u = 0; u < inside.cols; ++u) {
          if (!inside.at<uchar>(v, u)) continue;
          const std::size_t bin = colour_bin(lab[i].at<cv::Vec3b>(v, u));
          if (charge[i].at<float>(v, u) > 0.5f)
            on[bin] += 1;
          else if (around.at<float>(v, u) < 0.5f)
            off[bin] += 1;
        }
    }
    on = smoothed(on);
    off = smoothed(off);
    for (std::size_t i = 0; i < pictures.size(); ++i) {
      cv::Mat likely(inside.size(), CV_32F, cv::Scalar(0));
      for (int v = 0; v < inside.rows; ++v)
        for (int u = 0; u < inside.cols; ++u) {
          if (!inside.at<uchar>(v, u)) continue;
          const std::size_t bin = colour_bin(lab[i].at<cv::Vec3b>(v, u));
          constexpr double kUnseen = 1e-6;  // a colour never met says nothing
          likely.at<float>(v, u) = static_cast<float>((on[bin] + kUnseen) / (on[bin] + off[bin] + 2 * kUnseen));
        }
      // A ball is bright, dark and coloured in its parts: its pixels vote together.
      cv::GaussianBlur(likely, charge[i], {}, std::max(1.0, 0.35 * radius));
    }
  }
  return charge;
}

RingProfile mask_occupancy(const cv::Mat& share, const Circle& mill, const Ring& ring, bool mirror) {
  RingProfile profile;
  constexpr int kPerBin = 8;
  const int radii = std::max(4, static_cast<int>(std::ceil(2 * (ring.outer - ring.inner))));
  for (std::size_t bin = 0; bin < profile.size(); ++bin) {
    double sum = 0, seen = 0;
    for (int k = 0; k < kPerBin; ++k) {
      const double a = radians(static_cast<double>(bin) + (k + 0.5) / kPerBin);
      for (int j = 0; j < radii; ++j) {
        const double r = ring.inner + (ring.outer - ring.inner) * (j + 0.5) / radii;
        const int u = static_cast<int>(std::lround(mill.u + (mirror ? -1 : 1) * r * std::cos(a)));
        const int v = static_cast<int>(std::lround(mill.v - r * std::sin(a)));
        if (u < 0 || v < 0 || u >= share.cols || v >= share.rows) continue;
        seen += r;
        if (share.at<float>(v, u) > 0.5f) sum += r;
      }
    }
    profile[bin] = seen > 0 ? sum / seen : kNotGiven;
  }
  return profile;
}

}  // namespace tumble::analysis
