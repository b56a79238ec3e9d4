#include "analysis/mill_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "core/units.h"

namespace tumble::analysis {
namespace {

constexpr double kBin = 0.25;  // of histograms [px]

std::vector<double> smooth_histogram(const std::vector<double>& values, double top, double sigma) {
  std::vector<double> h(static_cast<std::size_t>(top / kBin) + 2, 0.0);
  for (double v : values)
    if (v >= 0 && v < top) h[static_cast<std::size_t>(v / kBin)] += 1;
  const int reach = static_cast<int>(std::ceil(3 * sigma / kBin));
  std::vector<double> smoothed(h.size(), 0.0);
  for (int i = 0; i < static_cast<int>(h.size()); ++i)
    for (int k = std::max(0, i - reach); k <= std::min<int>(static_cast<int>(h.size()) - 1, i + reach); ++k)
      smoothed[i] += h[k] * std::exp(-0.5 * std::pow((k - i) * kBin / sigma, 2));
  return smoothed;
}

}  // namespace

Contacts find_contacts(const std::vector<std::vector<Detection>>& frames, int size_class) {
  std::vector<double> gaps;
  double radius = 0;
  for (const auto& f : frames)
    for (std::size_t i = 0; i < f.size(); ++i) {
      if (f[i].size_class != size_class) continue;
      radius = f[i].radius;
      for (std::size_t j = i + 1; j < f.size(); ++j) {
        if (f[j].size_class != size_class) continue;
        const double gap = std::hypot(f[i].u - f[j].u, f[i].v - f[j].v);
        if (gap < 3.2 * f[i].radius) gaps.push_back(gap);
      }
    }
  if (gaps.size() < 60) return {};
  const auto h = smooth_histogram(gaps, 3.2 * radius, std::max(0.5, 0.05 * radius));
  const auto peak = std::max_element(h.begin(), h.end());
  return {(static_cast<double>(peak - h.begin()) + 0.5) * kBin, static_cast<int>(gaps.size())};
}

LightShift find_light_shift(const std::vector<std::vector<Detection>>& frames, const std::vector<double>& radii) {
  struct Pair {
    double ratio;   // distance / sum of radii
    double pu, pv;  // direction from j to i times (ri - rj) / (ri + rj)
  };
  std::vector<Pair> pairs;
  std::vector<double> ratios;
  for (const auto& f : frames)
    for (std::size_t i = 0; i < f.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const double ri = radii[static_cast<std::size_t>(f[i].size_class)];
        const double rj = radii[static_cast<std::size_t>(f[j].size_class)];
        const double unlike = (ri - rj) / (ri + rj), du = f[i].u - f[j].u, dv = f[i].v - f[j].v;
        const double gap = std::hypot(du, dv), ratio = gap / (ri + rj);
        if (std::abs(unlike) < 0.1 || std::abs(ratio - 1) > 0.12) continue;
        pairs.push_back({ratio, unlike * du / gap, unlike * dv / gap});
        ratios.push_back(100 * ratio);
      }
  LightShift shift;
  if (pairs.size() < 300) return shift;
  // ratio = q - s . p, with the share q of the radii at which touching balls are seen; neighbours that do not touch
  // lie on one side of it alike in all directions.
  const auto histogram = smooth_histogram(ratios, 115, 1);
  double q = (static_cast<double>(std::max_element(histogram.begin(), histogram.end()) - histogram.begin()) + 0.5) *
             kBin / 100;
  for (const double window : {0.06, 0.045, 0.03, 0.03, 0.03, 0.03}) {
    cv::Matx33d a = cv::Matx33d::zeros();
    cv::Vec3d b(0, 0, 0);
    for (const Pair& p : pairs) {
      const double miss = (p.ratio - q + shift.u * p.pu + shift.v * p.pv) / window;
      if (std::abs(miss) >= 1) continue;
      const double w = (1 - miss * miss) * (1 - miss * miss);
      const cv::Vec3d row(1, -p.pu, -p.pv);
      a += w * row * row.t();
      b += w * p.ratio * row;
    }
    cv::Vec3d x;
    if (a(0, 0) < 100 || !cv::solve(a, b, x, cv::DECOMP_CHOLESKY)) return {};
    q = x[0];
    shift = {true, x[1], x[2]};
  }
  return shift;
}

ShellTouch find_shell_touch(const std::vector<std::vector<Detection>>& frames, int size_class,
                            const std::vector<double>& radii, const Circle& centre, double least, double most) {
  struct Place {
    double rho, cu, cv;  // distance and direction from the centre
    bool touching;       // another ball
  };
  std::vector<Place> places;
  std::vector<double> distances;
  const double radius = radii[static_cast<std::size_t>(size_class)];
  for (const auto& f : frames)
    for (const Detection& d : f) {
      if (d.size_class != size_class) continue;
      const double du = d.u - centre.u, dv = d.v - centre.v, rho = std::hypot(du, dv);
      if (rho < std::max(1.0, least) || rho > most) continue;
      const bool touching = std::any_of(f.begin(), f.end(), [&](const Detection& o) {
        const double gap = 1.08 * (radius + radii[static_cast<std::size_t>(o.size_class)]);
        return &o != &d && std::hypot(o.u - d.u, o.v - d.v) < gap;
      });
      places.push_back({rho, du / rho, dv / rho, touching});
      distances.push_back(rho);
    }
  ShellTouch touch;
  if (places.size() < 15) return touch;
  const double top = *std::max_element(distances.begin(), distances.end()) + 4;
  const double sigma = std::max(0.5, 0.06 * radius);
  const auto histogram = smooth_histogram(distances, top, sigma);
  const double typical = *std::max_element(histogram.begin(), histogram.end());
  for (std::size_t i = histogram.size() - 2; i > 0; --i) {  // from outside inwards
    if (histogram[i] < 0.25 * typical || histogram[i] < histogram[i - 1] || histogram[i] < histogram[i + 1]) continue;
    const double reach = (static_cast<double>(i) + 0.5) * kBin;
    int crowd = 0, touching = 0;
    for (const Place& p : places) {
      if (std::abs(p.rho - reach) > 3 * sigma) continue;
      ++crowd;
      touching += p.touching;
    }
    if (crowd < 15 || touching < 0.25 * crowd) continue;
    touch.found = true;
    touch.reach = reach;
    touch.count = crowd;
    // rho = reach - shift . direction for balls at the shell; robust least squares with a window that closes in.
    for (double window : {3.0 * sigma, 2.0 * sigma, 2.0 * sigma, 2.0 * sigma, 2.0 * sigma}) {
      cv::Matx33d a = cv::Matx33d::zeros();
      cv::Vec3d b(0, 0, 0);
      for (const Place& p : places) {
        const double miss = p.rho - touch.reach + touch.shift_u * p.cu + touch.shift_v * p.cv;
        if (std::abs(miss) >= window) continue;
        const double k = 1 - miss * miss / (window * window), w = k * k;
        const cv::Vec3d row(1, -p.cu, -p.cv);
        a += w * row * row.t();
        b += w * p.rho * row;
      }
      cv::Vec3d x;
      // A short arc cannot tell a shift from a smaller reach.
      const cv::Matx22d spread(a(1, 1) - a(0, 1) * a(0, 1) / a(0, 0), a(1, 2) - a(0, 1) * a(0, 2) / a(0, 0),
                               a(1, 2) - a(0, 1) * a(0, 2) / a(0, 0), a(2, 2) - a(0, 2) * a(0, 2) / a(0, 0));
      const double weaker = 0.5 * (spread(0, 0) + spread(1, 1)) -
                            std::sqrt(0.25 * std::pow(spread(0, 0) - spread(1, 1), 2) + spread(0, 1) * spread(0, 1));
      if (weaker > 0.04 * a(0, 0) && cv::solve(a, b, x, cv::DECOMP_CHOLESKY)) {
        touch.reach = x[0];
        touch.shift_u = x[1];
        touch.shift_v = x[2];
      } else {
        touch.reach = b[0] / a(0, 0);
        touch.shift_u = touch.shift_v = 0;
      }
    }
    return touch;
  }
  return touch;
}

}  // namespace tumble::analysis
