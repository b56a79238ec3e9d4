#include "analysis/drum_turn.h"

#include <algorithm>
#include <cmath>

#include "core/config.h"
#include "core/quantile.h"
#include "core/units.h"

namespace tumble::analysis {
namespace {

constexpr int kGroup = 6;              // rows taken together
constexpr int kTogether = 3;           // bands that are followed by themselves at first
constexpr int kLeastOrder = 2;         // light that changes is of the lowest orders
constexpr double kGreyNoise = 0.5;     // of a group's mean [grey levels]: bands in which nothing moves have no say
constexpr std::size_t kTrial = 80;     // pictures that show which of several turns is the drum's
constexpr double kStill = 0.03;        // turn during the trial below which nothing turns [rad]
constexpr double kUnsteady = 0.08;     // of the turn from picture to picture, as a share
constexpr double kLeastOverlap = 0.1;  // of the most: matches of so little are left alone
constexpr double kNearEqual = 0.85;    // of the best match
constexpr double kBelievedNear = 0.5;  // of the best match anywhere: one within reach is believed

struct Peak {
  double shift = 0, height = -1;  // [columns], nearest to zero
};

double value_at(const std::vector<float>& match, long column) {
  const long n = static_cast<long>(match.size());
  return match[static_cast<std::size_t>(((column % n) + n) % n)];
}

Peak refined(const std::vector<float>& match, long column) {
  const double l = value_at(match, column - 1), m = value_at(match, column), h = value_at(match, column + 1);
  const double curve = l - 2 * m + h, aside = curve < 0 ? std::clamp(0.5 * (l - h) / curve, -0.5, 0.5) : 0.0;
  return {static_cast<double>(column) + aside, m - 0.25 * (l - h) * aside};
}

Peak best_within(const std::vector<float>& match, double middle, double reach) {
  Peak best;
  long at = std::lround(middle);
  for (long c = std::lround(middle - reach); c <= std::lround(middle + reach); ++c)
    if (value_at(match, c) > best.height) {
      best.height = value_at(match, c);
      at = c;
    }
  return refined(match, at);
}

std::vector<Peak> peaks_of(const std::vector<float>& match, double least) {
  std::vector<Peak> peaks;
  const long n = static_cast<long>(match.size());
  for (long c = -n / 2; c < n / 2; ++c)
    if (value_at(match, c) >= least && value_at(match, c) > value_at(match, c - 1) &&
        value_at(match, c) >= value_at(match, c + 1))
      peaks.push_back(refined(match, c));
  return peaks;
}

}  // namespace

RoundSpectrum::RoundSpectrum(const cv::Mat& moving) {
  const int bands = moving.rows / kGroup;
  cv::Mat rows(bands, moving.cols, CV_32F);
  for (int b = 0; b < bands; ++b)
    cv::reduce(moving.rowRange(b * kGroup, (b + 1) * kGroup), rows.row(b), 0, cv::REDUCE_AVG, CV_32F);
  for (int b = 0; b < bands; ++b) {
    cv::Mat row = rows.row(b);
    const double deviation = cv::norm(row) / std::sqrt(row.cols);
    row /= std::sqrt(deviation * deviation + kGreyNoise * kGreyNoise) * std::sqrt(bands * row.cols);
  }
  cv::dft(rows, orders_, cv::DFT_ROWS | cv::DFT_COMPLEX_OUTPUT);
  const int most = moving.cols / 6;
  for (int b = 0; b < bands; ++b) {
    auto* o = orders_.ptr<cv::Vec2f>(b);
    for (int m = 0; m < moving.cols; ++m)
      if (std::min(m, moving.cols - m) < kLeastOrder || std::min(m, moving.cols - m) > most) o[m] = {0, 0};
  }
}

std::vector<float> RoundSpectrum::match(const RoundSpectrum& other) const {
  cv::Mat product, sum, back;
  cv::mulSpectrums(other.orders_, orders_, product, cv::DFT_ROWS, true);
  cv::reduce(product, sum, 0, cv::REDUCE_SUM);
  cv::dft(sum, back, cv::DFT_INVERSE | cv::DFT_REAL_OUTPUT);
  std::vector<float> result(static_cast<std::size_t>(back.cols));
  const double scale = 1.0 / (std::sqrt(power() * other.power()) + 1e-9);
  for (int k = 0; k < back.cols; ++k)
    result[static_cast<std::size_t>(k)] = static_cast<float>(back.at<float>(0, k) * scale);
  return result;
}

RoundSpectrum RoundSpectrum::bands(const cv::Range& range) const {
  RoundSpectrum some;
  some.orders_ = orders_.rowRange(range);
  return some;
}

double RoundSpectrum::power() const { return cv::norm(orders_, cv::NORM_L2SQR); }

void RoundSpectrum::add_turned_back(const RoundSpectrum& other, double angle) {
  if (orders_.empty()) orders_ = cv::Mat::zeros(other.orders_.size(), CV_32FC2);
  // Turned forwards by `angle`, order m carries exp(-i m angle).
  const int n = orders_.cols, most = n / 6;
  for (int m = kLeastOrder; m <= most; ++m) {
    const float c = static_cast<float>(std::cos(m * angle)), s = static_cast<float>(std::sin(m * angle));
    for (int b = 0; b < orders_.rows; ++b) {
      const cv::Vec2f f = other.orders_.at<cv::Vec2f>(b, m);
      cv::Vec2f& o = orders_.at<cv::Vec2f>(b, m);
      o += cv::Vec2f(f[0] * c - f[1] * s, f[0] * s + f[1] * c);
      orders_.at<cv::Vec2f>(b, n - m) = {o[0], -o[1]};
    }
  }
}

void RoundSpectrum::weigh_bands(const std::vector<double>& weights) {
  for (int b = 0; b < orders_.rows; ++b) {
    cv::Mat row = orders_.row(b);
    row *= weights[static_cast<std::size_t>(b)];
  }
}

std::vector<double> RoundSpectrum::band_powers() const {
  std::vector<double> powers;
  for (int b = 0; b < orders_.rows; ++b) powers.push_back(cv::norm(orders_.row(b), cv::NORM_L2SQR));
  return powers;
}

namespace {

// Commonest turn between neighbours [columns], from all pairs at once; NaN where none stands out.
double commonest_turn(const std::vector<RoundSpectrum>& pictures, double expected_columns) {
  cv::Mat cross, product, sum, back;
  for (std::size_t t = 0; t + 1 < pictures.size(); ++t) {
    cv::mulSpectrums(pictures[t + 1].orders(), pictures[t].orders(), product, cv::DFT_ROWS, true);
    if (cross.empty())
      cross = product.clone();
    else
      cross += product;
  }
  cv::reduce(cross, sum, 0, cv::REDUCE_SUM);
  cv::dft(sum, back, cv::DFT_INVERSE | cv::DFT_REAL_OUTPUT);
  const std::vector<float> match(back.ptr<float>(0), back.ptr<float>(0) + back.cols);
  const double most = *std::max_element(match.begin(), match.end());
  double least_miss = 1e300, chosen = kNotGiven;
  if (!(most > 0)) return chosen;
  // Of near equals the turn of the expected size, else the slowest.
  for (const Peak& p : peaks_of(match, kNearEqual * most)) {
    const double miss =
        std::isnan(expected_columns) ? std::abs(p.shift) : std::abs(std::abs(p.shift) - expected_columns);
    if (miss >= least_miss) continue;
    least_miss = miss;
    chosen = p.shift;
  }
  return chosen;
}

double median_step(const std::vector<double>& angles) {
  std::vector<double> steps;
  for (std::size_t t = 0; t + 1 < angles.size(); ++t) steps.push_back(angles[t + 1] - angles[t]);
  return median_of(steps);
}

// How much of the drum's directions both a picture and the mean of others show, by the turn between them. Where part of
// the drum is out of the picture, what comes into view is not in the mean yet, and a match of less turn would gain by
// it.
class Overlap {
 public:
  explicit Overlap(const std::vector<float>& in_view) : in_view_(in_view), shown_(in_view.size(), 0.0F) {
    whole_ = std::all_of(in_view.begin(), in_view.end(), [&](float v) { return v == in_view.front(); });
  }

