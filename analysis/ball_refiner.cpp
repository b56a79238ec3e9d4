#include "analysis/ball_refiner.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "analysis/conv_net.h"
#include "analysis/net_weights.h"

// Layers (train_ball_refiner.py has the same): 3 x 3 on the patch of 24 px, twice a 3 x 3 that halves it and a residual
// 3 x 3, one 6 x 6 that sees all that is left, and five numbers: shift along u and v in radii, log of its deviation,
// log of the radius over the one supposed, visible share.
namespace tumble::analysis {
namespace {

constexpr int kPatch = 24, kBatch = 8, kAnswers = 5;

// The patch round a ball, of mean 0 and deviation about 1. Linear between pixels, first along the rows.
void fill_patch(const cv::Mat& bgr, double u, double v, float* input) {
  constexpr int kRow = 3 * kPatch;
  const double u0 = u - 0.5 * (kPatch - 1), v0 = v - 0.5 * (kPatch - 1);
  const cv::Rect from(std::clamp(static_cast<int>(std::floor(u0)), -kPatch, bgr.cols - 1),
                      std::clamp(static_cast<int>(std::floor(v0)), -kPatch, bgr.rows - 1), kPatch + 1, kPatch + 1);
  const auto fu = static_cast<float>(u0 - std::floor(u0)), fv = static_cast<float>(v0 - std::floor(v0));
  const cv::Rect inside = from & cv::Rect({0, 0}, bgr.size());
  cv::Mat part = bgr(inside);
  if (inside != from)
    cv::copyMakeBorder(part, part, inside.y - from.y, from.br().y - inside.br().y, inside.x - from.x,
                       from.br().x - inside.br().x, cv::BORDER_REPLICATE | cv::BORDER_ISOLATED);
  std::array<std::array<float, kRow>, kPatch + 1> rows;
  for (int i = 0; i <= kPatch; ++i) {
    const uchar* levels = part.ptr<uchar>(i);
    auto& row = rows[static_cast<std::size_t>(i)];
    for (int k = 0; k < kRow; ++k)
      row[static_cast<std::size_t>(k)] =
          (1 - fu) * static_cast<float>(levels[k]) + fu * static_cast<float>(levels[k + 3]);
  }
  using Row = Eigen::Array<float, kRow, 1>;
  Eigen::Map<Eigen::Array<float, kRow, kPatch>> patch(input);
  for (int i = 0; i < kPatch; ++i)
    patch.col(i) = (1 - fv) * Eigen::Map<const Row>(rows[static_cast<std::size_t>(i)].data()) +
                   fv * Eigen::Map<const Row>(rows[static_cast<std::size_t>(i) + 1].data());
  patch -= patch.mean();
  patch *= 1 / (std::sqrt(patch.square().mean()) + 6);
}

}  // namespace

struct BallRefiner::Impl {
  ConvNet net{ball_refiner_weights()};
  ConvNet::Memory input, output;

  Impl() {
    input = net.plain({kBatch, 3, kPatch, kPatch});
    auto x = net.convolve(net.convolve(input, {16}), {32, 3, 2});
    const auto half = net.copy(x);
    net.add_convolved(x, half, {32});
    x = net.convolve(half, {64, 3, 2});
    const auto quarter = net.copy(x);
    net.add_convolved(x, quarter, {64});
    x = net.convolve(quarter, {.channels = 64, .size = kPatch / 4, .padded = false});
    x = net.convolve(x, {.channels = kAnswers, .size = 1, .rectify = false});
    output = net.as_plain(x);
    net.check_complete();
  }
};

BallRefiner::BallRefiner() : impl_(std::make_unique<Impl>()) {}
BallRefiner::~BallRefiner() = default;

void BallRefiner::refine(const cv::Mat& bgr, std::span<SeenBall> balls) {
  float* patches = ConvNet::data_of(impl_->input);
  const float* answers = ConvNet::data_of(impl_->output);
  for (std::size_t from = 0; from < balls.size(); from += kBatch) {
    const std::size_t n = std::min<std::size_t>(kBatch, balls.size() - from);
    for (std::size_t i = 0; i < n; ++i)
      fill_patch(bgr, balls[from + i].u, balls[from + i].v, patches + i * 3 * kPatch * kPatch);
    impl_->net.run();
    for (std::size_t i = 0; i < n; ++i) {
      const float* a = answers + i * kAnswers;
      SeenBall& b = balls[from + i];
      b.u += kNetRadius * std::clamp(static_cast<double>(a[0]), -0.5, 0.5);
      b.v += kNetRadius * std::clamp(static_cast<double>(a[1]), -0.5, 0.5);
      b.deviation = kNetRadius * std::exp(std::clamp(static_cast<double>(a[2]), -6.0, 1.0));
      b.radius = kNetRadius * std::exp(std::clamp(static_cast<double>(a[3]), -0.5, 0.5));
      b.visible = sigmoid(a[4]);
    }
  }
}

}  // namespace tumble::analysis
