#include "render/coverage_mean.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tumble::render {
namespace {

std::vector<std::uint8_t> mask_of(const std::vector<CoveredDisc>& discs, int edge) {
  std::vector<std::uint8_t> mask(static_cast<std::size_t>(edge) * edge);
  const auto pixel = [edge](double at) { return std::clamp(static_cast<int>(at), 0, edge); };
  for (const CoveredDisc& d : discs) {
    if (!(d.radius > 0)) continue;
    const int left = pixel(std::floor(d.u - d.radius)), right = pixel(std::ceil(d.u + d.radius) + 1);
    const int top = pixel(std::floor(d.v - d.radius)), bottom = pixel(std::ceil(d.v + d.radius) + 1);
    for (int j = top; j < bottom; ++j)
      for (int i = left; i < right; ++i) {
        const double cover = std::clamp(d.radius + 0.5 - std::hypot(i - d.u, j - d.v), 0.0, 1.0);
        auto& of_pixel = mask[static_cast<std::size_t>(j) * edge + i];
        of_pixel = std::max(of_pixel, static_cast<std::uint8_t>(std::lround(255 * cover)));
      }
  }
  return mask;
}

}  // namespace

CoverageMean::CoverageMean(int edge_px, std::size_t pictures)
    : edge_(edge_px), most_(std::max<std::size_t>(pictures, 1)) {
  for (auto& sum : sum_) sum.assign(static_cast<std::size_t>(edge_px) * edge_px, 0);
}

void CoverageMean::add(const std::vector<CoveredDisc>& first, const std::vector<CoveredDisc>& second) {
  Masks masks{{mask_of(first, edge_), mask_of(second, edge_)}};
  const bool full = kept_.size() == most_;
  for (int s = 0; s < 2; ++s)
    for (std::size_t i = 0; i < sum_[s].size(); ++i)
      sum_[s][i] += masks.of[s][i] - (full ? kept_.front().of[s][i] : std::uint32_t{0});
  if (full) kept_.pop_front();
  kept_.push_back(std::move(masks));
}

Image CoverageMean::picture(Rgba first, Rgba second, Rgba both) const {
  Image image(edge_, edge_);
  const double whole = 255.0 * static_cast<double>(std::max<std::size_t>(kept_.size(), 1));
  for (std::size_t i = 0; i < sum_[0].size(); ++i) {
    const double a = sum_[0][i] / whole, b = sum_[1][i] / whole;
    const double common = std::min(a, b), more = std::abs(a - b), seen = common + more;
    if (!(seen > 0)) continue;
    Rgba colour = mix(both, a > b ? first : second, more / seen);
    colour = with_alpha(colour, seen);
    const std::uint8_t bytes[] = {colour.r, colour.g, colour.b, colour.a};
    std::copy(std::begin(bytes), std::end(bytes), image.rgba.begin() + static_cast<std::ptrdiff_t>(4 * i));
  }
  return image;
}

double CoverageMean::share_of(int source) const {
  double only = 0, either = 0;
  for (std::size_t i = 0; i < sum_[0].size(); ++i) {
    const double mine = sum_[source][i], other = sum_[1 - source][i];
    only += std::max(0.0, mine - other);
    either += std::max(mine, other);
  }
  return either > 0 ? only / either : 0;
}

}  // namespace tumble::render
