#include "diagnose/design.h"

#include <limits>
#include <numeric>
#include <utility>

namespace tumble::diagnose {
namespace {

constexpr int kDrawings = 30;

std::vector<std::vector<double>> draw(std::size_t n, std::size_t d, Random& random) {
  std::vector<std::vector<double>> points(n, std::vector<double>(d));
  std::vector<std::size_t> slice(n);
  for (std::size_t k = 0; k < d; ++k) {
    std::iota(slice.begin(), slice.end(), std::size_t{0});
    for (std::size_t i = n; i > 1; --i) std::swap(slice[i - 1], slice[random.below(i)]);
    for (std::size_t i = 0; i < n; ++i) points[i][k] = (double(slice[i]) + random.uniform()) / double(n);
  }
  return points;
}

double nearest(const std::vector<std::vector<double>>& points) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      double sum = 0;
      for (std::size_t k = 0; k < points[i].size(); ++k)
        sum += (points[i][k] - points[j][k]) * (points[i][k] - points[j][k]);
      least = std::min(least, sum);
    }
  return least;
}

}  // namespace

std::vector<std::vector<double>> latin_hypercube(std::size_t n, std::size_t d, Random& random) {
  auto best = draw(n, d, random);
  double apart = nearest(best);
  for (int i = 1; i < kDrawings; ++i) {
    auto other = draw(n, d, random);
    if (const double a = nearest(other); a > apart) best = std::move(other), apart = a;
  }
  return best;
}

}  // namespace tumble::diagnose
