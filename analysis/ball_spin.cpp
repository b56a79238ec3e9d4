#include "analysis/ball_spin.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "core/parallel_for.h"
#include "core/quantile.h"
#include "core/units.h"

namespace tumble::analysis {
namespace {

constexpr double kClear = 0.85;         // share seen of a ball whose look counts for whether it is marked
constexpr double kHidden = 0.8;         // below it, what hides a ball turns it seemingly
constexpr double kMarkContrast = 0.09;  // of a mark, rms round a ring, over the balls' usual brightness
constexpr double kMarkOverNoise = 1.8;  // the same over what spoils patterns in this film
constexpr double kFaintest = 0.75;  // of the clearest: a mark that rolls out of sight no longer turns as its ball does
constexpr double kWorstSpin = 0.035;         // standard error beyond which nothing is told [rad/frame]
constexpr double kSureGap = 6;               // log likelihood by which the second best spin must be worse
constexpr double kEvenSpoil = 2;             // spoiling over the usual one up to which a stretch turns evenly
constexpr double kTilting = 0.3;             // error of a spin over the root of the share that it leaves unexplained
constexpr int kLongestHalf = 3;              // frames
constexpr std::size_t kEnoughLooks = 20000;  // for what all balls share

using Look = std::array<std::complex<double>, kMarkTerms>;
using Terms = std::array<double, kMarkTerms>;
using Basis = Eigen::Matrix<double, 6, 1>;

struct Seen {
  Sighting* sighting = nullptr;
  Look look{};  // without what all balls show at that place
};

Basis basis_at(const Sighting& s, double reach) {
  const double x = s.x / reach, y = s.y / reach;
  Basis b;
  b << 1, x, y, x * x, x * y, y * y;
  return b;
}

// Takes off what stands still in the picture: a robust quadratic in place, of least absolute residuals, so that a few
// marked balls among many plain ones leave no trace.
void take_off_light(std::vector<Seen>& all, double reach) {
  Eigen::Matrix<double, 6, 2 * kMarkTerms> light = Eigen::Matrix<double, 6, 2 * kMarkTerms>::Zero();
  const std::size_t stride = 1 + all.size() / kEnoughLooks;
  std::vector<double> away(all.size(), 1.0);
  for (int round = 0; round < 6; ++round) {
    Eigen::Matrix<double, 6, 6> normal = 1e-6 * Eigen::Matrix<double, 6, 6>::Identity();
    Eigen::Matrix<double, 6, 2 * kMarkTerms> right = Eigen::Matrix<double, 6, 2 * kMarkTerms>::Zero();
    std::vector<double> sample;
    for (std::size_t i = 0; i < all.size(); i += stride) sample.push_back(away[i]);
    const double least = 0.3 * std::max(1e-6, median_of(sample));
    for (std::size_t i = 0; i < all.size(); i += stride) {
      const Basis b = basis_at(*all[i].sighting, reach);
      const double w = 1 / std::max(away[i], least);
      Eigen::Matrix<double, 1, 2 * kMarkTerms> row;
      for (int k = 0; k < 2 * kMarkTerms; ++k) row[k] = all[i].sighting->mark.parts[static_cast<std::size_t>(k)] / 16.0;
      normal += w * b * b.transpose();
      right += w * b * row;
    }
    light = normal.ldlt().solve(right);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (round < 5 && i % stride != 0) continue;
      const auto there = (basis_at(*all[i].sighting, reach).transpose() * light).eval();
      double squares = 0;
      for (int k = 0; k < kMarkTerms; ++k) {
        const std::complex<double> d =
            all[i].sighting->mark.term(k) - std::complex<double>(there[2 * k], there[2 * k + 1]);
        all[i].look[static_cast<std::size_t>(k)] = d;
        squares += std::norm(d);
      }
      away[i] = std::sqrt(squares);
    }
  }
}

double amplitude_of(const Look& look) {
  double squares = 0;
  for (const auto& p : look) squares += std::norm(p);
  return std::sqrt(squares / kMarkRings);
}

// What a few looks have in common when each is turned back by w a frame.
Look pattern_of(std::span<const Seen* const> looks, double about, double w) {
  Look pattern{};
  for (const Seen* seen : looks) {
    const std::complex<double> step = std::polar(1.0, w * (seen->sighting->time - about));
    std::complex<double> back = 1;
    for (int m = 0; m < kMarkHarmonics; ++m) {
      back *= step;
      for (int r = 0; r < kMarkRings; ++r) {
        const auto k = static_cast<std::size_t>(r * kMarkHarmonics + m);
        pattern[k] += seen->look[k] * back;
      }
    }
  }
  for (auto& p : pattern) p /= static_cast<double>(looks.size());
  return pattern;
}

// Log likelihood that a few looks show one pattern that turns by w a frame: what that pattern explains of them. Its
// square falls apart into one short Fourier series in w for each pair of looks, in which the rings have been summed.
class SpinLikelihood {
 public:
  SpinLikelihood(std::span<const Seen* const> looks, const Terms& spoil) {
    const double n = static_cast<double>(looks.size());
    for (std::size_t a = 0; a < looks.size(); ++a) {
      for (std::size_t k = 0; k < kMarkTerms; ++k) alone_ += std::norm(looks[a]->look[k]) / (n * spoil[k]);
      for (std::size_t b = 0; b < a; ++b) {
        Pair& pair = pairs_.emplace_back();
        pair.apart = looks[a]->sighting->time - looks[b]->sighting->time;
        for (std::size_t k = 0; k < kMarkTerms; ++k)
          pair.terms[k % kMarkHarmonics] += looks[a]->look[k] * std::conj(looks[b]->look[k]) * (2 / (n * spoil[k]));
      }
    }
  }

