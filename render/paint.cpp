#include "render/paint.h"

#include <algorithm>
#include <cmath>

#include "core/units.h"

namespace tumble::render {
namespace {

Spot turned(const Spot& p, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c * p.x() + s * p.y(), c * p.y() - s * p.x()};
}

double lattice(int i, int j, int period, std::uint64_t seed) {
  const auto wrapped = [period](int k) { return static_cast<std::uint64_t>(((k % period) + period) % period); };
  return Random(seed + 0x9E37ull * wrapped(i) + 0x85EBCA6Bull * wrapped(j)).uniform();
}

}  // namespace

void paint(Sheet& sheet, const Paint& with, const Spot& low, const Spot& high,
           const std::function<double(const Spot&)>& inside) {
  const double soft = std::max(with.soft, 0.5);
  const auto clipped = [](double value, int size) { return std::clamp(static_cast<int>(value), 0, size); };
  const int left = clipped(std::floor(low.x() - soft), sheet.width),
            top = clipped(std::floor(low.y() - soft), sheet.height);
  const int right = clipped(std::ceil(high.x() + soft) + 1, sheet.width);
  const int bottom = clipped(std::ceil(high.y() + soft) + 1, sheet.height);
  for (int j = top; j < bottom; ++j) {
    for (int i = left; i < right; ++i) {
      const double edge = std::clamp(0.5 + inside(Spot(i, j)) / soft, 0.0, 1.0);
      const auto cover = static_cast<float>(with.cover * edge * edge * (3 - 2 * edge));
      if (cover <= 0) continue;
      float* p = sheet.at(i, j);
      for (int c = 0; c < 3; ++c) p[c] = p[c] * (1 - cover) + with.colour[c] * cover;
      p[3] = p[3] * (1 - cover) + cover;
    }
  }
}

void paint_disc(Sheet& sheet, const Paint& with, const Spot& centre, double radius) {
  const Spot reach(radius, radius);
  paint(sheet, with, centre - reach, centre + reach, [&](const Spot& p) { return radius - (p - centre).norm(); });
}

void paint_ring(Sheet& sheet, const Paint& with, const Spot& centre, double radius, double width) {
  const Spot reach(radius + width, radius + width);
  paint(sheet, with, centre - reach, centre + reach,
        [&](const Spot& p) { return width / 2 - std::abs((p - centre).norm() - radius); });
}

void paint_stroke(Sheet& sheet, const Paint& with, const Spot& from, const Spot& to, double width) {
  paint_line(sheet, with, {from, to}, width);
}

void paint_line(Sheet& sheet, const Paint& with, const std::vector<Spot>& points, double width) {
  Spot low = points.front(), high = low;
  for (const Spot& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Spot reach(width, width);
  paint(sheet, with, low - reach, high + reach, [&](const Spot& p) {
    double off2 = 1e18;
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      const Spot way = points[k + 1] - points[k];
      const double along = std::clamp((p - points[k]).dot(way) / std::max(way.squaredNorm(), 1e-9), 0.0, 1.0);
      off2 = std::min(off2, (p - points[k] - along * way).squaredNorm());
    }
    return width / 2 - std::sqrt(off2);
  });
}

void paint_box(Sheet& sheet, const Paint& with, const Spot& centre, const Spot& half, double angle) {
  const Spot reach(half.norm(), half.norm());
  paint(sheet, with, centre - reach, centre + reach, [&](const Spot& p) {
    const Spot q = turned(p - centre, angle);
    return std::min(half.x() - std::abs(q.x()), half.y() - std::abs(q.y()));
  });
}

void paint_polygon(Sheet& sheet, const Paint& with, const Spot& centre, double radius, int corners, double angle) {
  const Spot reach(radius, radius);
  paint(sheet, with, centre - reach, centre + reach, [&](const Spot& p) {
    const Spot q = p - centre;
    const double sector = 2 * kPi / corners;
    const double a = std::remainder(std::atan2(q.y(), q.x()) - angle, sector);
    return radius * std::cos(sector / 2) - q.norm() * std::cos(a);
  });
}

