#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "analysis/charge_mask.h"
#include "analysis/charge_motion.h"
#include "analysis/still_edges.h"
#include "analysis/still_view.h"
#include "core/angle.h"
#include "core/quantile.h"
#include "core/random.h"
#include "core/statistics.h"
#include "tests/analysis/painted_mill.h"

namespace tumble::analysis {
namespace {

namespace fs = std::filesystem;

TEST(StillLifters, TipsAreWhereTheirPatternBegins) {
  const Circle mill{160, 160, 150};
  cv::Mat picture(320, 320, CV_8UC3);
  for (int v = 0; v < picture.rows; ++v)
    for (int u = 0; u < picture.cols; ++u) {
      const double r = std::hypot(u - mill.u, v - mill.v), a = std::atan2(mill.v - v, u - mill.u);
      const double contrast = r < 135 ? 0 : r < 140 ? 40 : r < 147 ? 20 : 90;  // bright at both ends, dull between
      const auto grey = static_cast<uchar>(50 + (std::cos(20 * a) > 0 ? contrast : 0));
      picture.at<cv::Vec3b>(v, u) = {grey, grey, grey};
    }
  const StillLifters seen = find_still_lifters({picture}, {cv::Mat::zeros(picture.size(), CV_32F)}, mill, 0);
  EXPECT_EQ(seen.count, 20);
  EXPECT_NEAR(seen.tip_radius, 135, 1.5);
}

TEST(ChargeColours, TellWhatIsTooBlurredToBeSureOf) {
  const cv::Rect bed(60, 110, 80, 40), blurred(90, 60, 20, 10);
  const cv::Vec3b brown(60, 110, 150), dark(40, 35, 30);
  cv::Mat picture(200, 200, CV_8UC3, cv::Scalar(dark)), share = cv::Mat::zeros(picture.size(), CV_32F);
  picture(bed).setTo(brown);
  picture(blurred).setTo(brown);
  share(bed).setTo(0.9f);
  share(blurred).setTo(0.2f);
  std::vector<cv::Mat> shares{share.clone()};
  add_charge_colours(shares, {picture}, {100, 100, 80});
  EXPECT_EQ(cv::countNonZero(shares[0] > 0.5f), bed.area() + blurred.area());

  picture.rowRange(0, 50).setTo(brown);  // a mill of the same colour: nothing can be told
  shares = {share.clone()};
  add_charge_colours(shares, {picture}, {100, 100, 80});
  EXPECT_EQ(cv::countNonZero(shares[0] > 0.5f), bed.area());
}

// A ring from 240 to 380 degrees in which every ball of 4 degrees is there or not.
RingProfile ragged_ring(double share, std::uint64_t seed) {
  Random random(seed);
  RingProfile profile{};
  bool ball = false;
  for (int i = 240; i < 380; ++i) {
    if (i % 4 == 2 || i == 240) ball = random.uniform() < share;
    profile[static_cast<std::size_t>(i % 360)] = ball ? 1 : 0;
  }
  return profile;
}

TEST(StillEdges, ErrorsAreWhatOtherPicturesOfTheSameChargeScatterBy) {
  int within = 0, all = 0;
  std::vector<double> errors;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const Estimate toe = edges_of_still(ragged_ring(0.8, seed), 15, 4).toe[kHalf];
    if (std::isnan(toe.se)) continue;
    ++all;
    within += std::abs(wrap_180(toe.value - 240)) < toe.se;
    errors.push_back(toe.se);
  }
  ASSERT_GT(all, 80);
  EXPECT_GT(within, 0.45 * all);  // 0.68 by right; a tenth of these beds fall apart and have no toe
  EXPECT_LT(within, 0.85 * all);
  EXPECT_NEAR(median_of(errors), 2, 1);                                    // half a ball
  EXPECT_LT(edges_of_still(ragged_ring(1, 1), 15, 4).toe[kHalf].se, 0.1);  // an even bed
}

ChargeMotion motion_of(const cv::Mat& picture, const Config& known) {
  const fs::path folder = fs::path(::testing::TempDir()) / ("still_" + std::to_string(getpid()));
  fs::create_directories(folder);
  cv::imwrite((folder / "still.png").string(), picture);
  FilmOptions options;
  options.mill = &known;
  const ChargeMotion motion = measure_stills(folder.string(), options);
  fs::remove_all(folder);
  return motion;
}

cv::Mat painted_bed() {
  const PaintedMill mill = large_painted_mill();
  return paint(mill, packed_bed(mill, 7, 35, 3), 40);
}

TEST(Stills, TellNothingOfWhatLiesOutsideThePicture) {
  const cv::Mat picture = painted_bed();
  const ChargeMotion motion = motion_of(picture.colRange(230, picture.cols).clone(), {});  // the toe is cut off
  EXPECT_TRUE(std::isnan(motion.toe_deg.value)) << motion.toe_deg.value;
  EXPECT_TRUE(std::isnan(motion.filling.value));
  EXPECT_NEAR(wrap_180(motion.shoulder_deg.value - motion_of(picture, {}).shoulder_deg.value), 0, 3);
}

TEST(Stills, ChargeLiesOnTheSideThatRises) {
  const cv::Mat picture = painted_bed();
  cv::Mat mirrored;
  cv::flip(picture, mirrored, 1);
  const ChargeMotion there = motion_of(picture, {}), here = motion_of(mirrored, {});
  EXPECT_EQ(there.rotation, Rotation::kCounterClockwise);
  EXPECT_EQ(here.rotation, Rotation::kClockwise);
  EXPECT_NEAR(wrap_180(here.toe_deg.value - there.toe_deg.value), 0, 3 * there.toe_deg.se);
  EXPECT_NEAR(wrap_180(here.shoulder_deg.value - there.shoulder_deg.value), 0, 3 * there.shoulder_deg.se);
}

// Photographs of real mills, where the reference data lies beside the project.
struct Photograph {
  const char* file;
  double toe, shoulder, within;  // read by others [degrees]
};

std::ostream& operator<<(std::ostream& out, const Photograph& p) { return out << fs::path(p.file).stem().string(); }

class Photographs : public ::testing::TestWithParam<Photograph> {};

TEST_P(Photographs, GiveToeAndShoulder) {
  const Photograph& p = GetParam();
  const fs::path file = fs::path(TUMBLE_SOURCE_DIR) / "../shared/data/films" / p.file;
  const cv::Mat picture = cv::imread(file.string());
  if (picture.empty()) GTEST_SKIP() << file << " is not there";
  const ChargeMotion motion = motion_of(picture, {});
  EXPECT_NEAR(wrap_180(motion.toe_deg.value - p.toe), 0, p.within);
  EXPECT_NEAR(wrap_180(motion.shoulder_deg.value - p.shoulder), 0, p.within);
  std::printf("             toe %.1f +- %.1f for %.1f  shoulder %.1f +- %.1f for %.1f\n", motion.toe_deg.value,
              motion.toe_deg.se, p.toe, motion.shoulder_deg.value, motion.shoulder_deg.se, p.shoulder);
}

INSTANTIATE_TEST_SUITE_P(GranuDrum, Photographs,
                         ::testing::Values(Photograph{"granudrum/granudrum_mcc_10rpm_averaged.png", 211.8, 37.5, 1},
                                           Photograph{"granudrum/granudrum_mcc_15rpm_averaged.png", 211.5, 39.2, 1},
                                           Photograph{"granudrum/granudrum_mcc_45rpm_averaged.png", 213.2, 47.2, 1}));
INSTANTIATE_TEST_SUITE_P(MiniMill, Photographs,
                         ::testing::Values(Photograph{"minimill/IMG_1276_frame_0.jpg", 238, 23, 8},
                                           Photograph{"minimill/IMG_1276_frame_100.jpg", 232, 19, 8},
                                           Photograph{"minimill/IMG_1276_frame_7369.jpg", 232, 25, 8}));

}  // namespace
}  // namespace tumble::analysis