  double at(double w) const {
    double sum = alone_;
    for (const Pair& pair : pairs_) {
      const std::complex<double> turn = std::polar(1.0, w * pair.apart);
      std::complex<double> z = 1;
      for (const std::complex<double>& term : pair.terms) sum += (term * (z *= turn)).real();
    }
    return sum;
  }

  // At -half .. half times `step`, to find the peak: single precision will do. Both signs have their cosines and sines
  // in common.
  std::vector<double> along(double step, int half) const {
    const Eigen::Index n = half + 1;
    Eigen::ArrayXf even = Eigen::ArrayXf::Zero(n), odd = even, c(n), s(n), next;
    for (const Pair& pair : pairs_) {
      const std::complex<double> turn = std::polar(1.0, step * pair.apart);
      std::complex<double> z = 1;
      for (Eigen::Index i = 0; i < n; ++i, z *= turn) {
        c[i] = static_cast<float>(z.real());
        s[i] = static_cast<float>(z.imag());
      }
      Eigen::ArrayXf cm = c, sm = s;  // of multiples of the angle
      for (const std::complex<double>& term : pair.terms) {
        even += static_cast<float>(term.real()) * cm;
        odd += static_cast<float>(term.imag()) * sm;
        next = cm * c - sm * s;
        sm = cm * s + sm * c;
        cm.swap(next);
      }
    }
    std::vector<double> all(2 * static_cast<std::size_t>(half) + 1);
    for (int i = 0; i <= half; ++i) {
      all[static_cast<std::size_t>(half + i)] = alone_ + even[i] - odd[i];
      all[static_cast<std::size_t>(half - i)] = alone_ + even[i] + odd[i];
    }
    return all;
  }

