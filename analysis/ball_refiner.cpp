#include "analysis/ball_refiner.h"

#include <algorithm>
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

// The patch round a ball, of mean 0 and deviation about 1.
void fill_patch(const cv::Mat& bgr, double u, double v, float* input) {
  cv::Mat patch(kPatch, kPatch, CV_32FC3, input);
  cv::getRectSubPix(bgr, patch.size(), {static_cast<float>(u), static_cast<float>(v)}, patch, CV_32F);
  cv::Scalar mean, deviation;
  cv::meanStdDev(patch.reshape(1), mean, deviation);
  const double scale = 1 / (deviation[0] + 6);
  patch.convertTo(patch, CV_32F, scale, -mean[0] * scale);
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