  void add(double angle) {
    if (whole_) return;
    const std::size_t n = shown_.size(), turn = columns_of(angle);
    for (std::size_t k = 0; k < n; ++k) shown_[k] += in_view_[(k + turn) % n];
  }

  // Matches at `from` to `to` [columns], as if all turns showed as much.
  void even_out(std::vector<float>& match, double from, double to) const {
    if (whole_) return;
    const long n = static_cast<long>(shown_.size());
    std::vector<double> overlap;
    for (long c = std::lround(from) - 1; c <= std::lround(to) + 1; ++c) {
      double sum = 0;
      const auto turn = static_cast<std::size_t>(((c % n) + n) % n);
      for (std::size_t k = 0; k < shown_.size(); ++k) sum += shown_[k] * in_view_[(k + turn) % shown_.size()];
      overlap.push_back(sum);
    }
    const double most = *std::max_element(overlap.begin(), overlap.end());
    for (std::size_t i = 0; i < overlap.size(); ++i) {
      const long c = std::lround(from) - 1 + static_cast<long>(i);
      if (overlap[i] > kLeastOverlap * most)
        match[static_cast<std::size_t>(((c % n) + n) % n)] *= static_cast<float>(most / overlap[i]);
    }
  }

 private:
  std::size_t columns_of(double angle) const {
    const long n = static_cast<long>(shown_.size()), c = std::lround(angle / (2 * kPi) * static_cast<double>(n));
    return static_cast<std::size_t>(((c % n) + n) % n);
  }