 private:
  struct Pair {
    double apart = 0;  // [frames]
    std::array<std::complex<double>, kMarkHarmonics> terms{};
  };
  double alone_ = 0;
  std::vector<Pair> pairs_;
};

struct SpinFit {
  double spin = kNotGiven, se = kNotGiven;  // [rad/frame]
  double amplitude = 0;                     // of the pattern, rms over the rings [grey levels]
  double spoiled = 0;                       // what the pattern leaves, over what it usually leaves
  double gap = 0;                           // log likelihood to the second best spin
  double evidence = 0;                      // that it neither stands still nor rides the drum
};

struct Expectation {
  double spread = 0.3;  // of spins [rad/frame]
  double turn = 0;      // of the drum
  Terms spoil{};        // variance of each term's departures from the pattern
};

SpinFit fit_spin(std::span<const Seen* const> looks, double about, const Expectation& expected) {
  SpinFit fit;
  const double span = looks.back()->sighting->time - looks.front()->sighting->time;
  const double step = 0.25 / (kMarkHarmonics * std::max(1.0, 0.5 * span)), fine = 0.2 * step;
  const int half = static_cast<int>(std::ceil(std::clamp(4 * expected.spread, 0.5 * kPi, kPi) / step));
  const SpinLikelihood turned(looks, expected.spoil);
  const std::vector<double> likelihood = turned.along(step, half);
  double all = 0;
  for (const Seen* seen : looks)
    for (std::size_t k = 0; k < kMarkTerms; ++k) all += std::norm(seen->look[k]) / expected.spoil[k];
  const double most = *std::max_element(likelihood.begin(), likelihood.end());
  const double freedom = static_cast<double>(looks.size() - 1) * kMarkTerms;
  fit.spoiled = (all - most) / freedom;
  const double doubt = std::max(1.0, fit.spoiled);
  const auto posterior = [&](int i) {
    const double w = (i - half) * step / expected.spread;
    return likelihood[static_cast<std::size_t>(i)] / doubt - 0.5 * w * w;
  };
  int best = -1;
  double second = -1e30;
  for (int i = 1; i < 2 * half; ++i) {  // peaks
    const double p = posterior(i);
    if (p < posterior(i - 1) || p <= posterior(i + 1)) continue;
    if (best < 0 || p > posterior(best)) {
      if (best >= 0) second = posterior(best);
      best = i;
    } else {
      second = std::max(second, p);
    }
  }
  if (best < 0) return fit;
  // A parabola through the peak, and a finer one through what it gives.
  double peak = 0, bend = 0;
  const auto refine = [&](double w, double by) {
    const double left = turned.at(w - by), middle = turned.at(w), right = turned.at(w + by);
    bend = (left - 2 * middle + right) / (by * by);
    if (bend < 0) peak = w + std::clamp(0.5 * (left - right) / (bend * by), -by, by);
    return bend < 0;
  };
  if (!refine((best - half) * step, step) || !refine(peak, fine)) return fit;
  fit.spin = peak;
  fit.gap = posterior(best) - second;
  const double found_likelihood = turned.at(fit.spin);
  fit.evidence = (found_likelihood - std::max(turned.at(0), turned.at(expected.turn))) / doubt;
  fit.amplitude = amplitude_of(pattern_of(looks, about, fit.spin));
  // Beyond noise, a ball that rolls about another axis shows a pattern that changes; that change may pass for a turn.
  const double changed = std::max(0.0, all - found_likelihood - 1.5 * freedom) / std::max(all, 1e-9);
  fit.se = std::hypot(std::sqrt(doubt / -bend), kTilting * std::sqrt(changed));
  return fit;
}

// The looks of a path within `half` frames of its i-th, if there are at least two.
std::vector<const Seen*> stretch(const std::vector<Seen*>& path, std::size_t i, double half) {
  std::size_t a = i, b = i;
  const auto near = [&](std::size_t k) {
    return std::abs(path[k]->sighting->time - path[i]->sighting->time) <= half + 0.5;
  };
  while (a > 0 && near(a - 1)) --a;
  while (b + 1 < path.size() && near(b + 1)) ++b;
  return {path.begin() + static_cast<std::ptrdiff_t>(a), path.begin() + static_cast<std::ptrdiff_t>(b) + 1};
}

// What is usual in this film, from patterns that nothing is yet known of.
Expectation expect(const std::vector<std::vector<Seen*>>& paths, const Expectation& rough) {
  std::array<std::vector<double>, kMarkTerms> squares;
  std::vector<double> spins;
  std::size_t looks = 0;
  for (const auto& path : paths) looks += path.size();
  const std::size_t stride = 1 + looks / (kEnoughLooks / 4);
  std::size_t count = 0;
  for (const auto& path : paths)
    for (std::size_t i = 0; i < path.size(); ++i) {
      if (count++ % stride != 0) continue;
      const auto near = stretch(path, i, 1);
      if (near.size() < 3) continue;
      const double about = path[i]->sighting->time;
      const SpinFit fit = fit_spin(near, about, rough);
      if (std::isnan(fit.spin)) continue;
      spins.push_back(std::abs(fit.spin));
      const Look pattern = pattern_of(near, about, fit.spin);
      for (std::size_t k = 0; k < kMarkTerms; ++k) {
        const double m = static_cast<double>(k % kMarkHarmonics + 1);
        double sum = 0;
        for (const Seen* s : near)
          sum += std::norm(s->look[k] - pattern[k] * std::polar(1.0, -m * fit.spin * (s->sighting->time - about)));
        squares[k].push_back(sum / static_cast<double>(near.size() - 1));
      }
    }
  Expectation usual = rough;
  if (!spins.empty()) usual.spread = std::clamp(3 * median_of(spins), 2 * std::abs(rough.turn), rough.spread);
  // The median of a sum of two exponentials is 0.84 of its mean; a tenth is more than rounding leaves.
  for (std::size_t k = 0; k < kMarkTerms; ++k)
    if (!squares[k].empty()) usual.spoil[k] = median_of(squares[k]) / 0.84 + 0.1;
  return usual;
}

double upper_quartile(std::vector<double>& v) {
  constexpr std::size_t kLeast = 5;  // sightings, to say anything of a ball
  if (v.size() < kLeast) return 0;
  return quantile_of(v, 0.75);
}

struct PathSpins {
  std::vector<SpinFit> fits;
  double amplitude = 0;  // upper quartile over clear sightings
  double evidence = 0;   // summed
};

PathSpins spins_of(const std::vector<Seen*>& path, const Expectation& expected, double least) {
  PathSpins spins;
  std::vector<double> clear;
  for (const Seen* s : path)
    if (s->sighting->visible >= kClear) clear.push_back(amplitude_of(s->look));
  if (upper_quartile(clear) < least) return spins;  // no pattern stands out more than its looks do
  clear.clear();
  for (std::size_t i = 0; i < path.size(); ++i) {
    SpinFit fit;
    for (int half = 1; half <= kLongestHalf; ++half) {
      const auto near = stretch(path, i, half);
      if (near.size() < 2) continue;
      const SpinFit longer = fit_spin(near, path[i]->sighting->time, expected);
      if (half == 1 || (longer.spoiled < kEvenSpoil && longer.se < fit.se)) fit = longer;
      if (fit.se < 0.5 * kWorstSpin) break;
    }
    spins.fits.push_back(fit);
    if (path[i]->sighting->visible < kClear || std::isnan(fit.spin)) continue;
    clear.push_back(fit.amplitude);
    spins.evidence += fit.evidence;
  }
  spins.amplitude = upper_quartile(clear);
  return spins;
}

void measure_class(std::vector<Seen>& all, double reach, Expectation expected) {
  take_off_light(all, reach);
  std::map<int, std::vector<Seen*>> by_track;
  std::vector<double> greys;
  for (Seen& s : all) {
    by_track[s.sighting->track].push_back(&s);
    greys.push_back(s.sighting->mark.grey);
  }
  std::vector<std::vector<Seen*>> paths;
  for (auto& [id, path] : by_track) paths.push_back(std::move(path));
  expected.spoil.fill(9.0);
  expected = expect(paths, expected);
  double spoil = 0;
  for (const double v : expected.spoil) spoil += v / kMarkRings;
  const double least = std::max(kMarkContrast * median_of(greys), kMarkOverNoise * std::sqrt(spoil));

  std::vector<PathSpins> spins(paths.size());
  parallel_for(paths.size(), 4, [&](std::size_t from, std::size_t to) {
    for (std::size_t p = from; p < to; ++p) spins[p] = spins_of(paths[p], expected, least);
  });
  double marked = 0, proven = 0;
  constexpr double kProof = 20;  // log likelihood of a path
  for (const PathSpins& s : spins)
    if (s.amplitude > least) {
      marked += static_cast<double>(s.fits.size());
      if (s.evidence > kProof) proven += static_cast<double>(s.fits.size());
    }
  if (proven < 0.5 * marked) return;
  for (std::size_t p = 0; p < paths.size(); ++p) {
    if (!(spins[p].amplitude > least)) continue;
    for (std::size_t i = 0; i < paths[p].size(); ++i) {
      const SpinFit& fit = spins[p].fits[i];
      Sighting& s = *paths[p][i]->sighting;
      if (!(fit.se < kWorstSpin) || fit.gap < kSureGap ||
          fit.amplitude < std::max(least, kFaintest * spins[p].amplitude) || s.visible < kHidden)
        continue;
      s.spin = fit.spin;
      s.spin_se = fit.se;
    }
  }
}

}  // namespace

void measure_spins(std::vector<SeenFrame>& frames, double turn) {
  std::map<int, std::vector<Seen>> classes;
  double reach = 0, squares = 0, count = 0;
  for (SeenFrame& f : frames)
    for (Sighting& s : f.balls) {
      s.spin = s.spin_se = kNotGiven;
      if (s.track < 0) continue;
      classes[s.size_class].push_back({&s});
      reach = std::max(reach, std::hypot(s.x, s.y));
      if (std::isnan(s.vx)) continue;
      squares += (s.vx * s.vx + s.vy * s.vy) / (s.radius * s.radius);
      count += 1;
    }
  Expectation expected;
  expected.turn = turn;
  if (count > 0) expected.spread = std::max(std::sqrt(squares / count), 2 * std::abs(turn));  // rolling at usual speeds
  for (auto& [size, all] : classes)
    if (all.size() > 30) measure_class(all, reach, expected);
}

}  // namespace tumble::analysis
