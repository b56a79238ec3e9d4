#include "analysis/drum_texture.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/units.h"

namespace tumble::analysis {
namespace {

constexpr double kLeastTexture = 1.0;  // deviation of a piece's greys below which it is not followed [grey levels]
constexpr double kLeastPower = 0.5;    // of a row's changes [grey levels squared]: below is noise
constexpr double kTextured = 0.6;      // of the best row's share of texture in what moves
constexpr int kLeastRows = 4, kMostRows = 14;  // of a band
constexpr double kBestDeviation = 0.03;        // no piece is better placed than this [px]: interpolation, compression

cv::Mat blurred(const cv::Mat& strip, double blur) {  // the ring closes on itself
  if (blur < 0.3) return strip;
  const int margin = static_cast<int>(std::ceil(3 * blur));
  cv::Mat wide, smooth;
  cv::copyMakeBorder(strip, wide, 0, 0, margin, margin, cv::BORDER_WRAP);
  cv::GaussianBlur(wide, smooth, {}, blur, blur, cv::BORDER_REPLICATE);
  return smooth.colRange(margin, margin + strip.cols).clone();
}

long wrapped(long column, long columns) { return ((column % columns) + columns) % columns; }

}  // namespace

double PolarGrid::pitch() const { return 2 * kPi / columns; }

Unroller::Unroller(const DrumPose& pose, const PolarGrid& grid) : pose_(pose), grid_(grid) {
  cv::Mat u(grid.rows, grid.columns, CV_32F), v(grid.rows, grid.columns, CV_32F);
  in_view_.create(grid.rows, grid.columns, CV_8U);
  const MillCamera camera = pose.camera();
  for (int r = 0; r < grid.rows; ++r)
    for (int k = 0; k < grid.columns; ++k) {
      const cv::Point2d p = pose.picture_of(camera, grid.radius(r), k * grid.pitch(), 0);
      const bool inside = p.x >= 0 && p.y >= 0 && p.x <= pose.picture.width - 1 && p.y <= pose.picture.height - 1;
      in_view_.at<uchar>(r, k) = inside ? 255 : 0;
      u.at<float>(r, k) = inside ? static_cast<float>(p.x) : -10.0F;
      v.at<float>(r, k) = inside ? static_cast<float>(p.y) : -10.0F;
    }
  cv::convertMaps(u, v, coarse_map_, fine_map_, CV_16SC2);
}

cv::Mat Unroller::operator()(const cv::Mat& grey) const {
  cv::Mat strip;
  cv::remap(grey, strip, coarse_map_, fine_map_, cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar::all(0));
  return strip;
}

StillPart find_still_part(const std::vector<cv::Mat>& strips) {
  StillPart still;
  still.mean = cv::Mat::zeros(strips[0].size(), CV_32F);
  cv::Mat squares = cv::Mat::zeros(strips[0].size(), CV_32F);
  for (const cv::Mat& s : strips) {
    cv::accumulate(s, still.mean);
    cv::accumulateSquare(s, squares);
  }
  const double n = static_cast<double>(strips.size());
  still.mean /= n;
  cv::Mat variance = squares / n - still.mean.mul(still.mean);
  cv::max(variance, 0, variance);
  cv::sqrt(variance, still.deviation);
  return still;
}

DrumTexture::DrumTexture(const Unroller& unroll, const StillPart& still, double blur)
    : unroll_(&unroll), still_(&still), blur_(blur), camera_(unroll.pose().camera()) {
  const PolarGrid& g = unroll.grid();
  sum_ = cv::Mat::zeros(g.rows, g.columns, CV_32F);
  weight_ = cv::Mat::zeros(g.rows, g.columns, CV_32F);
  unroll.in_view().convertTo(view_, CV_32F, 1.0 / 255);
  power_.assign(static_cast<std::size_t>(g.rows), 0.0);
}

long DrumTexture::columns_of(double angle) const { return std::lround(angle / unroll_->grid().pitch()); }

cv::Mat DrumTexture::moving_part(const cv::Mat& strip) const {
  cv::Mat moving;
  cv::subtract(strip, still_->mean, moving, unroll_->in_view(), CV_32F);
  cv::Mat out = unroll_->in_view() == 0;
  moving.setTo(0, out);
  return blurred(moving, blur_);
}

void DrumTexture::add(const cv::Mat& moving, double angle) {
  const int n = static_cast<int>(wrapped(columns_of(angle), moving.cols));
  // The drum's column j is seen in column j + n.
  const auto turn = [&](const cv::Mat& from, cv::Mat& to) {
    to.colRange(0, from.cols - n) += from.colRange(n, from.cols);
    if (n > 0) to.colRange(from.cols - n, from.cols) += from.colRange(0, n);
  };
  turn(moving, sum_);
  turn(view_, weight_);
  for (int r = 0; r < moving.rows; ++r) power_[static_cast<std::size_t>(r)] += cv::norm(moving.row(r), cv::NORM_L2SQR);
}

void DrumTexture::finish(int margin) {
  pattern_ = sum_ / cv::max(weight_, 1.0);
  const PolarGrid& g = unroll_->grid();
  double best = 0;
  for (int r = 0; r < g.rows; ++r) {
    const double row_weight = cv::sum(weight_.row(r))[0], row = power_[static_cast<std::size_t>(r)];
    double held = 0;
    for (int k = 0; k < g.columns; ++k)
      held += weight_.at<float>(r, k) * pattern_.at<float>(r, k) * pattern_.at<float>(r, k);
    coherence_.push_back(row > kLeastPower * row_weight ? held / row : 0.0);
    best = std::max(best, coherence_.back());
  }
  // Runs of rows whose changes are mostly texture, without their margins, in bands of nearly equal height.
  for (int r = 0; r < g.rows;) {
    const auto textured = [&](int row) { return coherence(row) > kTextured * best; };
    if (best == 0 || !textured(r)) {
      ++r;
      continue;
    }
    const int first = r;
    while (r < g.rows && textured(r)) ++r;
    const int thin = std::max(0, std::min(margin, (r - first - kLeastRows) / 2));
    const int from = first == 0 ? 0 : first + thin, rows = (r == g.rows ? r : r - thin) - from;
    if (rows < kLeastRows) continue;
    const int parts = (rows + kMostRows - 1) / kMostRows;
    for (int i = 0; i < parts; ++i) bands_.emplace_back(from + i * rows / parts, from + (i + 1) * rows / parts);
  }
  // Places out of the picture, summed along the columns of each band.
  out_of_view_ = cv::Mat::zeros(static_cast<int>(bands_.size()) + 1, 2 * g.columns + 1, CV_32S);
  for (int b = 0; b < static_cast<int>(bands_.size()); ++b)
    for (int k = 0; k < 2 * g.columns; ++k) {
      int out = 0;
      for (int r = bands_[b].start; r < bands_[b].end; ++r) out += unroll_->in_view().at<uchar>(r, k % g.columns) == 0;
      out_of_view_.at<int>(b, k + 1) = out_of_view_.at<int>(b, k) + out;
    }
  const int columns = pattern_.cols;
  cv::Mat wide;
  cv::copyMakeBorder(pattern_, wide, 1, 1, 1, 1, cv::BORDER_WRAP);
  for (cv::Mat row : {wide.row(0), wide.row(wide.rows - 1)}) row.setTo(0);
  wide.row(1).copyTo(wide.row(0));
  wide.row(wide.rows - 2).copyTo(wide.row(wide.rows - 1));
  const cv::Rect middle(1, 1, columns, pattern_.rows);
  by_row_ = 0.5 * (wide(middle + cv::Point(0, 1)) - wide(middle - cv::Point(0, 1)));
  by_column_ = 0.5 * (wide(middle + cv::Point(1, 0)) - wide(middle - cv::Point(1, 0)));
  windows_.assign(static_cast<std::size_t>(pieces()), {});
  for (int k = 0; k < pieces(); ++k) {
    const int band = k / kPieces, first = (k % kPieces) * columns / kPieces - kPieceColumns / 2;
    Eigen::Matrix4d gram = Eigen::Matrix4d::Zero();
    for (int r = bands_[band].start; r < bands_[band].end; ++r)
      for (int c = first; c < first + kPieceColumns; ++c) {
        const int j = static_cast<int>(wrapped(c, columns));
        const Eigen::Vector4d x(1, pattern_.at<float>(r, j), by_row_.at<float>(r, j), by_column_.at<float>(r, j));
        gram += x * x.transpose();
      }
    Window& w = windows_[static_cast<std::size_t>(k)];
    w.gram = gram;
    const double n = gram(0, 0), variance = gram(1, 1) / n - std::pow(gram(0, 1) / n, 2);
    w.usable = variance > kLeastTexture * kLeastTexture;
    const Eigen::Vector4d scale(1e-6 * n, 1e-6 * gram(1, 1), 1e-4 * gram(1, 1), 1e-4 * gram(1, 1));
    w.inverse = (gram + Eigen::Matrix4d(scale.asDiagonal())).inverse();
  }
}

int DrumTexture::surface(int band) const {
  int number = 0;
  for (int b = static_cast<int>(bands_.size()) - 1; b > band; --b) number += bands_[b].start != bands_[b - 1].end;
  return number;
}

DrumPiece DrumTexture::piece(int index) const {
  const PolarGrid& g = unroll_->grid();
  const int band = index / kPieces;
  DrumPiece p;
  p.radius = g.radius(0.5 * (bands_[band].start + bands_[band].end - 1));
  p.angle = ((index % kPieces) * g.columns / kPieces - 0.5) * g.pitch();
  p.layer = surface(band);
  return p;
}

std::vector<DrumTexture::Found> DrumTexture::find(const cv::Mat& moving, double angle) const {
  const PolarGrid& g = unroll_->grid();
  const long n = columns_of(angle);
  std::vector<Found> all(static_cast<std::size_t>(pieces()));
  // Sums down the rows of a band, then running sums along the drum's columns.
  std::vector<std::array<double, 5>> running(static_cast<std::size_t>(g.columns + kPieceColumns) + 1);
  for (int band = 0; band < static_cast<int>(bands_.size()); ++band) {
    std::vector<std::array<double, 5>> column(static_cast<std::size_t>(g.columns), {0, 0, 0, 0, 0});
    for (int r = bands_[band].start; r < bands_[band].end; ++r) {
      const float *f = moving.ptr<float>(r), *m = pattern_.ptr<float>(r), *a = by_row_.ptr<float>(r),
                  *b = by_column_.ptr<float>(r);
      int from = static_cast<int>(wrapped(n, g.columns));
      for (int j = 0; j < g.columns; ++j) {
        const float x = f[from];
        if (++from == g.columns) from = 0;
        auto& s = column[static_cast<std::size_t>(j)];
        s[0] += x;
        s[1] += x * m[j];
        s[2] += x * a[j];
        s[3] += x * b[j];
        s[4] += x * x;
      }
    }
    const int half = kPieceColumns / 2;
    running[0] = {0, 0, 0, 0, 0};
    for (int j = 0; j < g.columns + kPieceColumns; ++j)
      for (std::size_t i = 0; i < 5; ++i)
        running[static_cast<std::size_t>(j) + 1][i] =
            running[static_cast<std::size_t>(j)][i] + column[static_cast<std::size_t>(wrapped(j - half, g.columns))][i];
    for (int k = 0; k < kPieces; ++k) {
      const int index = band * kPieces + k, first = k * g.columns / kPieces;  // in running sums
      const Window& w = windows_[static_cast<std::size_t>(index)];
      if (!w.usable) continue;
      const int lab = static_cast<int>(wrapped(first - half + n, g.columns));
      if (out_of_view_.at<int>(band, lab + kPieceColumns) - out_of_view_.at<int>(band, lab) > 0) continue;
      std::array<double, 5> s;
      for (std::size_t i = 0; i < 5; ++i)
        s[i] =
            running[static_cast<std::size_t>(first + kPieceColumns)][i] - running[static_cast<std::size_t>(first)][i];
      const Eigen::Vector4d y(s[0], s[1], s[2], s[3]);
      const Eigen::Vector4d x = w.inverse * y;
      const double count = w.gram(0, 0);
      const double mm = w.gram(1, 1) - w.gram(0, 1) * w.gram(0, 1) / count;
      const double ff = s[4] - s[0] * s[0] / count, fm = s[1] - s[0] * w.gram(0, 1) / count;
      Found& found = all[static_cast<std::size_t>(index)];
      const double rest = std::max(0.0, s[4] - 2 * x.dot(y) + x.dot(w.gram * x));
      const double explained = ff > 0 ? 1 - rest / ff : 0;
      found.likeness = fm > 0 && ff > 0 ? std::sqrt(std::max(0.0, explained)) : fm / std::sqrt(std::max(1e-9, ff * mm));
      if (!(x[1] > 0.2) || x[1] > 5 || found.likeness < 0.6) continue;
      found.along_radius = -x[2] / x[1];
      found.across = -x[3] / x[1] * g.pitch() * piece(index).radius;
      const double stretch = g.pitch() * piece(index).radius;  // px along a column step
      // Covariance of the two shifts given offset and gain.
      const double noise2 = std::max(0.25, rest / std::max(1.0, count - 4));
      Eigen::Matrix2d covariance = w.inverse.bottomRightCorner<2, 2>() * (noise2 / (x[1] * x[1]));
      covariance.row(1) *= stretch;
      covariance.col(1) *= stretch;
      covariance.diagonal().array() += kBestDeviation * kBestDeviation;
      found.weight = covariance.inverse();
      found.grey_deviation = std::sqrt(noise2);
      const double far = std::max(2.0, 2.5 * blur_);
      found.seen = std::abs(found.along_radius) < far && std::abs(found.across) < far;
    }
  }
  return all;
}

cv::Point2d DrumTexture::pixel_of(int index, double angle, const Found& found) const {
  const DrumPiece p = piece(index);
  const PolarGrid& g = unroll_->grid();
  const double lab = p.angle + static_cast<double>(columns_of(angle)) * g.pitch() + found.across / p.radius;
  return unroll_->pose().picture_of(camera_, p.radius + found.along_radius, lab, 0);
}

}  // namespace tumble::analysis