  const std::vector<float>& in_view_;
  std::vector<float> shown_;
  bool whole_ = true;
};

// Picture by picture against the mean of those before, turned back: the charge washes out of it and errors do not add
// up.
std::vector<double> follow(const std::vector<RoundSpectrum>& pictures, const std::vector<float>& in_view, double step,
                           std::size_t count) {
  const double columns = pictures[0].orders().cols, pitch = 2 * kPi / columns;
  std::vector<double> angles{0.0};
  RoundSpectrum mean;
  Overlap overlap(in_view);
  mean.add_turned_back(pictures[0], 0);
  overlap.add(0);
  for (std::size_t t = 1; t < count; ++t) {
    auto match = mean.match(pictures[t]);
    const double last = angles.back() / pitch, reach = kUnsteady * std::abs(step) + 1.5;
    overlap.even_out(match, last + std::min(0.0, 3 * step) - reach, last + std::max(0.0, 3 * step) + reach);
    // As usual, a repeated picture, one or two missing; anything else must match much better to be believed.
    Peak best = best_within(match, last + step, reach);
    for (double times : {0.0, 2.0, 3.0}) {
      const Peak other = best_within(match, last + times * step, reach);
      if (other.height > 1.1 * best.height + 0.01) best = other;
    }
    angles.push_back(best.shift * pitch);
    mean.add_turned_back(pictures[t], angles.back());
    overlap.add(angles.back());
  }
  return angles;
}

// The pictures' mean, turned back, and the share of each band's changes that it holds; chance leaves 1 / n of them in
// it.
RoundSpectrum turned_back(const std::vector<RoundSpectrum>& pictures, const std::vector<double>& angles,
                          std::vector<double>& coherence) {
  RoundSpectrum pattern;
  std::vector<double> power(static_cast<std::size_t>(pictures[0].orders().rows), 0.0);
  for (std::size_t t = 0; t < angles.size(); ++t) {
    pattern.add_turned_back(pictures[t], angles[t]);
    const auto p = pictures[t].band_powers();
    for (std::size_t b = 0; b < p.size(); ++b) power[b] += p[b];
  }
  const double n = static_cast<double>(angles.size());
  const auto held = pattern.band_powers();
  coherence.resize(held.size());
  for (std::size_t b = 0; b < held.size(); ++b) coherence[b] = std::max(0.0, held[b] / (n * power[b] + 1e-9) - 1 / n);
  return pattern;
}

}  // namespace

DrumTurn follow_turn(std::vector<RoundSpectrum> pictures, const std::vector<float>& in_view, double expected_step) {
  DrumTurn turn;
  const std::size_t n = pictures.size();
  if (n < 3) return turn;
  const double pitch = 2 * kPi / pictures[0].orders().cols;
  // Flange, lifters and charge turn each in their own way: of a few bands at a time, those that hold together best.
  const int bands = pictures[0].orders().rows;
  std::vector<double> coherence;
  double step = kNotGiven, most = 0;
  cv::Range chosen;
  for (int b = 0; b + kTogether <= std::max(bands, kTogether); b += kTogether - 1) {
    const cv::Range range(b, std::min(bands, b + kTogether));
    std::vector<RoundSpectrum> some;
    for (const RoundSpectrum& p : pictures) some.push_back(p.bands(range));
    const double s = commonest_turn(some, std::abs(expected_step) / pitch);
    if (std::isnan(s)) continue;
    const auto angles = follow(some, in_view, s, std::min(n, kTrial));
    if (std::abs(angles.back()) < kStill) continue;  // noise that the film's compression keeps from picture to picture
    turned_back(some, angles, coherence);
    const double best = *std::max_element(coherence.begin(), coherence.end());
    if (best <= most) continue;
    most = best;
    step = s;
    chosen = range;
  }
  if (std::isnan(step)) return turn;
  for (int round = 0; round < 5; ++round) {
    if (round == 0) {
      std::vector<RoundSpectrum> some;
      for (const RoundSpectrum& p : pictures) some.push_back(p.bands(chosen));
      turn.angles = follow(some, in_view, step, n);
    } else if (round == 1) {
      turn.angles = follow(pictures, in_view, step, n);
    } else {
      const double first = turn.angles[0];
      Overlap overlap(in_view);
      for (const double a : turn.angles) overlap.add(a);
      for (std::size_t t = 0; t < n; ++t) {
        auto match = turn.pattern.match(pictures[t]);
        const double about = (turn.angles[t] - first) / pitch;
        overlap.even_out(match, about - 4, about + 4);
        turn.angles[t] = best_within(match, about, 4).shift * pitch;
      }
    }
    step = median_step(turn.angles) / pitch;
    turn.pattern = turned_back(pictures, turn.angles, coherence);
    turn.coherence = *std::max_element(coherence.begin(), coherence.end());
    if (round < 2) {
      for (double& c : coherence) c = c > 0.1 * turn.coherence ? std::sqrt(c / (turn.coherence + 1e-9)) : 0.0;
      for (RoundSpectrum& p : pictures) p.weigh_bands(coherence);
      turn.pattern.weigh_bands(coherence);
    }
  }
  const double first = turn.angles[0];
  for (double& a : turn.angles) a -= first;
  turn.step = median_step(turn.angles);
  turn.found = turn.coherence > 0.05;
  return turn;
}

double angle_of(const RoundSpectrum& pattern, const RoundSpectrum& picture, double expected, double step) {
  const auto match = pattern.match(picture);
  const double n = static_cast<double>(match.size()), pitch = 2 * kPi / n;
  const double most = *std::max_element(match.begin(), match.end());
  // A drum does not jump: it has gone on as usual, not at all, or a few pictures are missing. Noise and what repeats
  // round the drum match elsewhere too, and are believed only where nothing is found within reach.
  const double back = 1.3 * std::abs(step) + 2 * pitch, on = 3.3 * std::abs(step) + 2 * pitch;
  const auto miss_of = [&](const Peak& p) { return std::remainder(p.shift * pitch - expected, 2 * kPi); };
  const auto within = [&](const Peak& p) {
    const double along = step < 0 ? -miss_of(p) : miss_of(p);
    return along > -back && along < on;
  };
  const auto peaks = peaks_of(match, 0.0);
  double near_most = 0;
  for (const Peak& p : peaks)
    if (within(p)) near_most = std::max(near_most, p.height);
  const bool near = near_most > kBelievedNear * most;
  double best = expected, nearest = 1e300;
  for (const Peak& p : peaks) {
    if (near && !within(p)) continue;
    if (p.height < kNearEqual * (near ? near_most : most) || std::abs(miss_of(p)) >= nearest) continue;
    nearest = std::abs(miss_of(p));
    best = expected + miss_of(p);
  }
  return best;
}

double angle_near(const RoundSpectrum& pattern, const RoundSpectrum& picture, double expected, double reach) {
  const auto match = pattern.match(picture);
  const double pitch = 2 * kPi / static_cast<double>(match.size());
  return best_within(match, expected / pitch, reach / pitch).shift * pitch;
}

}  // namespace tumble::analysis
