#include "render/theme.h"

#include <gtest/gtest.h>

namespace tumble::render {
namespace {

TEST(Theme, ContrastIsThatOfTheWebGuidelines) {
  EXPECT_NEAR(contrast({0, 0, 0}, {255, 255, 255}), 21, 1e-9);
  EXPECT_NEAR(contrast({119, 119, 119}, {255, 255, 255}), 4.48, 0.005);  // the guidelines' own example of just too pale
  EXPECT_DOUBLE_EQ(contrast({10, 90, 200}, {200, 90, 10}), contrast({200, 90, 10}, {10, 90, 200}));
}

TEST(Theme, TextCanBeReadOnWhatItIsWrittenOn) {
  for (const Theme* theme : {&dark_theme(), &light_theme()}) {
    for (const Rgba ink : {theme->text, theme->quiet, theme->accent, theme->second})
      EXPECT_GE(contrast(ink, theme->ground), 4.5);
    for (const Rgba ink : {theme->text, theme->second, theme->trace})
      EXPECT_GE(contrast(ink, theme->mill_inside), 4.5);  // on balls the halo carries the letters
    EXPECT_GE(contrast(theme->text, theme->halo), 4.5);
    EXPECT_GE(contrast(theme->second, theme->halo), 4.5);
    EXPECT_GE(contrast(theme->trace, theme->halo), 4.5);
  }
}

// Lines that stand for something keep 3:1 (WCAG 2.1, 1.4.11) on the empty mill and on their outline.
TEST(Theme, LinesStandOut) {
  for (const Theme* theme : {&dark_theme(), &light_theme()}) {
    for (const Rgba ink : {theme->force, theme->flow, theme->trace, theme->accent}) {
      EXPECT_GE(contrast(ink, theme->mill_inside), 3);
      EXPECT_GE(contrast(ink, theme->halo), 3);
    }
  }
}

TEST(Theme, MagnitudesEndFarFromTheirStart) {
  for (const Theme* theme : {&dark_theme(), &light_theme()}) {
    const Palette& palette = theme->magnitude;
    for (int i = 8; i < 256; ++i) EXPECT_GT(lightness(palette.colours[i]), lightness(palette.colours[i - 8])) << i;
    EXPECT_GT(lightness(palette.colours[255]) - lightness(palette.colours[0]), 0.4);
  }
}

}  // namespace
}  // namespace tumble::render
