#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "diagnose/check_parts.h"
#include "diagnose/seen_charge.h"

// How many balls there are, and of what size.
namespace tumble::diagnose {
namespace {

constexpr double kWhole = 0.25;       // balls: their number is whole
constexpr double kOutline = 0.005;    // relative: how sharply a ball's outline is defined
constexpr double kAsGiven = 1e-4;     // relative: radii nearer to those of MILL.toml were copied from there
constexpr double kMistaken = 0.03;    // of the square root of the number of balls, as many count as another class's
constexpr double kMissedAlike = 0.3;  // of those missed: how far that is from by chance

// Balls that are there, of those that are seen in each frame: each is missed as often, so the fewer are missed the less
// their number varies.
Estimate balls_there(const std::vector<double>& seen) {
  const Estimate mean = mean_of_series(seen);
  double variance = 0;
  for (const double n : seen) variance += (n - mean.value) * (n - mean.value) / double(seen.size());
  const double missed = std::clamp(variance / mean.value, 0.0, 0.5), there = mean.value / (1 - missed);
  const double se = std::isnan(mean.se) ? 0 : mean.se;
  return {there, std::hypot(se, kWhole, kMissedAlike * (there - mean.value))};
}

struct SeenSizes {
  std::map<int, double> radius;  // of each ball that is seen; NaN where it is not told
  bool copied = true;            // from MILL.toml
};

SeenSizes sizes_of(const Measurement& m) {
  SeenSizes sizes;
  for (const SeenFrame& f : m.frames)
    for (const Sighting& s : f.balls) sizes.radius.emplace(s.ball, s.radius);
  for (const auto& [ball, radius] : sizes.radius) {
    const int k = class_of(m.config, radius);
    if (k >= 0)
      sizes.copied &= std::abs(radius / m.config.charge.balls[static_cast<std::size_t>(k)].radius - 1) < kAsGiven;
  }
  return sizes;
}

// The mean mass of a ball, by the sizes of those that are seen.
ExactCheck check_mix(const Measurement& m, const std::vector<int>& counts) {
  const std::vector<BallClass>& classes = m.config.charge.balls;
  double balls = 0, spread = 0;
  for (const int n : counts) balls += n;
  const double mass = slice_mass(m.config, counts) / balls;
  for (std::size_t k = 0; k < counts.size(); ++k) spread += counts[k] * std::pow(classes[k].mass - mass, 2) / balls;
  std::vector<double> means;
  for (const SeenFrame& f : m.frames) {
    double sum = 0, known = 0;
    for (const Sighting& s : f.balls)
      if (const int k = class_of(m.config, s.radius); k >= 0) sum += classes[static_cast<std::size_t>(k)].mass, ++known;
    if (known > 0) means.push_back(sum / known);
  }
  const Estimate seen = mean_of_series(means);
  // A few balls that are taken for another class's.
  const double taken_wrong = std::max(2 * kWhole, kMistaken * std::sqrt(balls)) * std::sqrt(spread) / balls;
  return make_check(m, "ball_mix", seen.value, mass, std::hypot(std::isnan(seen.se) ? 0 : seen.se, taken_wrong), "kg",
                    {{"filling_error", 1 / mass}},
                    {"by their sizes the balls weigh, on average,", "the sizes are mixed as MILL.toml has it",
                     "the sizes are not mixed as MILL.toml has it"});
}

}  // namespace

void check_balls(const Measurement& m, std::vector<ExactCheck>& checks) {
  std::vector<double> seen;
  for (const SeenFrame& f : m.frames) seen.push_back(double(f.balls.size()));
  const std::vector<int> counts = class_counts(m.config);
  double expected = 0;
  for (const int n : counts) expected += n;
  // A film of a mill of several layers shows the foremost alone.
  const bool all_in_view = !m.is_film || slice_rule(m.config) != SliceRule::kWeight;
  if (all_in_view) {
    const Estimate there = balls_there(seen);
    checks.push_back(make_check(m, "ball_count", there.value, expected, there.se, "balls",
                                {{"filling_error", 1 / expected}},
                                {"in the frames there are", "as MILL.toml has it",
                                 "another charge than MILL.toml has, or balls that are not seen"}));
  }
  const SeenSizes sizes = sizes_of(m);
  std::vector<double> ratios;
  for (const auto& [ball, radius] : sizes.radius) {
    const int k = class_of(m.config, radius);
    if (k < 0) continue;
    ratios.push_back(radius / m.config.charge.balls[static_cast<std::size_t>(k)].radius);
  }
  if (ratios.empty()) return;
  if (counts.size() > 1 && all_in_view) checks.push_back(check_mix(m, counts));
  if (sizes.copied || m.is_film) return;  // a film's balls are given the sizes that MILL.toml has
  const Estimate ratio = mean_of_series(ratios);
  if (std::isnan(ratio.se)) return;
  checks.push_back(make_check(m, "ball_sizes", ratio.value, 1, std::hypot(ratio.se, kOutline), "",
                              {{"camera_scale", 1}},
                              {"balls are, over the radii in MILL.toml, as large as", "lengths are to scale",
                               "lengths are out of scale, or charge.balls has other balls"}));
}

}  // namespace tumble::diagnose
