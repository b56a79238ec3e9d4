#include "analysis/frame_clock.h"
#include "core/quantile.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace tumble::analysis {
namespace {

constexpr int kReference = 12;            // frames to each side that a picture difference is compared with
constexpr double kRepeat = 0.5;           // of the usual difference: more is no repeat unless the drum says so
constexpr double kOdd = 5;                // sigmas by which a difference must stand out
constexpr double kSpeedPrior = 0.05;      // of the speed: how far it may be off its mean over kSpeedWindow
constexpr double kChangePrior = 0.3;      // of the speed a radian: a ripple of 5 % six times a turn
constexpr double kKinkPrior = 0.3;        // of the speed: a sudden change, as where a camera changes its rate
constexpr std::size_t kSpeedWindow = 60;  // frames to each side
constexpr double kSharp = 0.12;           // of a frame's turn: error of a step that is small enough
constexpr double kSure = 5;               // sigmas of a step that is believed by itself
constexpr double kLikely = 2;             // where the picture jumps as well
constexpr double kCoarse = 0.25;          // error of a step beyond which one missing frame is all that is believed
constexpr double kOtherSteps = 1.5;       // frames that may be missing where else the picture jumps
constexpr double kUnevenness = 0.03;      // of a frame's turn: the least error of an angle
constexpr double kLeastJump = 0.15;       // logarithm of a picture's difference over the usual: something is missing
constexpr double kClearGrowth = 5;        // scatters by which pictures two frames apart must differ more, to be asked
constexpr double kDenied = 0.4;           // of that growth: a gap that shows less of it is none
constexpr double kWorstFit = 6;           // chi square over freedom
constexpr std::array<std::size_t, 10> kWidths = {1, 2, 3, 5, 8, 12, 20, 30, 45, 60};  // frames to each side of a gap
constexpr double kLeastBetter = 10;  // chi square by which a step must beat a change of speed

// 1.48 times the median of absolute deviations: the standard deviation of normal numbers.
double robust_deviation(const std::vector<double>& v) {
  const double m = median_of(v);
  std::vector<double> off;
  for (const double x : v) off.push_back(std::abs(x - m));
  return 1.4826 * median_of(off);
}

// Logarithm of each difference over what is usual around it; NaN where there is none. Usual is the upper quartile: half
// of the frames may be repeats.
std::vector<double> relative_change(std::span<const double> difference) {
  std::vector<double> out(difference.size(), kNotGiven);
  const int n = static_cast<int>(difference.size());
  for (int i = 0; i < n; ++i) {
    std::vector<double> around;
    for (int k = std::max(0, i - kReference); k <= std::min(n - 1, i + kReference); ++k)
      if (k != i && !std::isnan(difference[static_cast<std::size_t>(k)]))
        around.push_back(difference[static_cast<std::size_t>(k)]);
    const double own = difference[static_cast<std::size_t>(i)];
    if (around.size() < 4 || std::isnan(own)) continue;
    const double at = quantile_of(std::move(around), 0.7);
    if (at > 0) out[static_cast<std::size_t>(i)] = std::log(std::max(own, 1e-6 * at) / at);
  }
  return out;
}

// What the pictures say of repeats and gaps that the drum's angle suggests. How much more two pictures differ that are
// two frames apart than neighbours do is what a missing frame must show, and what a repeat must not.
class Pictures {
 public:
  Pictures(const FrameEvidence& evidence, const std::vector<double>& change)
      : one_(evidence.difference), two_(evidence.difference_over_two), change_(change) {
    std::vector<double> growths, scatters;
    const auto add = [](std::vector<double>& to, double value) {
      if (std::isfinite(value)) to.push_back(value);
    };
    for (std::size_t i = 2; i + 1 < two_.size(); ++i) {
      if (!moves(i) || !moves(i - 1)) continue;
      add(growths, std::log(two_[i]) - 0.5 * std::log(one_[i] * one_[i - 1]));
      if (moves(i + 1)) add(scatters, std::log(one_[i]) - 0.5 * std::log(one_[i - 1] * one_[i + 1]));
    }
    if (std::min(growths.size(), scatters.size()) < kFewestGrowths) return;
    growth_ = median_of(growths);
    asked_ = growth_ > kClearGrowth * std::max(robust_deviation(growths), robust_deviation(scatters));
  }

