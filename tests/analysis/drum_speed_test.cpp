#include "analysis/drum_speed.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "core/random.h"
#include "core/units.h"

namespace tumble::analysis {
namespace {

double normal(Random& random) {
  return std::sqrt(-2 * std::log(1 - random.uniform())) * std::cos(2 * kPi * random.uniform());
}

// Share of 200 lines of 150 values, with residuals that forget within about 1 / (1 - alike) values, whose slope lies
// within two of its standard errors of the truth.
double covered_share(double alike) {
  Random random(7);
  int within = 0;
  constexpr int kSeries = 200;
  for (int i = 0; i < kSeries; ++i) {
    std::vector<double> time, y;
    double rest = normal(random);
    for (int t = 0; t < 150; ++t) {
      rest = alike * rest + std::sqrt(1 - alike * alike) * normal(random);
      time.push_back(t);
      y.push_back(0.3 * t + rest);
    }
    const Estimate slope = slope_of_series(time, y);
    within += std::abs(slope.value - 0.3) < 2 * slope.se;
  }
  return static_cast<double>(within) / kSeries;
}

TEST(SlopeOfSeries, ItsErrorHoldsWhereResidualsAreCorrelated) {
  EXPECT_GT(covered_share(0), 0.92);
  EXPECT_GT(covered_share(0.5), 0.90);
  EXPECT_GT(covered_share(0.8), 0.88);
}

// The drum turned evenly, each part read with the shift of the direction in which it is.
struct Reading {
  Estimate turn;
  double step;
};
template <class Shift, class Seen>
Reading read_drum(double turns, Shift shift, Seen seen, double alike) {
  constexpr int kFrames = 120;
  Reading reading;
  reading.step = 2 * kPi * turns / kFrames;
  std::vector<double> time;
  std::vector<DrumAngle> angles;
  std::array<double, DrumAngle::kParts> own{}, times_seen{};  // a part's place on the drum is learned with its shifts
  for (int pass = 0; pass < 2; ++pass)
    for (int f = 0; f < kFrames; ++f) {
      DrumAngle a;
      double sum = 0, say = 0;
      for (std::size_t p = 0; p < DrumAngle::kParts; ++p) {
        const double direction =
            std::remainder((static_cast<double>(p) + 0.5) * 2 * kPi / DrumAngle::kParts + f * reading.step, 2 * kPi);
        if (!seen(direction)) continue;
        if (pass == 0) {
          own[p] += shift(direction);
          times_seen[p] += 1;
          continue;
        }
        a.part_turn[p] = static_cast<float>(shift(direction) - own[p] / times_seen[p]);
        a.part_say[p] = 1;
        sum += a.part_turn[p];
        say += 1;
      }
      if (pass == 0) continue;
      for (float& t : a.part_turn) t -= static_cast<float>(sum / say);
      a.angle = f * reading.step + sum / say;
      a.error = 1e-4;
      time.push_back(f);
      angles.push_back(a);
    }
  reading.turn = turn_of_drum(time, angles, alike);
  return reading;
}

// An axis that is 2 px of 200 off shifts opposite directions to and fro; half of the round is hidden.
TEST(TurnOfDrum, KnowsWhatACameraThatIsOffDoesToIt) {
  for (double from : {-3.0, -2.0, -1.0, 0.0, 1.0, 2.0}) {
    const Reading r = read_drum(
        0.5, [&](double a) { return 0.01 * std::sin(a - from); }, [](double a) { return a > 0; }, 0.001);
    EXPECT_LT(std::abs(r.turn.value - r.step), 2.5 * r.turn.se) << from;
  }
}

// All that passes shifts alike with the direction: the parts agree, and nothing is left over in time.
TEST(TurnOfDrum, KnowsThatHalfARoundMayLag) {
  const auto lag = [](double a) { return 0.001 * a; };
  const Reading half = read_drum(
      0.5, lag, [](double a) { return a > 0; }, 0.001);
  EXPECT_LT(half.turn.value - half.step, 2.5 * half.turn.se);
  const Reading whole = read_drum(
      0.5, [](double) { return 0.0; }, [](double) { return true; }, 0.001);
  EXPECT_LT(whole.turn.se, 0.1 * half.turn.se);
}

}  // namespace
}  // namespace tumble::analysis
