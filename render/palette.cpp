#include "render/palette.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace tumble::render {
namespace {

std::uint8_t byte(double value) { return static_cast<std::uint8_t>(std::clamp(value, 0.0, 255.0) + 0.5); }

struct Oklab {
  double l = 0, a = 0, b = 0;
};

double linear(std::uint8_t channel) {
  const double c = channel / 255.0;
  return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}

double srgb(double c) { return 255.0 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055); }

Oklab oklab(Rgba colour) {
  const double r = linear(colour.r), g = linear(colour.g), b = linear(colour.b);
  const double l = std::cbrt(0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b);
  const double m = std::cbrt(0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b);
  const double s = std::cbrt(0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b);
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
          1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
          0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s};
}

Rgba rgba(const Oklab& c) {
  const double l = std::pow(c.l + 0.3963377774 * c.a + 0.2158037573 * c.b, 3);
  const double m = std::pow(c.l - 0.1055613458 * c.a - 0.0638541728 * c.b, 3);
  const double s = std::pow(c.l - 0.0894841775 * c.a - 1.2914855480 * c.b, 3);
  return {byte(srgb(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s)),
          byte(srgb(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s)),
          byte(srgb(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s))};
}

}  // namespace

Rgba with_alpha(Rgba colour, double alpha) {
  colour.a = byte(colour.a * alpha);
  return colour;
}

Rgba mix(Rgba a, Rgba b, double share) {
  const auto channel = [share](std::uint8_t p, std::uint8_t q) { return byte(p + share * (q - p)); };
  return {channel(a.r, b.r), channel(a.g, b.g), channel(a.b, b.b), channel(a.a, b.a)};
}

Rgba scaled(Rgba colour, double brightness) {
  return {byte(colour.r * brightness), byte(colour.g * brightness), byte(colour.b * brightness), colour.a};
}

Rgba Palette::at(double share) const {
  if (!(share > 0)) return colours[0];
  return colours[static_cast<std::size_t>(std::lround(std::min(share, 1.0) * 255.0))];
}

Palette blend(std::initializer_list<Rgba> stops) {
  std::vector<Oklab> lab;
  for (const Rgba& stop : stops) lab.push_back(oklab(stop));
  Palette palette;
  for (int i = 0; i < 256; ++i) {
    const double place = i / 255.0 * static_cast<double>(lab.size() - 1);
    const std::size_t k = std::min(static_cast<std::size_t>(place), lab.size() - 2);
    const double t = place - static_cast<double>(k);
    const Oklab &p = lab[k], &q = lab[k + 1];
    palette.colours[i] = rgba({p.l + t * (q.l - p.l), p.a + t * (q.a - p.a), p.b + t * (q.b - p.b)});
  }
  return palette;
}

double lightness(Rgba colour) { return oklab(colour).l; }

double luminance(Rgba colour) {
  return 0.2126 * linear(colour.r) + 0.7152 * linear(colour.g) + 0.0722 * linear(colour.b);
}

}  // namespace tumble::render