  // Nothing is missing before frame i: it is as like the frame before as its neighbours are to theirs. Light that
  // changes over the film does so for all of them.
  bool deny_gap(std::size_t i) const {
    if (!asked_ || i >= one_.size()) return false;
    double least = 1e300;
    for (const std::size_t k : {i - 1, i + 1})
      if (k > 0 && k < one_.size() && moves(k)) least = std::min(least, one_[k]);
    return least < 1e300 && std::log(one_[i] / least) < kDenied * growth_;
  }

  // Frame i is no repeat: seen from the frame before or after, it is another picture than its neighbour.
  bool deny_repeat(std::size_t i) const {
    if (!asked_) return false;
    double least = 1e300;
    const auto ask = [&](double far, double near) {
      if (far > 0 && near > 0) least = std::min(least, std::log(far / near));
    };
    if (i >= 2 && moves(i - 1)) ask(two_[i], one_[i - 1]);
    if (i + 1 < two_.size() && moves(i + 1)) ask(two_[i + 1], one_[i + 1]);
    return least < 1e300 && least > 0.5 * growth_;
  }

 private:
  static constexpr std::size_t kFewestGrowths = 8;

  bool moves(std::size_t i) const { return i < change_.size() && change_[i] > std::log(kRepeat); }

  std::span<const double> one_, two_;
  const std::vector<double>& change_;
  double growth_ = 0;  // logarithm
  bool asked_ = false;
};

struct Drum {  // frames that are no repeats and whose angle is known
  std::vector<int> frame;
  std::vector<double> x, angle;  // recorded index, angle
  std::vector<int> wild;         // frames whose angle stood alone, and was left out
};

double local_speed(const Drum& drum, std::size_t i) {
  std::vector<double> steps;
  const std::size_t from = i > kSpeedWindow ? i - kSpeedWindow : 1;
  for (std::size_t k = std::max<std::size_t>(1, from); k < std::min(drum.x.size(), i + kSpeedWindow); ++k)
    steps.push_back((drum.angle[k] - drum.angle[k - 1]) / (drum.x[k] - drum.x[k - 1]));
  const double m = median_of(steps);
  double sum = 0, n = 0;  // the mean of those near the median: a median of noise alone is not sharp enough
  const double width = 3 * robust_deviation(steps) + 1e-12;
  for (const double s : steps)
    if (std::abs(s - m) <= width) sum += s, n += 1;
  return sum / n;
}

double angle_noise(const Drum& drum, double given) {
  std::vector<double> seconds;
  for (std::size_t k = 2; k < drum.x.size(); ++k)
    seconds.push_back(drum.angle[k] - 2 * drum.angle[k - 1] + drum.angle[k - 2]);
  const double seen = robust_deviation(seconds) / std::sqrt(6.0);
  return std::max({std::isnan(given) ? 0.0 : given, seen, 1e-6});
}

// What the angles on both sides of a gap between two frames say of it.
struct StepFit {
  double step = 0, error = 0;  // in frames' turns
  double chi2 = 0;             // over freedom
  double better = 0;           // chi square by which a step beats a sudden change of speed
};

// Frames [from, to) of the drum's, frame k the first after the gap: a parabola in the recorded index and a step, and
// steps of their own at the other `suspects`.
StepFit fit_step(const Drum& drum, std::size_t from, std::size_t to, std::size_t k, double speed, double sigma,
                 const std::vector<char>& suspects) {
  std::vector<std::size_t> steps;
  for (std::size_t i = from + 1; i < to; ++i)
    if (suspects[i] && i != k) steps.push_back(i);
  const auto n = static_cast<Eigen::Index>(4 + steps.size());
  const double middle = 0.5 * (drum.x[k - 1] + drum.x[k]);
  struct Solution {
    double last = 0, error = 0, chi2 = 0;
  };
  const auto solve = [&](bool kink) {
    Eigen::MatrixXd m = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(n), row(n);
    double squares = 0;
    for (std::size_t i = from; i < to; ++i) {
      const double d = drum.x[i] - middle;
      const double y = drum.angle[i] - drum.angle[k - 1] - speed * d;
      row(0) = 1, row(1) = d, row(2) = d * d, row(3) = i < k ? 0.0 : kink ? d : 1.0;
      for (std::size_t c = 0; c < steps.size(); ++c) row(static_cast<Eigen::Index>(4 + c)) = i < steps[c] ? 0.0 : 1.0;
      m.selfadjointView<Eigen::Lower>().rankUpdate(row, 1 / (sigma * sigma));
      b += y / (sigma * sigma) * row;
      squares += y * y / (sigma * sigma);
    }
    m(1, 1) += 1 / std::pow(kSpeedPrior * speed, 2);
    m(2, 2) += 1 / std::pow(0.5 * kChangePrior * speed * speed, 2);
    if (kink) m(3, 3) += 1 / std::pow(kKinkPrior * speed, 2);
    for (Eigen::Index c = 4; c < n; ++c) m(c, c) += 1 / std::pow(kOtherSteps * speed, 2);
    const Eigen::LLT<Eigen::MatrixXd> cholesky(m.selfadjointView<Eigen::Lower>());
    const Eigen::VectorXd fit = cholesky.solve(b);
    return Solution{fit(3), std::sqrt(cholesky.solve(Eigen::VectorXd::Unit(n, 3))(3)), squares - b.dot(fit)};
  };
  const Solution step = solve(false), kink = solve(true);
  return {step.last / speed, step.error / speed, step.chi2 / std::max(1.0, static_cast<double>(to - from) - 2),
          kink.chi2 - step.chi2};
}

// Scatter of single steps about frame k [frames' turns].
double step_scatter(const Drum& drum, std::size_t k, double speed) {
  std::vector<double> steps;
  for (std::size_t i = k > kSpeedWindow ? k - kSpeedWindow : 1; i < std::min(drum.x.size(), k + kSpeedWindow); ++i)
    if (i != k) steps.push_back((drum.angle[i] - drum.angle[i - 1]) / speed - (drum.x[i] - drum.x[i - 1]));
  return steps.size() < 4 ? 0.0 : robust_deviation(steps);
}

// Whether the angle goes back near frame k, or one stood alone: no drum does that, angles are misread there, by a
// frame's turn as well as not.
bool goes_back_near(const Drum& drum, std::size_t k, double speed, double sigma) {
  constexpr std::size_t kNear = 3;
  constexpr double kBack = 0.5;  // frames' turns
  for (const int frame : drum.wild)
    if (std::abs(frame - drum.frame[k]) <= static_cast<int>(kNear)) return true;
  for (std::size_t i = k > kNear ? k - kNear : 1; i < std::min(drum.x.size(), k + kNear + 1); ++i) {
    const double off = (drum.angle[i] - drum.angle[i - 1]) / speed - (drum.x[i] - drum.x[i - 1]);
    if (i != k && off < -std::max(kBack, kSure * std::sqrt(2.0) * sigma / speed)) return true;
  }
  return false;
}

// Before frame k of the drum's.
struct Gap {
  double step = 0, error = 1;  // in frames' turns
  int missing = 0;             // that the step stands for; 0: none is believed
  double jump = 0;             // of the picture, in its scatter
  double sureness() const { return std::hypot(step / error, std::min(jump, kOdd)); }
};

Gap judge_gap(const Drum& drum, std::size_t k, double sigma, double jump, bool denied,
              const std::vector<char>& suspects) {
  const double speed = local_speed(drum, k);
  Gap gap;
  gap.jump = jump;
  if (!(speed > 0)) return gap;
  // Angles that are misread at every other frame are off by a frame's turn now and then.
  const double scatter = step_scatter(drum, k, speed);
  const bool misread = goes_back_near(drum, k, speed, sigma);
  // The shortest stretch that is sharp enough: the speed is even over a short one.
  for (const std::size_t wide : kWidths) {
    const std::size_t from = k > wide ? k - wide : 0, to = std::min(drum.x.size(), k + wide);
    const StepFit fit = fit_step(drum, from, to, k, speed, std::max(sigma, kUnevenness * speed), suspects);
    gap.step = fit.step;
    gap.error = fit.error;
    if (gap.error > kSharp && wide != kWidths.back()) continue;
    const double whole = gap.error > kCoarse ? 1.0 : std::round(gap.step);
    const bool sure = !misread && gap.step > kSure * std::max(gap.error, scatter) && fit.better > kLeastBetter;
    const bool likely = jump >= kOdd && gap.step > kLikely * gap.error && fit.better > 0;
    if (whole >= 1 && std::abs(gap.step - whole) < std::max(0.3, 2.5 * gap.error) && fit.chi2 < kWorstFit &&
        (sure || likely) && !denied) {
      gap.missing = static_cast<int>(whole);
      return gap;
    }
    if (jump < kOdd || gap.step < 0.4) return gap;  // else between none and one: more frames must tell
  }
  return gap;
}

// A single angle beside the rest, such as one lifter spacing off, is no evidence of time.
void drop_wild_angles(Drum& drum, double sigma) {
  Drum kept;
  for (std::size_t k = 0; k < drum.x.size(); ++k) {
    if (k > 0 && k + 1 < drum.x.size()) {
      const double speed = local_speed(drum, k);
      const double across = (drum.angle[k + 1] - drum.angle[k - 1]) / speed - (drum.x[k + 1] - drum.x[k - 1]);
      const double off = (drum.angle[k] - drum.angle[k - 1]) / speed - (drum.x[k] - drum.x[k - 1]);
      if (std::abs(across) < 0.3 + 4 * sigma / speed && std::abs(off - 0.5 * across) > 0.6 + 6 * sigma / speed) {
        kept.wild.push_back(drum.frame[k]);
        continue;
      }
    }
    kept.frame.push_back(drum.frame[k]);
    kept.x.push_back(drum.x[k]);
    kept.angle.push_back(drum.angle[k]);
  }
  drum = std::move(kept);
}

Drum drum_of(std::span<const double> angle, const std::vector<char>& repeated) {
  Drum drum;
  double x = -1;
  for (std::size_t i = 0; i < angle.size(); ++i) {
    if (repeated[i]) continue;
    x += 1;
    if (std::isnan(angle[i])) continue;
    drum.frame.push_back(static_cast<int>(i));
    drum.x.push_back(x);
    drum.angle.push_back(angle[i]);
  }
  return drum;
}

// Frames whose picture hardly differs from the one before, unless the drum has turned.
std::vector<char> find_repeats(const FrameEvidence& evidence, std::size_t n, const std::vector<double>& change,
                               double change_scatter, const Pictures& pictures) {
  std::vector<char> repeated(n, 0);
  const auto angle_at = [&](std::size_t i) { return i < evidence.angle.size() ? evidence.angle[i] : kNotGiven; };
  const double limit = std::min(std::log(kRepeat), -kOdd * change_scatter);
  for (std::size_t i = 1; i < n; ++i) repeated[i] = i < change.size() && change[i] < limit && !pictures.deny_repeat(i);
  const Drum drum = drum_of(evidence.angle, repeated);
  if (drum.x.size() < 8) return repeated;
  const double sigma = angle_noise(drum, evidence.angle_sigma);
  for (std::size_t i = 1; i < n; ++i) {
    const double turn = angle_at(i) - angle_at(i - 1);
    if (std::isnan(turn)) continue;
    const auto k = static_cast<std::size_t>(
        std::lower_bound(drum.frame.begin(), drum.frame.end(), static_cast<int>(i)) - drum.frame.begin());
    const double speed = local_speed(drum, std::min(k, drum.x.size() - 1));
    const double scatter = std::sqrt(2.0) * std::max(sigma, kUnevenness * speed);
    const bool turned = turn > 0.5 * speed && turn > 4 * scatter;
    const bool stood = turn < 0.5 * speed && speed - turn > kSure * scatter && std::abs(turn) < 4 * scatter;
    const bool less = i >= change.size() || std::isnan(change[i]) || change[i] < -2 * change_scatter;
    repeated[i] = (repeated[i] && !turned) || (stood && less && !pictures.deny_repeat(i));
  }
  return repeated;
}

}  // namespace

