#include "analysis/drum_motion.h"

#include <gtest/gtest.h>

#include "core/config.h"
#include "tests/analysis/painted_mill.h"

namespace tumble::analysis {
namespace {

std::vector<DrumStrip> turning(double step, int frames) {
  PaintedMill m;
  const DrumUnroller unroll({m.u, m.v, m.radius}, 0.8 * m.radius, 1.12 * m.radius, {m.width, m.height});
  std::vector<DrumStrip> strips;
  for (int f = 0; f < frames; ++f) {
    m.angle = 0.1 + step * f;
    strips.push_back(unroll(paint(m, {}, 50 + static_cast<std::uint64_t>(f))));
  }
  return strips;
}

TEST(DrumMotion, FindsStepDirectionAndLifterCount) {
  for (double step : {0.06, -0.045}) {
    const DrumPattern p = learn_drum(turning(step, 16), 0, kNotGiven);
    ASSERT_TRUE(p.found);
    EXPECT_NEAR(p.step, step, 0.003 * std::abs(step));
    EXPECT_EQ(p.lifter_count, 12);
  }
}

TEST(DrumMotion, AngleOfASinglePictureIsGoodToATenthOfADegree) {
  const auto strips = turning(0.06, 16);
  const DrumPattern p = learn_drum(strips, 0, kNotGiven);
  for (std::size_t f = 0; f < strips.size(); ++f) {
    const double angle = drum_angle(p, strips[f], 0.06 * static_cast<double>(f) + 0.05);
    EXPECT_NEAR(angle, 0.06 * static_cast<double>(f), 0.0018);
  }
}

TEST(DrumMotion, IsNotFoundInAStillMill) { EXPECT_FALSE(learn_drum(turning(0.0, 16), 0, kNotGiven).found); }

}  // namespace
}  // namespace tumble::analysis
