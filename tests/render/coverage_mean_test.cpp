#include "render/coverage_mean.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"

namespace tumble::render {
namespace {

constexpr Rgba kFirst{255, 0, 0}, kSecond{0, 0, 255}, kBoth{100, 100, 100};
const std::uint8_t* pixel(const Image& image, int u, int v) { return image.row(v) + 4 * u; }

TEST(CoverageMean, WhatIsTheSameLeavesNothing) {
  CoverageMean mean(64, 3);
  for (int k = 0; k < 5; ++k) mean.add({{20.0 + k, 30, 8}}, {{20.0 + k, 30, 8}});
  EXPECT_EQ(mean.only_first(), 0);
  EXPECT_EQ(mean.only_second(), 0);
  EXPECT_EQ(pixel(mean.picture(kFirst, kSecond, kBoth), 23, 30)[0], kBoth.r);
}

// Two discs half a radius apart: each has alone what the lens of both leaves of it.
TEST(CoverageMean, SharesAreThoseOfTwoDiscsThatOverlap) {
  CoverageMean mean(200, 1);
  const double r = 40, d = 20;
  mean.add({{90, 100, r}}, {{90 + d, 100, r}});
  const double lens = 2 * r * r * std::acos(d / (2 * r)) - 0.5 * d * std::sqrt(4 * r * r - d * d);
  const double disc = kPi * r * r, only = (disc - lens) / (2 * disc - lens);
  EXPECT_NEAR(mean.only_first(), only, 0.002);
  EXPECT_NEAR(mean.only_second(), only, 0.002);
  const Image picture = mean.picture(kFirst, kSecond, kBoth);
  EXPECT_EQ(pixel(picture, 55, 100)[0], 255);   // the first's alone
  EXPECT_EQ(pixel(picture, 145, 100)[2], 255);  // the second's
  EXPECT_EQ(pixel(picture, 100, 100)[0], kBoth.r);
  EXPECT_EQ(pixel(picture, 10, 10)[3], 0);
}

TEST(CoverageMean, ForgetsWhatIsOlderThanItsPictures) {
  CoverageMean mean(64, 2);
  mean.add({{20, 20, 8}}, {});
  EXPECT_EQ(mean.only_first(), 1);
  mean.add({{40, 40, 8}}, {{40, 40, 8}});
  EXPECT_NEAR(mean.only_first(), 0.5, 0.01);
  EXPECT_NEAR(pixel(mean.picture(kFirst, kSecond, kBoth), 20, 20)[3], 128, 1);
  mean.add({{40, 40, 8}}, {{40, 40, 8}});
  EXPECT_EQ(mean.only_first(), 0);
}

TEST(CoverageMean, DiscsBeyondThePictureAreNoHarm) {
  CoverageMean mean(32, 1);
  mean.add({{-100, 5, 8}, {31, 31, 500}}, {{500, 500, 3}});
  EXPECT_EQ(mean.only_first(), 1);
}

}  // namespace
}  // namespace tumble::render
