#include "diagnose/tracking_noise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/quantile.h"
#include "core/random.h"

namespace tumble::diagnose {
namespace {

constexpr std::size_t kFewest = 200;                // differences
constexpr double kOfThirdDifference = 4.472135955;  // sqrt(1 + 9 + 9 + 1)
constexpr double kMedianOfNormal = 0.6744897502;    // of its magnitude, in standard deviations
constexpr std::size_t kMost = 200'000;              // differences that are looked at

}  // namespace

double noise_of_places(const std::vector<SeenFrame>& frames) {
  struct Row {
    std::size_t frame = 0, length = 0;
    std::array<double, 4> x{}, y{};
  };
  std::map<int, Row> rows;
  std::vector<double> differences;
  for (std::size_t f = 0; f < frames.size() && differences.size() < kMost; ++f)
    for (const Sighting& s : frames[f].balls) {
      Row& r = rows[s.ball];
      r.length = r.length > 0 && r.frame + 1 == f ? r.length + 1 : 1;
      r.frame = f;
      std::rotate(r.x.begin(), r.x.begin() + 1, r.x.end());
      std::rotate(r.y.begin(), r.y.begin() + 1, r.y.end());
      r.x.back() = s.x;
      r.y.back() = s.y;
      if (r.length < r.x.size()) continue;
      for (const auto& p : {r.x, r.y}) differences.push_back(std::abs(p[3] - 3 * p[2] + 3 * p[1] - p[0]));
    }
  if (differences.size() < kFewest) return kNotGiven;
  return quantile_of(std::move(differences), 0.5) / (kMedianOfNormal * kOfThirdDifference);
}

std::vector<SeenFrame> noisier(std::vector<SeenFrame> frames, double noise) {
  Random random(1);
  for (SeenFrame& f : frames)
    for (Sighting& s : f.balls) {
      s.x += noise * gaussian(random);
      s.y += noise * gaussian(random);
    }
  return frames;
}

}  // namespace tumble::diagnose
