#include "render/discs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"
#include "render/offscreen_context.h"

namespace tumble::render {
namespace {

constexpr int kSize = 96;

Image draw_on(float ground, const Disc& disc) {
  OffscreenContext context(kSize, kSize);
  {
    const CurrentContext current(context);
    Discs discs(kSize, kSize);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glClearColor(ground, ground, ground, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    discs.add(disc);
    discs.flush();
  }
  return context.image();
}

struct Cover {
  double area = 0, u = 0, v = 0;  // [px2], centroid [px]
};

// A pixel's coverage, whatever its shading: one less how much of the ground shines through, seen on black and white.
Cover cover_of(const Disc& disc) {
  const Image black = draw_on(0, disc), white = draw_on(1, disc);
  Cover cover;
  for (int v = 0; v < kSize; ++v) {
    for (int u = 0; u < kSize; ++u) {
      const double share = 1 - (white.row(v)[4 * u] - black.row(v)[4 * u]) / 255.0;
      cover.area += share;
      cover.u += share * u;
      cover.v += share * v;
    }
  }
  cover.u /= cover.area;
  cover.v /= cover.area;
  return cover;
}

// An edge that fades linearly over one pixel misses the disc's area by about 1/24 px of radius at its diagonals.
TEST(Discs, CoverTheAreaAndCentreOfTheirCircle) {
  for (const double radius : {3.0, 7.3, 20.0, 33.3}) {
    for (const double shift : {0.0, 0.25, 0.5, 0.81}) {
      Disc disc;
      disc.centre = {47 + shift, 48 - 0.7 * shift};
      disc.radius = radius;
      disc.colour = {90, 160, 200};
      disc.mark_strength = 1;
      const Cover cover = cover_of(disc);
      EXPECT_NEAR(std::sqrt(cover.area / kPi), radius, 0.05) << "radius " << radius << " shift " << shift;
      EXPECT_NEAR(cover.u, disc.centre.x(), 0.02) << "radius " << radius << " shift " << shift;
      EXPECT_NEAR(cover.v, disc.centre.y(), 0.02) << "radius " << radius << " shift " << shift;
    }
  }
}

TEST(Discs, AreHalfCoveredAtTheirRadius) {
  Disc disc;
  disc.centre = {48, 48};
  disc.radius = 30;
  disc.colour = {255, 255, 255};
  const Image black = draw_on(0, disc), white = draw_on(1, disc);
  EXPECT_NEAR(white.row(48)[4 * 78] - black.row(48)[4 * 78], 127.5, 2);  // 30 px right of the centre
  EXPECT_EQ(white.row(48)[4 * 79] - black.row(48)[4 * 79], 255);
  EXPECT_EQ(white.row(48)[4 * 77] - black.row(48)[4 * 77], 0);
}

TEST(Discs, TurnTheirMark) {
  Disc disc;
  disc.centre = {48, 48};
  disc.radius = 30;
  disc.colour = {40, 60, 120};
  disc.mark_strength = 1;
  disc.mark = {1, 0};
  const Image right = draw_on(0, disc);
  disc.mark = {0, -1};
  const Image up = draw_on(0, disc);
  // On the stripe it is paler than the ball; the stripe lies where the mark points.
  EXPECT_GT(right.row(48)[4 * 28], up.row(48)[4 * 28] + 40);
  EXPECT_GT(up.row(68)[4 * 48], right.row(68)[4 * 48] + 40);
}

}  // namespace
}  // namespace tumble::render
