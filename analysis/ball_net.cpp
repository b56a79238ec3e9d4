#include "analysis/ball_net.h"

#include <algorithm>
#include <cmath>

#include "analysis/conv_net.h"
#include "analysis/net_weights.h"

// Layers (train_ball_net.py has the same): 5 x 5 to a grid of 2 px, 3 x 3 to one of 4 px, four residual blocks of two
// 3 x 3 each, the first of a block dilated by 1, 2, 1, 2. What they found is spread onto the grid of 2 px again, put
// beside what the first layer saw there, and read by a 3 x 3 and a 1 x 1: seven maps.
namespace tumble::analysis {
namespace {

constexpr int kStride = 4, kFine = 16, kWidth = 32, kMaps = 7, kSubcells = 4;
constexpr int kSpread = 64, kJoined = kFine + kSpread / kSubcells;
enum Map { kHeat, kAlongU, kAlongV, kLogRadius, kVisible, kLogDeviation, kCover };
using Answer = cv::Vec<float, kMaps>;  // of one place

// The network for pictures of one size.
struct Layers {
  ConvNet net{ball_net_weights()};
  ConvNet::Memory input, output;

  Layers(int height, int width) {
    input = net.plain({1, 3, height, width});
    const auto fine = net.convolve(input, {kFine, 5, 2});
    auto x = net.convolve(fine, {kWidth, 3, 2});
    for (const int dilation : {1, 2, 1, 2}) net.add_convolved(net.convolve(x, {kWidth, 3, 1, dilation}), x, {kWidth});
    x = net.convolve(x, {kSpread, 1});
    const int h2 = height / 2, w2 = width / 2;
    const auto fine_maps = net.as_plain(fine), coarse_maps = net.as_plain(x);
    const auto both = net.plain({1, kJoined, h2, w2});
    net.call(
        [=] { spread(ConvNet::data_of(fine_maps), ConvNet::data_of(coarse_maps), h2, w2, ConvNet::data_of(both)); });
    x = net.convolve(net.convolve(both, {kFine}), {.channels = kMaps, .size = 1, .rectify = false});
    output = net.as_plain(x);
    net.check_complete();
  }

  // The coarse maps in fours onto the fine grid, behind the fine ones.
  static void spread(const float* fine, const float* coarse, int height, int width, float* both) {
    for (int i = 0; i < height; ++i)
      for (int j = 0; j < width; ++j) {
        both = std::copy_n(fine, kFine, both);
        fine += kFine;
        const float* cell = coarse + (i / 2 * (width / 2) + j / 2) * kSpread + 2 * (i % 2) + j % 2;
        for (int map = 0; map < kSpread / kSubcells; ++map) *both++ = cell[map * kSubcells];
      }
  }
};

// Of mean 0 and deviation about 1 over the picture: exposure does not matter.
void fill_input(const cv::Mat& bgr, float* input) {
  cv::Scalar mean, deviation;
  cv::meanStdDev(bgr.reshape(1), mean, deviation);
  const double scale = 1 / (deviation[0] + 8);
  cv::Mat filled(bgr.size(), CV_32FC3, input);
  bgr.convertTo(filled, CV_32F, scale, -mean[0] * scale);
}

}  // namespace

struct BallNet::Impl {
  cv::Size size;
  std::unique_ptr<Layers> layers;
};

BallNet::BallNet() : impl_(std::make_unique<Impl>()) {}
BallNet::~BallNet() = default;

BallSight BallNet::look(const cv::Mat& picture, double least_score) {
  // The picture is continued to a whole number of cells.
  const cv::Size whole((picture.cols + kStride - 1) / kStride * kStride,
                       (picture.rows + kStride - 1) / kStride * kStride);
  cv::Mat bgr = picture;
  if (whole != picture.size())
    cv::copyMakeBorder(picture, bgr, 0, whole.height - picture.rows, 0, whole.width - picture.cols,
                       cv::BORDER_REPLICATE);
  if (impl_->size != whole) {
    impl_->layers = std::make_unique<Layers>(whole.height, whole.width);
    impl_->size = whole;
  }
  fill_input(bgr, ConvNet::data_of(impl_->layers->input));
  impl_->layers->net.run();
  const int h = whole.height / 2, w = whole.width / 2;  // a grid of 2 px
  const cv::Mat_<Answer> answers(h, w, reinterpret_cast<Answer*>(ConvNet::data_of(impl_->layers->output)));
  BallSight sight;
  cv::extractChannel(answers, sight.charge, kCover);
  cv::exp(-sight.charge, sight.charge);
  sight.charge = 1 / (1 + sight.charge);

  const double least = std::log(least_score / (1 - least_score));
  for (int i = 0; i < h; ++i)
    for (int j = 0; j < w; ++j) {
      const Answer& at = answers(i, j);
      if (at[kHeat] < least) continue;
      bool peak = true;
      for (int a = std::max(0, i - 1); peak && a <= std::min(h - 1, i + 1); ++a)
        for (int b = std::max(0, j - 1); peak && b <= std::min(w - 1, j + 1); ++b)
          peak = answers(a, b)[kHeat] <= at[kHeat];
      if (!peak) continue;
      SeenBall ball;
      ball.u = 2.0 * (j + static_cast<double>(at[kAlongU])) + 0.5;
      ball.v = 2.0 * (i + static_cast<double>(at[kAlongV])) + 0.5;
      ball.radius = kNetRadius * std::exp(at[kLogRadius]);
      ball.score = sigmoid(at[kHeat]);
      ball.visible = sigmoid(at[kVisible]);
      ball.deviation = 2 * std::exp(std::clamp(at[kLogDeviation], -5.0f, 3.0f));
      sight.balls.push_back(ball);
    }
  // One ball, one peak: of two that lie within each other the clearer stays.
  std::stable_sort(sight.balls.begin(), sight.balls.end(),
                   [](const SeenBall& a, const SeenBall& b) { return a.score > b.score; });
  std::vector<SeenBall> distinct;
  for (const SeenBall& b : sight.balls)
    if (std::none_of(distinct.begin(), distinct.end(), [&](const SeenBall& d) {
          return std::hypot(b.u - d.u, b.v - d.v) < 0.4 * std::min(b.radius, d.radius);
        }))
      distinct.push_back(b);
  sight.balls = std::move(distinct);
  return sight;
}

}  // namespace tumble::analysis
