#include "analysis/ball_detector.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "analysis/ball_rim.h"
#include "analysis/shrink.h"

namespace tumble::analysis {
namespace {

constexpr double kClassWidth = 0.05;    // spread of seen radii within a class, of the logarithm
constexpr double kCertain = 0.5;        // score of balls from which sizes are learned
constexpr std::size_t kLearnFrom = 4;   // pictures
constexpr double kLargestShare = 0.22;  // ball radius over drum radius, at most
constexpr double kLeastShare = 0.012;
constexpr double kWhole = 0.85;         // visible share of balls from which outlines are learned
constexpr double kSeenRim = 0.35;       // share of a ball's outline that must be seen
constexpr double kFarRim = 0.2;         // by which an outline may put a centre right [radii]
constexpr double kRimDeviation = 0.05;  // of a centre by its outline, at the least [px]

cv::Rect window_of(const Circle& bound, cv::Size size) {
  const int u0 = static_cast<int>(std::floor(bound.u - bound.radius)) - 2;
  const int v0 = static_cast<int>(std::floor(bound.v - bound.radius)) - 2;
  const int side = static_cast<int>(std::ceil(2 * bound.radius)) + 5;
  return cv::Rect(u0, v0, side, side) & cv::Rect({0, 0}, size);
}

// A part of a picture, scaled so that balls of a size come to the one that the networks know best.
struct Scaled {
  cv::Mat bgr;
  double u0 = 0, v0 = 0, scale_u = 1, scale_v = 1;

