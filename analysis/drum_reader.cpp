#include "analysis/drum_reader.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/quantile.h"
#include "core/units.h"

namespace tumble::analysis {

cv::Mat reduced_grey(const cv::Mat& bgr, int times) {
  cv::Mat small, grey;
  if (times > 1)
    cv::resize(bgr, small, {bgr.cols / times, bgr.rows / times}, 0, 0, cv::INTER_AREA);
  else
    small = bgr;
  cv::cvtColor(small, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

DrumReader::DrumReader(const DrumPose& pose, const PolarGrid& grid, int reduced, const std::vector<cv::Mat>& greys,
                       const std::vector<double>& angles, double blur, int margin)
    : unroll_(pose, grid), reduced_(reduced) {
  for (const cv::Mat& grey : greys) strips_.push_back(unroll_(grey));
  still_ = std::make_unique<StillPart>(find_still_part(strips_));
  texture_ = std::make_unique<DrumTexture>(unroll_, *still_, blur);
  for (std::size_t t = 0; t < strips_.size(); ++t) {
    moving_.push_back(texture_->moving_part(strips_[t]));
    texture_->add(moving_.back(), angles[t]);
  }
  texture_->finish(margin);
  pattern_ = RoundSpectrum(texture_->pattern());
}

DrumAngle DrumReader::operator()(const cv::Mat& bgr, double expected, double step) const {
  const cv::Mat moving = texture_->moving_part(unroll_(reduced_grey(bgr, reduced_)));
  return refined(moving, angle_of(pattern_, RoundSpectrum(moving), expected, step));
}

DrumAngle DrumReader::angle_near(const cv::Mat& strip, double expected, double reach) const {
  const cv::Mat moving = texture_->moving_part(strip);
  return refined(moving, analysis::angle_near(pattern_, RoundSpectrum(moving), expected, reach));
}

double DrumReader::alike() const {
  constexpr double kAlike = 0.2;  // as light may shift a texture where the camera is fitted [px]
  double radius = 0;
  for (int k = 0; k < texture_->pieces(); ++k) radius += texture_->piece(k).radius / texture_->pieces();
  return radius > 0 ? kAlike / radius : 0.0;
}

DrumAngle DrumReader::refined(const cv::Mat& moving, double rough) const {
  const double pitch = unroll_.grid().pitch();
  DrumAngle result{rough, kNotGiven, 0};
  const auto found = texture_->find(moving, rough);
  struct Say {
    double turn, weight;
    std::size_t part;
  };
  std::vector<Say> says;
  for (int k = 0; k < texture_->pieces(); ++k) {
    const auto& f = found[static_cast<std::size_t>(k)];
    if (!f.seen) continue;
    const double r = texture_->piece(k).radius;
    // Across alone, whatever the shift along the radius: the camera is known by now, but a layer's depth need not be.
    says.push_back({f.across / r, (f.weight(1, 1) - f.weight(0, 1) * f.weight(1, 0) / f.weight(0, 0)) * r * r,
                    static_cast<std::size_t>(k % DrumTexture::kPieces) * DrumAngle::kParts / DrumTexture::kPieces});
  }
  if (says.size() < 4) return result;
  double middle = 0, scale = 1e300;
  std::vector<double> misses(says.size());
  const auto say_of = [&](const Say& s) {
    const double k = (s.turn - middle) / (4 * scale);
    return std::abs(k) < 1 ? s.weight * (1 - k * k) * (1 - k * k) : 0.0;
  };
  for (int round = 0; round < 8; ++round) {
    double sum = 0, weights = 0;
    for (const Say& s : says) {
      const double w = say_of(s);
      sum += w * s.turn;
      weights += w;
    }
    if (!(weights > 0)) return result;
    middle = sum / weights;
    for (std::size_t i = 0; i < says.size(); ++i) misses[i] = std::abs(says[i].turn - middle);
    scale = std::max(1e-6, 1.48 * median_of(misses));
    result.pieces = static_cast<int>(
        std::count_if(says.begin(), says.end(), [&](const Say& s) { return std::abs(s.turn - middle) < 4 * scale; }));
    // Pieces of a band overlap by half: neighbours do not err independently.
    result.error = scale * std::sqrt(2.0 / std::max(1, result.pieces));
  }
  std::array<double, DrumAngle::kParts> sum{}, weights{};
  for (const Say& s : says) {
    const double w = say_of(s);
    sum[s.part] += w * (s.turn - middle);
    weights[s.part] += w;
  }
  for (std::size_t part = 0; part < DrumAngle::kParts; ++part) {
    if (!(weights[part] > 0)) continue;
    result.part_turn[part] = static_cast<float>(sum[part] / weights[part]);
    result.part_say[part] = static_cast<float>(weights[part]);
  }
  // The texture was looked for at whole columns.
  result.angle = static_cast<double>(std::lround(rough / pitch)) * pitch + middle;
  return result;
}

}  // namespace tumble::analysis
