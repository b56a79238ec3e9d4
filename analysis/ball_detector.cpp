#include "analysis/ball_detector.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "core/units.h"

namespace tumble::analysis {
namespace {

constexpr int kDirections = 32;        // round a rim
constexpr float kLeastWeight = 0.4f;   // of an edge that votes
constexpr double kLeastHeight = 0.12;  // of a place that is looked at more closely, in votes of a full clear rim
constexpr double kHopeless = 0.08;     // score at which a place is given up
constexpr double kNearest = 0.80;      // centres of two balls come no nearer than this share of their radii's sum

struct Direction {
  float u, v;
};

const std::array<Direction, kDirections>& directions() {
  static const auto table = [] {
    std::array<Direction, kDirections> t{};
    for (int k = 0; k < kDirections; ++k)
      t[static_cast<std::size_t>(k)] = {static_cast<float>(std::cos(2 * kPi * k / kDirections)),
                                        static_cast<float>(std::sin(2 * kPi * k / kDirections))};
    return t;
  }();
  return table;
}

struct Vote {    // an edge pixel
  float u, v;    // in the window
  float du, dv;  // unit vector towards the ball's inside
  float weight;
};

std::vector<Vote> collect_votes(const EdgeMap& edges, int polarity, const Circle& bound) {
  std::vector<Vote> votes;
  const float level = static_cast<float>(edges.level);
  const float least = level * kLeastWeight / (1 - kLeastWeight);
  const double cu = bound.u - edges.origin.x, cv = bound.v - edges.origin.y;
  for (int v = 0; v < edges.gradient.rows; ++v) {
    const double reach2 = bound.radius * bound.radius - (v - cv) * (v - cv);
    if (reach2 <= 0) continue;
    const double reach = std::sqrt(reach2);
    const int from = std::max(0, static_cast<int>(std::ceil(cu - reach)));
    const int to = std::min(edges.gradient.cols - 1, static_cast<int>(std::floor(cu + reach)));
    const float* g = edges.gradient.ptr<float>(v);
    for (int u = from; u <= to; ++u) {
      const float square = g[2 * u] * g[2 * u] + g[2 * u + 1] * g[2 * u + 1];
      if (square < least * least) continue;
      const float m = std::sqrt(square), s = static_cast<float>(polarity) / m;
      votes.push_back({static_cast<float>(u), static_cast<float>(v), s * g[2 * u], s * g[2 * u + 1], m / (m + level)});
    }
  }
  return votes;
}

// Votes are counted on a grid as coarse as the balls allow: a third of a pixel is found on the rim anyway.
int grid_step(double radius) { return radius >= 7.0 ? 2 : 1; }

// Votes for centres of radius r, scaled so that a full, clear rim gives about 1 whatever r is.
cv::Mat accumulate_votes(const std::vector<Vote>& votes, cv::Size window, double r, int step) {
  const cv::Size size((window.width + step - 1) / step, (window.height + step - 1) / step);
  cv::Mat sum = cv::Mat::zeros(size, CV_32F);
  const float radius = static_cast<float>(r), fine = 1.0f / static_cast<float>(step);
  for (const Vote& e : votes) {
    const int u = static_cast<int>((e.u + radius * e.du) * fine + 0.5f),
              v = static_cast<int>((e.v + radius * e.dv) * fine + 0.5f);
    if (static_cast<unsigned>(u) < static_cast<unsigned>(size.width) &&
        static_cast<unsigned>(v) < static_cast<unsigned>(size.height))
      sum.ptr<float>(v)[u] += e.weight;
  }
  // Directions of gradients are good to a few degrees: the votes of one ball fill a spot that grows with r.
  const double sigma = std::max(0.6, (0.8 + 0.06 * r) / step);
  cv::GaussianBlur(sum, sum, {}, sigma);
  const double spot = 2 * kPi * sigma * sigma;  // peak of a unit vote spread over the spot is 1 / spot
  sum *= spot / (2 * kPi * r * 2.0);            // an edge is about two pixels wide
  return sum;
}

struct Peak {
  double u, v, radius, height;
  int size_class;
};

void find_peaks(const cv::Mat& votes, int step, double least, double radius, int size_class, std::vector<Peak>& peaks) {
  const float lowest = static_cast<float>(least);
  for (int v = 1; v + 1 < votes.rows; ++v) {
    const float* above = votes.ptr<float>(v - 1);
    const float* here = votes.ptr<float>(v);
    const float* below = votes.ptr<float>(v + 1);
    for (int u = 1; u + 1 < votes.cols; ++u) {
      const float h = here[u];
      if (h < lowest || h < here[u - 1] || h <= here[u + 1] || h < above[u] || h <= below[u] || h < above[u - 1] ||
          h < above[u + 1] || h <= below[u - 1] || h <= below[u + 1])
        continue;
      peaks.push_back({static_cast<double>(step * u), static_cast<double>(step * v), radius, h, size_class});
    }
  }
}

// Of the peaks of one class that lie within one ball only the highest.
std::vector<Peak> thin_out(std::vector<Peak> peaks) {
  std::sort(peaks.begin(), peaks.end(), [](const Peak& a, const Peak& b) {
    if (a.height != b.height) return a.height > b.height;
    return a.u != b.u ? a.u < b.u : a.v < b.v;
  });
  std::vector<Peak> kept;
  for (const Peak& p : peaks) {
    const double near = 0.5 * p.radius;
    const bool taken = std::any_of(kept.begin(), kept.end(), [&](const Peak& k) {
      return k.size_class == p.size_class && (k.u - p.u) * (k.u - p.u) + (k.v - p.v) * (k.v - p.v) < near * near;
    });
    if (!taken) kept.push_back(p);
  }
  return kept;
}

// Best first, each only where no better one lies in its place. Of two circles with equal rims the larger explains more
// of the picture: `by_size` ranks by score times radius, against the small circles that marks and highlights make.
std::vector<Detection> keep_apart(std::vector<Detection> found, double nearest, bool by_size) {
  std::sort(found.begin(), found.end(), [by_size](const Detection& a, const Detection& b) {
    const double p = a.score * (by_size ? a.radius : 1.0), q = b.score * (by_size ? b.radius : 1.0);
    if (p != q) return p > q;
    return a.u != b.u ? a.u < b.u : a.v < b.v;
  });
  std::vector<Detection> kept;
  for (const Detection& d : found) {
    const bool taken = std::any_of(kept.begin(), kept.end(), [&](const Detection& k) {
      const double least = nearest * (k.radius + d.radius);
      return (k.u - d.u) * (k.u - d.u) + (k.v - d.v) * (k.v - d.v) < least * least;
    });
    if (!taken) kept.push_back(d);
  }
  return kept;
}

cv::Rect window_of(const Circle& bound, cv::Size size) {
  const int u0 = static_cast<int>(std::floor(bound.u - bound.radius)) - 2;
  const int v0 = static_cast<int>(std::floor(bound.v - bound.radius)) - 2;
  const int side = static_cast<int>(std::ceil(2 * bound.radius)) + 5;
  return cv::Rect(u0, v0, side, side) & cv::Rect({0, 0}, size);
}

bool inside(const Detection& d, const Circle& bound) {
  return std::hypot(d.u - bound.u, d.v - bound.v) + d.radius <= bound.radius;
}

}  // namespace

Detection refine_on_rim(const EdgeMap& edges, int polarity, double u, double v, double radius, bool free_radius) {
  Detection d{u, v, radius, 0, 0};
  constexpr int kSteps = 11;  // along each direction, odd
  for (int round = 0; round < (free_radius ? 3 : 2); ++round) {
    const double reach = (round == 0 ? 0.3 : 0.18) * d.radius + 1.0;
    const double step = 2 * reach / (kSteps - 1);
    double score = 0;
    double suu = 0, suv = 0, svv = 0, su = 0, sv = 0, s0 = 0, bu = 0, bv = 0, b0 = 0;
    for (const Direction& n : directions()) {
      std::array<float, kSteps> response{};
      int best = -1;
      float most = 0;
      for (int k = 0; k < kSteps; ++k) {
        const float x = 2.0f * static_cast<float>(k) / (kSteps - 1) - 1.0f;
        const float r = static_cast<float>(d.radius + reach * x);
        const float towards =
            edges.along(static_cast<float>(d.u) + r * n.u, static_cast<float>(d.v) + r * n.v, n.u, n.v);
        response[k] = std::max(0.0f, static_cast<float>(-polarity) * towards);
        const float judged = response[k] * (1 - 0.5f * x * x);  // of two edges the nearer one
        if (judged > most) {
          most = judged;
          best = k;
        }
      }
      if (best < 1 || best + 1 >= kSteps) continue;
      const double l = response[best - 1], m = response[best], h = response[best + 1];
      const double curve = l - 2 * m + h;
      const double offset = -reach + (best + (curve < 0 ? std::clamp(0.5 * (l - h) / curve, -0.5, 0.5) : 0.0)) * step;
      const double clear = m / (m + edges.level);
      const double miss = offset / (round == 0 ? reach : std::max(1.5, 0.15 * d.radius));
      if (std::abs(miss) >= 1) continue;
      const double w = clear * (1 - miss * miss) * (1 - miss * miss);
      score += w;
      // offset = n . shift + growth
      suu += w * n.u * n.u;
      suv += w * n.u * n.v;
      svv += w * n.v * n.v;
      su += w * n.u;
      sv += w * n.v;
      s0 += w;
      bu += w * n.u * offset;
      bv += w * n.v * offset;
      b0 += w * offset;
    }
    d.score = score / kDirections;
    if (d.score < kHopeless) break;
    if (free_radius) {
      const cv::Matx33d a(suu, suv, su, suv, svv, sv, su, sv, s0);
      cv::Vec3d x;
      if (s0 < 3 || !cv::solve(a, cv::Vec3d(bu, bv, b0), x, cv::DECOMP_CHOLESKY)) break;
      d.u += x[0];
      d.v += x[1];
      d.radius = std::max(0.5 * radius, d.radius + x[2]);
    } else {
      const double det = suu * svv - suv * suv;
      if (!(det > 0.02 * s0 * s0)) break;
      d.u += (svv * bu - suv * bv) / det;
      d.v += (suu * bv - suv * bu) / det;
    }
  }
  return d;
}

std::vector<Detection> detect_balls(const cv::Mat& bgr, const BallLook& look, const Circle& bound) {
  const cv::Rect window = window_of(bound, bgr.size());
  if (window.width < 8 || window.height < 8 || look.radii.empty()) return {};
  const EdgeMap edges = make_edge_map(bgr, window, 0.8, look.edge_level);
  const auto votes = collect_votes(edges, look.polarity, bound);
  std::vector<Peak> peaks;
  const int step = grid_step(look.radii.front());
  for (std::size_t k = 0; k < look.radii.size(); ++k)
    find_peaks(accumulate_votes(votes, window.size(), look.radii[k], step), step, kLeastHeight, look.radii[k],
               static_cast<int>(k), peaks);
  std::vector<Detection> found;
  for (const Peak& p : thin_out(std::move(peaks))) {
    Detection d = refine_on_rim(edges, look.polarity, p.u + window.x, p.v + window.y, p.radius, false);
    d.size_class = p.size_class;
    if (std::hypot(d.u - p.u - window.x, d.v - p.v - window.y) > 0.5 * p.radius) continue;
    if (d.score >= look.least_score && inside(d, bound)) found.push_back(d);
  }
  return keep_apart(std::move(found), kNearest, false);
}

namespace {

constexpr double kClassWidth = 0.05;  // spread of fitted radii within a class, of the logarithm

// Free circles on the rims of anything round, of any size.
std::vector<Detection> free_circles(const EdgeMap& edges, int polarity, const Circle& bound) {
  const double smallest = std::max(3.0, 0.012 * bound.radius), largest = 0.2 * bound.radius;
  const auto votes = collect_votes(edges, polarity, bound);
  std::vector<Detection> found;
  for (double r = smallest; r < largest; r *= 1.1) {
    std::vector<Peak> peaks;
    const int step = grid_step(r);
    find_peaks(accumulate_votes(votes, edges.gradient.size(), r, step), step, 0.2, r, 0, peaks);
    constexpr std::size_t kMost = 400;
    if (peaks.size() > kMost) {
      std::nth_element(peaks.begin(), peaks.begin() + kMost, peaks.end(),
                       [](const Peak& a, const Peak& b) { return a.height > b.height; });
      peaks.resize(kMost);
    }
    for (const Peak& p : peaks) {
      const double u = p.u + edges.origin.x, v = p.v + edges.origin.y;
      const Detection d = refine_on_rim(edges, polarity, u, v, r, true);
      if (std::hypot(d.u - u, d.v - v) > 0.5 * r || d.radius > 1.3 * r || d.radius < 0.7 * r) continue;
      if (d.score > 0.33 && inside(d, bound)) found.push_back(d);
    }
  }
  return keep_apart(std::move(found), kNearest, true);
}

// How well classes of these radii explain what was found, by area.
double explained(const std::vector<Detection>& found, const std::vector<double>& radii) {
  double sum = 0;
  for (const Detection& d : found) {
    double best = 0;
    for (double r : radii) best = std::max(best, std::exp(-0.5 * std::pow(std::log(d.radius / r) / kClassWidth, 2)));
    sum += best * d.score * d.radius * d.radius;
  }
  return sum;
}

std::vector<double> classes_of(const std::vector<Detection>& found, const std::vector<double>& known,
                               ScaleRange scales) {
  double smallest = 1e9, largest = 0;
  for (const Detection& d : found) {
    smallest = std::min(smallest, d.radius);
    largest = std::max(largest, d.radius);
  }
  std::vector<double> classes;
  if (!known.empty()) {  // one unknown: pixels per unit
    double best = 0, scale = 0;
    for (double s = smallest / known.back(); s < largest / known.front(); s *= 1.005) {
      if (s < scales.least || s > scales.most) continue;
      std::vector<double> radii;
      for (double r : known) radii.push_back(s * r);
      const double value = explained(found, radii);
      if (value > best) {
        best = value;
        scale = s;
      }
    }
    for (double r : known) classes.push_back(scale * r);
    return classes;
  }
  // The size that explains most, then the next, as long as it explains a good share of what is left.
  double total = 0;
  for (const Detection& d : found) total += d.score * d.radius * d.radius;
  double have = 0;
  while (classes.size() < 6) {
    double best = 0, radius = 0;
    for (double r = smallest; r < largest; r *= 1.01) {
      auto more = classes;
      more.push_back(r);
      if (std::any_of(classes.begin(), classes.end(), [&](double c) { return std::abs(std::log(c / r)) < 0.12; }))
        continue;
      const double gain = explained(found, more) - have;
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

BallLook learn_look(const std::vector<cv::Mat>& pictures, const Circle& bound, const std::vector<double>& known,
                    ScaleRange scales) {
  BallLook look;
  if (pictures.empty()) return look;
  const cv::Rect window = window_of(bound, pictures.front().size());
  std::vector<EdgeMap> maps;
  double level = 0;
  for (const cv::Mat& p : pictures) {
    maps.push_back(make_edge_map(p, window, 0.8, 0));
    level += maps.back().level / static_cast<double>(pictures.size());
  }
  for (EdgeMap& m : maps) m.level = level;
  look.edge_level = level;

  // Polarity from one picture: the sign whose circles cover more.
  std::array<double, 2> area{};
  for (int side = 0; side < 2; ++side)
    for (const Detection& d : free_circles(maps[0], side == 0 ? 1 : -1, bound))
      area[side] += d.score * d.radius * d.radius;
  look.polarity = area[0] >= area[1] ? 1 : -1;
  std::vector<Detection> found;
  for (std::size_t i = 0; i < maps.size() && i < 4; ++i) {
    const auto here = free_circles(maps[i], look.polarity, bound);
    found.insert(found.end(), here.begin(), here.end());
  }
  if (!found.empty()) look.radii = classes_of(found, known, scales);
  return look;
}

}  // namespace tumble::analysis