  void to_picture(SeenBall& b) const {
    b.u = (b.u + 0.5) / scale_u - 0.5 + u0;
    b.v = (b.v + 0.5) / scale_v - 0.5 + v0;
    b.radius /= std::sqrt(scale_u * scale_v);
    b.deviation /= std::sqrt(scale_u * scale_v);
  }
  void from_picture(SeenBall& b) const {
    b.u = (b.u - u0 + 0.5) * scale_u - 0.5;
    b.v = (b.v - v0 + 0.5) * scale_v - 0.5;
  }
};

Scaled scaled_for(const cv::Mat& bgr, const cv::Rect& window, double radius) {
  const double scale = kNetRadius / radius;
  const cv::Size size(std::max(16, static_cast<int>(std::lround(window.width * scale))),
                      std::max(16, static_cast<int>(std::lround(window.height * scale))));
  Scaled s;
  if (scale < 1)
    s.bgr = shrink(bgr(window), size);
  else
    cv::resize(bgr(window), s.bgr, size, 0, 0, cv::INTER_LINEAR);
  s.u0 = window.x;
  s.v0 = window.y;
  s.scale_u = static_cast<double>(size.width) / window.width;
  s.scale_v = static_cast<double>(size.height) / window.height;
  return s;
}

bool within(const SeenBall& b, const Circle& bound) {
  return std::hypot(b.u - bound.u, b.v - bound.v) + b.radius <= bound.radius;
}

// What speaks for a size: the area seen of its balls, that of doubtful ones hardly. One large "ball" made of many small
// ones is doubtful.
double area(const SeenBall& b) {
  const double sure = std::max(0.0, 2 * b.score - 1);
  return sure * sure * b.visible * b.radius * b.radius;
}

// How well classes of these radii explain what was seen, by area.
double explained(const std::vector<SeenBall>& seen, const std::vector<double>& radii) {
  double sum = 0;
  for (const SeenBall& b : seen) {
    double best = 0;
    for (double r : radii) best = std::max(best, std::exp(-0.5 * std::pow(std::log(b.radius / r) / kClassWidth, 2)));
    sum += best * area(b);
  }
  return sum;
}

std::vector<double> classes_of(const std::vector<SeenBall>& seen, const std::vector<double>& known, ScaleRange scales) {
  double smallest = 1e9, largest = 0, total = 0;
  for (const SeenBall& b : seen) {
    smallest = std::min(smallest, b.radius);
    largest = std::max(largest, b.radius);
    total += area(b);
  }
  std::vector<double> classes;
  if (!known.empty()) {  // one unknown: pixels per unit
    double best = 0, scale = 0;
    for (double s = smallest / known.back(); s < largest / known.front(); s *= 1.005) {
      if (s < scales.least || s > scales.most) continue;
      std::vector<double> radii;
      for (double r : known) radii.push_back(s * r);
      const double value = explained(seen, radii);
      if (value > best) {
        best = value;
        scale = s;
      }
    }
    if (scale > 0)
      for (double r : known) classes.push_back(scale * r);
    return classes;
  }
  // The size that explains most, then the next, as long as it explains a good share of what is left.
  double have = 0;
  while (classes.size() < 6) {
    double best = 0, radius = 0;
    for (double r = smallest; r < largest * 1.01; r *= 1.01) {
      auto more = classes;
      more.push_back(r);
      if (std::any_of(classes.begin(), classes.end(), [&](double c) { return std::abs(std::log(c / r)) < 0.15; }))
        continue;
      const double gain = explained(seen, more) - have;
      if (gain > best) {
        best = gain;
        radius = r;
      }
    }
    if (radius == 0 || (!classes.empty() && best < 0.06 * total)) break;
    classes.push_back(radius);
    have += best;
  }
  std::sort(classes.begin(), classes.end());
  return classes;
}

}  // namespace

BallLook learn_look(BallNet& net, const std::vector<cv::Mat>& pictures, const Circle& bound,
                    const std::vector<double>& known, ScaleRange scales) {
  BallLook look;
  if (pictures.empty()) return look;
  const cv::Rect window = window_of(bound, pictures.front().size());
  if (window.width < 32 || window.height < 32) return look;
  const auto see = [&](const cv::Mat& picture, double smallest) {
    const Scaled scaled = scaled_for(picture, window, smallest);
    std::vector<SeenBall> balls = net.look(scaled.bgr, kCertain).balls;
    for (SeenBall& b : balls) scaled.to_picture(b);
    // Far from the size that it knows, the net guesses.
    std::erase_if(balls, [&](const SeenBall& b) {
      return !within(b, bound) || b.radius < 0.7 * smallest || b.radius > 3 * smallest;
    });
    return balls;
  };
  // The size at which most of one picture is seen to be balls.
  double least = std::max(2.5, kLeastShare * bound.radius), most = kLargestShare * bound.radius;
  if (!known.empty()) {
    least = std::max(least, scales.least * known.front());
    most = std::min(most, scales.most * known.front());
  }
  double best = 0, smallest = 0;
  for (double r = std::min(most, 1.2 * least); r < 1.2 * most; r *= 1.45) {
    double sum = 0;
    for (const SeenBall& b : see(pictures[pictures.size() / 2], r)) sum += area(b);
    if (sum > best) {
      best = sum;
      smallest = r;
    }
  }
  if (smallest == 0) return look;
  for (int round = 0; round < 2; ++round) {  // the second at the scale that the first has found
    std::vector<SeenBall> seen;
    for (std::size_t i = 0; i < std::min(pictures.size(), kLearnFrom); ++i) {
      const auto here = see(pictures[i], smallest);
      seen.insert(seen.end(), here.begin(), here.end());
    }
    if (seen.empty()) return {};
    look.radii = classes_of(seen, known, scales);
    look.explained = explained(seen, look.radii);
    if (look.radii.empty()) return look;
    smallest = look.radii.front();
  }
  return look;
}

void learn_rims(BallEyes& eyes, const std::vector<cv::Mat>& pictures, const Circle& bound, BallLook& look) {
  std::vector<cv::Mat> greys;
  std::vector<std::vector<std::vector<cv::Point2d>>> centres(look.radii.size());  // by class, picture
  for (const cv::Mat& picture : pictures) {
    greys.push_back(grey_of(picture));
    for (auto& of_class : centres) of_class.emplace_back();
    for (const Detection& d : detect_balls(eyes, picture, look, bound, kCertain).balls)
      if (d.visible > kWhole) centres[static_cast<std::size_t>(d.size_class)].back().emplace_back(d.u, d.v);
  }
  for (std::size_t c = 0; c < centres.size(); ++c) look.rims.push_back(learn_rim(greys, centres[c], look.radii[c]));
}

Detections detect_balls(BallEyes& eyes, const cv::Mat& bgr, const BallLook& look, const Circle& bound,
                        double least_score) {
  Detections result;
  result.window = window_of(bound, bgr.size());
  if (look.radii.empty() || result.window.width < 32 || result.window.height < 32) return result;
  const Scaled scaled = scaled_for(bgr, result.window, look.radii.front());
  BallSight sight = eyes.net.look(scaled.bgr, least_score);
  result.charge = sight.charge;
  std::vector<std::vector<SeenBall>> classes(look.radii.size());
  for (SeenBall b : sight.balls) {
    scaled.to_picture(b);
    if (std::hypot(b.u - bound.u, b.v - bound.v) > bound.radius) continue;
    std::size_t nearest = 0;
    for (std::size_t c = 1; c < classes.size(); ++c)
      if (std::abs(std::log(b.radius / look.radii[c])) < std::abs(std::log(b.radius / look.radii[nearest])))
        nearest = c;
    classes[nearest].push_back(b);
  }
  cv::Mat grey;
  if (std::any_of(look.rims.begin(), look.rims.end(), [](double r) { return !std::isnan(r); })) grey = grey_of(bgr);
  for (std::size_t c = 0; c < classes.size(); ++c) {
    if (classes[c].empty()) continue;
    const Scaled at_size = c == 0 ? scaled : scaled_for(bgr, result.window, look.radii[c]);
    for (SeenBall& b : classes[c]) at_size.from_picture(b);
    eyes.refiner.refine(at_size.bgr, classes[c]);
    for (SeenBall& b : classes[c]) {
      at_size.to_picture(b);
      if (!grey.empty() && !std::isnan(look.rims[c])) {
        const RimFit fit = fit_rim(grey, {b.u, b.v}, look.rims[c]);
        if (fit.share > kSeenRim && std::hypot(fit.u - b.u, fit.v - b.v) < kFarRim * look.radii[c]) {
          b.u = fit.u;
          b.v = fit.v;
          b.deviation = std::max(kRimDeviation, fit.spread / std::sqrt(10 * fit.share));
        }
      }
      result.balls.push_back({b.u, b.v, look.radii[c], b.score, b.visible, b.deviation, static_cast<int>(c)});
    }
  }
  return result;
}

}  // namespace tumble::analysis