void paint_writing(Sheet& sheet, const Paint& with, const Spot& begin, const Spot& direction, double height, int count,
                   Random& random) {
  const Spot along = direction.normalized(), up(along.y(), -along.x());
  const double width = 0.55 * height, line = std::max(0.12 * height, 0.8);
  const auto knot = [&](int sign, std::uint64_t k) -> Spot {  // of a grid of 3 x 3 on which a sign's strokes end
    const auto x = static_cast<double>(k % 3) / 2, y = static_cast<double>(k / 3) / 2;
    return begin + along * (sign * 0.8 * height + x * width) + up * (y * height);
  };
  for (int sign = 0; sign < count; ++sign) {
    if (chance(random, 0.12)) continue;
    std::uint64_t here = random.below(9);
    const int strokes = 2 + static_cast<int>(random.below(3));
    for (int s = 0; s < strokes; ++s) {
      const std::uint64_t next = random.below(9);
      paint_stroke(sheet, with, knot(sign, here), knot(sign, next), line);
      here = next;
    }
  }
}

void add_glow(Sheet& sheet, const Light& colour, const Spot& centre, const Spot& half, double angle) {
  const double reach = 3 * std::max(half.x(), half.y());
  const auto clipped = [](double value, int size) { return std::clamp(static_cast<int>(value), 0, size); };
  const int left = clipped(centre.x() - reach, sheet.width), right = clipped(centre.x() + reach, sheet.width);
  const int top = clipped(centre.y() - reach, sheet.height), bottom = clipped(centre.y() + reach, sheet.height);
  for (int j = top; j < bottom; ++j) {
    for (int i = left; i < right; ++i) {
      const Spot q = turned(Spot(i, j) - centre, angle);
      const double x = q.x() / half.x(), y = q.y() / half.y(), r2 = x * x + y * y;
      if (r2 > 9) continue;
      const auto glow = static_cast<float>(std::exp(-r2));
      for (int c = 0; c < 3; ++c) sheet.at(i, j)[c] += glow * colour[c];
    }
  }
}

Sheet shifted(const Sheet& sheet, const Spot& by) {
  Sheet moved(sheet.width, sheet.height);
  const double left = std::floor(-by.x()), up = std::floor(-by.y());
  const auto a = static_cast<float>(-by.x() - left), b = static_cast<float>(-by.y() - up);
  const auto column = [&](int i) { return std::clamp(i + static_cast<int>(left), 0, sheet.width - 1); };
  const auto row = [&](int j) { return std::clamp(j + static_cast<int>(up), 0, sheet.height - 1); };
  for (int j = 0; j < sheet.height; ++j)
    for (int i = 0; i < sheet.width; ++i) {
      const float *p = sheet.at(column(i), row(j)), *q = sheet.at(column(i + 1), row(j));
      const float *r = sheet.at(column(i), row(j + 1)), *s = sheet.at(column(i + 1), row(j + 1));
      for (int c = 0; c < 4; ++c)
        moved.at(i, j)[c] = (1 - b) * ((1 - a) * p[c] + a * q[c]) + b * ((1 - a) * r[c] + a * s[c]);
    }
  return moved;
}

double smooth_noise(double x, double y, int period, std::uint64_t seed) {
  const double fx = std::floor(x), fy = std::floor(y);
  const int i = static_cast<int>(fx), j = static_cast<int>(fy);
  const auto ease = [](double t) { return t * t * (3 - 2 * t); };
  const double a = ease(x - fx), b = ease(y - fy);
  const double low = (1 - a) * lattice(i, j, period, seed) + a * lattice(i + 1, j, period, seed);
  const double high = (1 - a) * lattice(i, j + 1, period, seed) + a * lattice(i + 1, j + 1, period, seed);
  return (1 - b) * low + b * high;
}

double cloudy_noise(double x, double y, int period, int octaves, std::uint64_t seed) {
  double sum = 0, weight = 0, strength = 1;
  for (int k = 0; k < octaves; ++k) {
    sum += strength * smooth_noise(x, y, period, seed + static_cast<std::uint64_t>(k) * 1013);
    weight += strength;
    strength *= 0.55;
    x *= 2;
    y *= 2;
    period *= 2;
  }
  return sum / weight;
}

double log_uniform(Random& random, double low, double high) {
  return low * std::exp(random.uniform() * std::log(high / low));
}

bool chance(Random& random, double probability) { return random.uniform() < probability; }

}  // namespace tumble::render
