#include "render/theme.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::render {
namespace {

TEST(Palette, OfMagnitudesRisesInLightness) {
  const Palette& palette = dark_theme().magnitude;
  for (int i = 1; i < 256; ++i) {
    // Eight bits a channel leave steps of about 0.004 uneven.
    EXPECT_GT(lightness(palette.colours[i]), lightness(palette.colours[i - 1]) - 0.004) << i;
    EXPECT_GT(lightness(palette.colours[i]), lightness(palette.colours[i < 8 ? 0 : i - 8]) - 1e-9) << i;
  }
  EXPECT_GT(lightness(palette.colours[255]) - lightness(palette.colours[0]), 0.4);
}

TEST(Palette, OfSignedValuesIsPaleInTheMiddleAndEvenOnBothSides) {
  const Palette& palette = dark_theme().of_sign;
  for (int i = 8; i < 128; ++i) {
    EXPECT_GT(lightness(palette.colours[i]), lightness(palette.colours[i - 8])) << i;
    EXPECT_GT(lightness(palette.colours[255 - i]), lightness(palette.colours[255 - i + 8])) << i;
  }
  EXPECT_NEAR(lightness(palette.colours[0]), lightness(palette.colours[255]), 0.06);
}

TEST(Palette, EndsWhereTheScaleEnds) {
  const auto same = [](Rgba a, Rgba b) { return a.r == b.r && a.g == b.g && a.b == b.b; };
  const Palette& palette = dark_theme().magnitude;
  EXPECT_TRUE(same(palette.at(-3), palette.colours[0]));
  EXPECT_TRUE(same(palette.at(7), palette.colours[255]));
  EXPECT_TRUE(same(palette.at(std::nan("")), palette.colours[0]));
}

}  // namespace
}  // namespace tumble::render
