#include "analysis/carried_balls.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>

#include "core/angle.h"
#include "core/quantile.h"
#include "core/random.h"

namespace tumble::analysis {
namespace {

using Complex = std::complex<double>;  // places as x + i y, y up

constexpr int kLeastSightings = 6;    // in a window: a velocity and its noise
constexpr std::size_t kWindow = 12;   // sightings of one track that are looked at together
constexpr int kLargestGap = 3;        // frames within a window
constexpr int kGuesses = 3000;        // pairs of windows that are tried
constexpr std::size_t kVoters = 300;  // windows that each is tried on
constexpr double kSlip = 0.02;        // of the speed: carried balls creep
constexpr double kCommonCreep = 0.1;  // of the mill's radius over the root of the arcs: the centre's error by creep
constexpr double kLeastTurn = 2e-4;   // rad/frame
constexpr double kMostTurn = 1.0;
constexpr std::size_t kLeastArcs = 3;
constexpr std::size_t kMostArcs = 40;  // the longest say it all
constexpr std::size_t kGroups = 10;    // of arcs, for the errors

struct Seen {
  double t = 0;
  Complex z;
  double radius = 0;
};

struct Window {
  int track = 0;
  std::vector<Seen> seen;
  Complex place, velocity;  // at the mean time
  double weight = 0;        // sum of (t - mean)^2: variance of the velocity is noise^2 over it
  double freedom = 0, squares = 0;
};

Window window_of(int track, std::vector<Seen> seen) {
  Window w;
  w.track = track;
  double t0 = 0;
  for (const Seen& s : seen) t0 += s.t / static_cast<double>(seen.size());
  // Parabola by orthogonal polynomials of the actual times.
  double s2 = 0, s3 = 0, n = static_cast<double>(seen.size());
  Complex mean = 0, slope = 0;
  for (const Seen& s : seen) {
    const double d = s.t - t0;
    s2 += d * d, s3 += d * d * d;
    mean += s.z / n;
    slope += d * s.z;
  }
  slope /= s2;
  double norm = 0;
  Complex bend = 0;
  const auto p2 = [&](double d) { return d * d - s3 / s2 * d - s2 / n; };
  for (const Seen& s : seen) {
    const double p = p2(s.t - t0);
    norm += p * p;
    bend += p * s.z;
  }
  bend /= norm;
  for (const Seen& s : seen) {
    const double d = s.t - t0;
    w.squares += std::norm(s.z - mean - slope * d - bend * p2(d));
  }
  w.freedom = 2 * (n - 3);
  w.place = mean - bend * s2 / n;
  w.velocity = slope - bend * s3 / s2;
  w.weight = s2;
  w.seen = std::move(seen);
  return w;
}

std::vector<Window> windows_of(std::span<const PixelSighting> sightings) {
  std::vector<PixelSighting> sorted(sightings.begin(), sightings.end());
  std::stable_sort(sorted.begin(), sorted.end(), [](const PixelSighting& a, const PixelSighting& b) {
    return a.track != b.track ? a.track < b.track : a.frame < b.frame;
  });
  std::vector<Window> windows;
  for (std::size_t i = 0; i < sorted.size();) {
    std::size_t end = i + 1;
    while (end < sorted.size() && sorted[end].track == sorted[i].track &&
           sorted[end].frame - sorted[end - 1].frame <= kLargestGap)
      ++end;
    // Equal parts of the stretch, none longer than a window.
    const std::size_t n = end - i, parts = (n + kWindow - 1) / kWindow;
    for (std::size_t p = 0; p < parts; ++p) {
      std::vector<Seen> seen;
      for (std::size_t k = i + p * n / parts; k < i + (p + 1) * n / parts; ++k)
        if (seen.empty() || sorted[k].frame > seen.back().t)
          seen.push_back({static_cast<double>(sorted[k].frame), {sorted[k].u, -sorted[k].v}, sorted[k].radius});
      if (static_cast<int>(seen.size()) >= kLeastSightings)
        windows.push_back(window_of(sorted[i].track, std::move(seen)));
    }
    i = end;
  }
  return windows;
}

struct Rigid {  // z' = i turn (z - centre)
  Complex centre;
  double turn = 0;
  Complex velocity(Complex z) const { return Complex(0, turn) * (z - centre); }
};

// Distance of a window's velocity from the rigid one, in what noise and creep allow.
double misfit(const Window& w, const Rigid& r, double noise) {
  const Complex expected = r.velocity(w.place);
  const double variance = noise * noise / w.weight + kSlip * kSlip * std::norm(expected);
  return std::norm(w.velocity - expected) / variance;
}

constexpr double kFits = 9;  // misfit of two components: 1 % of those that belong are missed

// Windows that agree, each by how surely it moves; where there are many, some of them.
double support(const std::vector<Window>& windows, const Rigid& r, double noise) {
  double sum = 0;
  const std::size_t step = windows.size() / kVoters + 1;
  for (std::size_t i = 0; i < windows.size(); i += step) {
    const Window& w = windows[i];
    const double clear = std::abs(w.velocity) * std::sqrt(w.weight) / noise;
    sum += std::min(1.0, clear / 10) * std::max(0.0, 1 - misfit(w, r, noise) / kFits);
  }
  return sum;
}

// All arcs on circles about one centre at one speed: with the speed given this is linear, arc by arc with its own start
// (q): z - c = q exp(i turn t).
struct CommonTurn {
  Complex centre;
  double squares = 0;
};

CommonTurn turn_about(const std::vector<const Window*>& arcs, double turn, const std::optional<Complex>& known) {
  Complex ba = 0;
  double bb = 0, aa = 0;
  for (const Window* w : arcs) {
    Complex ez = 0, e1 = 0;
    const double n = static_cast<double>(w->seen.size());
    for (const Seen& s : w->seen) {
      const Complex e = std::polar(1.0, -turn * (s.t - w->seen.front().t));
      ez += e * s.z / n;
      e1 += e / n;
    }
    for (const Seen& s : w->seen) {
      const Complex e = std::polar(1.0, turn * (s.t - w->seen.front().t));
      const Complex a = s.z - e * ez, b = 1.0 - e * e1;
      ba += std::conj(b) * a;
      bb += std::norm(b);
      aa += std::norm(a);
    }
  }
  CommonTurn c;
  c.centre = known ? *known : ba / bb;
  c.squares = aa - 2 * std::real(std::conj(c.centre) * ba) + std::norm(c.centre) * bb;
  return c;
}

// The speed with the least squares, by golden section.
double best_turn(const std::vector<const Window*>& arcs, double turn, const std::optional<Complex>& known) {
  constexpr double kRatio = 0.6180339887498949, kRange = 0.1;
  double low = turn * (1 - kRange), high = turn * (1 + kRange);
  for (int i = 0; i < 25; ++i) {
    const double a = high - kRatio * (high - low), b = low + kRatio * (high - low);
    if (turn_about(arcs, a, known).squares < turn_about(arcs, b, known).squares)
      high = b;
    else
      low = a;
  }
  return 0.5 * (low + high);
}

// Neighbouring windows of one track as one arc: the longer, the better it knows its centre.
std::vector<Window> joined(const std::vector<const Window*>& windows) {
  std::vector<Window> arcs;
  for (const Window* w : windows) {
    if (!arcs.empty() && arcs.back().track == w->track && w->seen.front().t - arcs.back().seen.back().t <= kLargestGap)
      arcs.back().seen.insert(arcs.back().seen.end(), w->seen.begin(), w->seen.end());
    else
      arcs.push_back(*w);
  }
  return arcs;
}

double noise_of(const std::vector<Window>& windows) {
  std::vector<double> variances;
  for (const Window& w : windows) variances.push_back(w.squares / w.freedom);
  return std::max(std::sqrt(median_of(std::move(variances))), 1e-3);
}

}  // namespace

Turning find_turning(std::span<const PixelSighting> sightings, const std::optional<PixelPoint>& centre) {
  Turning turning;
  const std::vector<Window> windows = windows_of(sightings);
  if (windows.size() < kLeastArcs) return turning;
  const double noise = noise_of(windows);
  std::optional<Complex> known;
  if (centre) known = Complex(centre->u, -centre->v);

  Rigid best;
  double most = 0;
  Random random(7);
  for (int i = 0; i < kGuesses; ++i) {
    const Window &a = windows[random.below(windows.size())], &b = windows[random.below(windows.size())];
    const Complex apart = a.place - (known ? *known : b.place);
    if (std::abs(apart) == 0 || a.track == b.track) continue;
    const Complex rate = (a.velocity - (known ? Complex(0) : b.velocity)) / (Complex(0, 1) * apart);
    Rigid r;
    r.turn = rate.real();
    if (std::abs(r.turn) < kLeastTurn || std::abs(r.turn) > kMostTurn) continue;
    r.centre = known ? *known : 0.5 * (a.place + b.place - (a.velocity + b.velocity) / Complex(0, r.turn));
    const double s = support(windows, r, noise);
    if (s > most) most = s, best = r;
  }
  if (most == 0) return turning;

  std::vector<Window> arcs;
  double found = 0;
  CommonTurn common;
  for (int round = 0; round < 5; ++round) {
    std::vector<const Window*> carried;
    for (const Window& w : windows)
      if (misfit(w, best, noise) < kFits) carried.push_back(&w);
    arcs = joined(carried);
    if (arcs.size() < kLeastArcs) return turning;
    found = static_cast<double>(arcs.size());
    std::stable_sort(arcs.begin(), arcs.end(),
                     [](const Window& a, const Window& b) { return a.seen.size() > b.seen.size(); });
    arcs.resize(std::min(arcs.size(), kMostArcs));
    carried.clear();
    for (const Window& w : arcs) carried.push_back(&w);
    best.turn = best_turn(carried, best.turn, known);
    common = turn_about(carried, best.turn, known);
    best.centre = common.centre;
  }

  // Errors by the jackknife over groups of arcs: balls creep, each its own way, which noise knows nothing of.
  const std::size_t groups = std::min(kGroups, arcs.size());
  Complex mean_centre = 0;
  double mean_turn = 0;
  std::vector<Rigid> without;
  for (std::size_t g = 0; g < groups; ++g) {
    std::vector<const Window*> rest;
    for (std::size_t k = 0; k < arcs.size(); ++k)
      if (k % groups != g) rest.push_back(&arcs[k]);
    Rigid r;
    r.turn = best_turn(rest, best.turn, known);
    r.centre = turn_about(rest, r.turn, known).centre;
    without.push_back(r);
    mean_centre += r.centre / static_cast<double>(groups);
    mean_turn += r.turn / static_cast<double>(groups);
  }
  double centre_squares = 0, turn_squares = 0;
  for (const Rigid& r : without) {
    centre_squares += 0.5 * std::norm(r.centre - mean_centre);
    turn_squares += (r.turn - mean_turn) * (r.turn - mean_turn);
  }
  const double factor = static_cast<double>(groups - 1) / static_cast<double>(groups);
  turning.found = true;
  turning.centre = {best.centre.real(), -best.centre.imag()};
  double reach = 0;
  for (const Window& w : windows) reach = std::max(reach, std::abs(w.place - best.centre));
  turning.centre_se =
      known ? 0.0 : std::sqrt(factor * centre_squares + kCommonCreep * kCommonCreep * reach * reach / found);
  turning.turn_per_frame = {best.turn, std::sqrt(factor * turn_squares)};
  return turning;
}

Shell find_shell(std::span<const PixelSighting> sightings, const PixelPoint& centre, double centre_se) {
  constexpr int kSectors = 36, kRounds = 40;
  // A ball may look a hair beyond the shell, but lifters and an empty sector keep all of a sector's balls far inside
  // it.
  constexpr double kBeyond = 0.01, kInside = 0.1;  // of the radius
  Shell shell{centre, 0};
  for (const PixelSighting& s : sightings)
    shell.radius = std::max(shell.radius, std::hypot(s.u - centre.u, s.v - centre.v) + s.radius);
  const double largest = shell.radius;
  for (int round = 0; round < kRounds; ++round) {
    std::vector<std::vector<std::pair<double, const PixelSighting*>>> sectors(kSectors);
    for (const PixelSighting& s : sightings) {
      const double du = s.u - shell.centre.u, dv = s.v - shell.centre.v;
      const auto k = static_cast<std::size_t>(wrap_360(degrees(std::atan2(-dv, du))) / 360 * kSectors);
      sectors[std::min<std::size_t>(k, kSectors - 1)].emplace_back(std::hypot(du, dv) + s.radius, &s);
    }
    Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (auto& sector : sectors) {
      if (sector.size() < 3) continue;
      const std::size_t wild = std::max<std::size_t>(1, sector.size() / 50);  // false ones lie anywhere
      const auto at = sector.begin() + static_cast<std::ptrdiff_t>(wild);
      std::nth_element(sector.begin(), at, sector.end(), std::greater<>());
      const PixelSighting& s = *at->second;
      const double du = s.u - shell.centre.u, dv = s.v - shell.centre.v, d = std::hypot(du, dv);
      const double excess = at->first - shell.radius;
      const double error = (excess > 0 ? kBeyond : kInside) * largest;
      const Eigen::Vector3d row(du / d, dv / d, 1);
      m += row * row.transpose() / (error * error);
      b += row * excess / (error * error);
    }
    const double prior = std::max(centre_se, 1e-3);
    m(0, 0) += 1 / (prior * prior), m(1, 1) += 1 / (prior * prior);
    b(0) += (centre.u - shell.centre.u) / (prior * prior), b(1) += (centre.v - shell.centre.v) / (prior * prior);
    const Eigen::Vector3d step = m.ldlt().solve(b);
    shell.centre.u += step(0), shell.centre.v += step(1), shell.radius += step(2);
    if (step.norm() < 1e-3) break;
  }
  return shell;
}

}  // namespace tumble::analysis