double picture_difference(const cv::Mat& before, const cv::Mat& now, double centre_u, double centre_v, double radius) {
  CV_Assert(before.size() == now.size() && before.type() == now.type() && before.depth() == CV_8U);
  constexpr int kStep = 4;
  const int channels = now.channels(), channel = channels > 1 ? 1 : 0;
  long sum = 0, count = 0;
  for (int v = kStep / 2; v < now.rows; v += kStep) {
    const double across = radius * radius - (v - centre_v) * (v - centre_v);
    if (across <= 0) continue;
    const int from = std::max(0, static_cast<int>(std::ceil(centre_u - std::sqrt(across))));
    const int to = std::min(now.cols - 1, static_cast<int>(std::floor(centre_u + std::sqrt(across))));
    const uchar *a = before.ptr<uchar>(v), *b = now.ptr<uchar>(v);
    for (int u = from; u <= to; u += kStep) {
      const int at = u * channels + channel;
      sum += std::abs(static_cast<int>(a[at]) - static_cast<int>(b[at]));
      ++count;
    }
  }
  return count > 0 ? static_cast<double>(sum) / static_cast<double>(count) : kNotGiven;
}

FrameClock find_frame_clock(const FrameEvidence& evidence) {
  const std::size_t n = std::max(evidence.difference.size(), evidence.angle.size());
  FrameClock clock;
  const std::vector<double> change = relative_change(evidence.difference);
  std::vector<double> usual;
  for (const double c : change)
    if (c > std::log(kRepeat)) usual.push_back(c);
  const double scatter = usual.size() < 4 ? 0.1 : std::max(0.02, robust_deviation(usual));
  const double middle = usual.empty() ? 0.0 : median_of(usual);

  const Pictures pictures(evidence, change);

  const std::vector<char> repeated = find_repeats(evidence, n, change, scatter, pictures);
  std::vector<int> step(n, 1);  // recorded frames from the one before
  for (std::size_t i = 1; i < n; ++i)
    if (repeated[i]) {
      clock.duplicated.push_back(static_cast<int>(i));
      step[i] = 0;
    }

  Drum drum = drum_of(evidence.angle, repeated);
  if (drum.x.size() >= 8) {
    const double sigma = angle_noise(drum, evidence.angle_sigma);
    drop_wild_angles(drum, sigma);
    const auto jump = [&](std::size_t k) {
      const auto i = static_cast<std::size_t>(drum.frame[k]);
      return i < change.size() ? std::max(0.0, (change[i] - middle) / std::max(scatter, kLeastJump / kOdd)) : 0.0;
    };
    std::vector<char> suspects(drum.x.size(), 0);  // the picture jumps, and nothing is known to be missing yet
    for (std::size_t k = 1; k < drum.x.size(); ++k) suspects[k] = jump(k) >= kOdd;
    std::vector<Gap> gaps(drum.x.size());
    std::size_t from = 1, to = drum.x.size();
    for (;;) {  // the surest first: what is missing elsewhere blurs the others
      for (std::size_t k = from; k < to; ++k) {
        const bool denied = pictures.deny_gap(static_cast<std::size_t>(drum.frame[k]));
        gaps[k] = judge_gap(drum, k, sigma, jump(k), denied, suspects);
      }
      std::size_t best = 0;
      for (std::size_t k = 1; k < gaps.size(); ++k)
        if (gaps[k].missing > 0 && (best == 0 || gaps[k].sureness() > gaps[best].sureness())) best = k;
      if (best == 0) break;
      suspects[best] = 0;
      step[static_cast<std::size_t>(drum.frame[best])] += gaps[best].missing;
      for (std::size_t k = best; k < drum.x.size(); ++k) drum.x[k] += gaps[best].missing;
      from = best > kSpeedWindow ? best - kSpeedWindow : 1;
      to = std::min(drum.x.size(), best + kSpeedWindow + 1);
    }
    std::vector<double> errors;
    for (const Gap& g : gaps) errors.push_back(g.error);
    clock.drops_can_be_seen = median_of(errors) < 1 / kSure;
  }

  int source = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (i > 0) source += step[i];
    clock.source.push_back(source);
    if (step[i] > 1) clock.dropped.push_back({static_cast<int>(i) - 1, step[i] - 1});
  }
  return clock;
}

}  // namespace tumble::analysis
