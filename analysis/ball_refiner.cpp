#include "analysis/ball_refiner.h"

#include <algorithm>
#include <cmath>

#include "analysis/conv_net.h"
#include "analysis/net_weights.h"

// Layers (train_ball_refiner.py has the same): 3 x 3 on the patch of 24 px, twice a 3 x 3 that halves it and a residual
// 3 x 3, one 6 x 6 that sees all that is left, and five numbers: shift along u and v in radii, log of its deviation,
// log of the radius over the one supposed, visible share.
namespace tumble::analysis {
namespace {

constexpr int kPatch = 24, kBatch = 32, kAnswers = 5;

// The patch round a ball, of mean 0 and deviation about 1, as planes of blue, green and red.
void fill_patch(const cv::Mat& bgr, double u, double v, float* planes) {
  constexpr int n = kPatch * kPatch;
  const double u0 = u - 0.5 * (kPatch - 1), v0 = v - 0.5 * (kPatch - 1);
  double sum = 0, squares = 0;
  const int iu = static_cast<int>(std::floor(u0)), iv = static_cast<int>(std::floor(v0));
  const auto fu = static_cast<float>(u0 - iu), fv = static_cast<float>(v0 - iv);
  for (int i = 0; i < kPatch; ++i) {
    const std::uint8_t* above = bgr.ptr<std::uint8_t>(std::clamp(iv + i, 0, bgr.rows - 1));
    const std::uint8_t* below = bgr.ptr<std::uint8_t>(std::clamp(iv + i + 1, 0, bgr.rows - 1));
    for (int j = 0; j < kPatch; ++j) {
      const int left = 3 * std::clamp(iu + j, 0, bgr.cols - 1), right = 3 * std::clamp(iu + j + 1, 0, bgr.cols - 1);
      for (int c = 0; c < 3; ++c) {
        const float a = (1 - fu) * static_cast<float>(above[left + c]) + fu * static_cast<float>(above[right + c]);
        const float b = (1 - fu) * static_cast<float>(below[left + c]) + fu * static_cast<float>(below[right + c]);
        const float value = (1 - fv) * a + fv * b;
        planes[c * n + i * kPatch + j] = value;
        sum += value;
        squares += value * value;
      }
    }
  }
  const double mean = sum / (3 * n), deviation = std::sqrt(std::max(0.0, squares / (3 * n) - mean * mean));
  const auto shift = static_cast<float>(mean), scale = static_cast<float>(1 / (deviation + 6));
  for (int k = 0; k < 3 * n; ++k) planes[k] = (planes[k] - shift) * scale;
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
    output = net.copy(x, net.plain({kBatch, kAnswers, 1, 1}));
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
