#include "analysis/film_pictures.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <vector>

#include "analysis/mill_camera.h"
#include "core/error.h"

namespace tumble::analysis {
namespace {

// Ten pictures of 500 x 400: a white disc 60 px right of the mill's centre (300, 200), ground 20 brighter each time.
class FilmPictures : public testing::Test {
 protected:
  FilmPictures() {
    cv::VideoWriter film(path_, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 25, {500, 400});
    for (int k = 0; k < 10; ++k) {
      cv::Mat picture(400, 500, CV_8UC3, cv::Scalar::all(20 * k));
      cv::circle(picture, {360, 200}, 12, cv::Scalar::all(255), cv::FILLED);
      film.write(picture);
    }
    view_.camera.centre_u_px = 300;
    view_.camera.centre_v_px = 200;
    view_.camera.radius_px = 150;
    view_.margin = 1;
    view_.edge_px = 100;  // a third of the square
  }
  ~FilmPictures() override { std::filesystem::remove(path_); }

  std::vector<Image> show(const std::vector<int>& frames) {
    std::vector<Image> images;
    show_film(path_, view_, frames, [&](const Image& image) { images.push_back(image); });
    return images;
  }
  static int at(const Image& image, int u, int v) { return image.row(v)[4 * u]; }

  std::string path_ = testing::TempDir() + "film_pictures_" + std::to_string(::getpid()) + ".avi";
  PictureView view_;
};

TEST_F(FilmPictures, GivesTheFramesThatAreAskedForAsFarAsTheFilmGoes) {
  const auto images = show({0, 0, 3, 9, 50});
  ASSERT_EQ(images.size(), 4u);
  const int ground[] = {0, 0, 60, 180};
  for (std::size_t i = 0; i < images.size(); ++i) EXPECT_NEAR(at(images[i], 30, 30), ground[i], 4) << i;
}

TEST_F(FilmPictures, IsCutToTheMillAndMirroredWhereItTurnsClockwise) {
  const Image cut = show({0})[0];
  ASSERT_EQ(cut.width, 100);
  EXPECT_GT(at(cut, 70, 50), 200);  // 60 px right of the middle are 20 here
  EXPECT_LT(at(cut, 30, 50), 50);
  view_.mirror = view_.clockwise = true;
  const Image mirrored = show({0})[0];
  EXPECT_GT(at(mirrored, 29, 50), 200);
  EXPECT_LT(at(mirrored, 69, 50), 50);
}

TEST_F(FilmPictures, ShowsTheWholePictureWhereNoMillIsKnown) {
  view_.camera = {};
  const Image whole = show({9})[0];
  EXPECT_GT(at(whole, 72, 50), 240);  // 360 of 500
  EXPECT_NEAR(at(whole, 50, 2), 0, 4) << "black above a wide picture";
}

// A camera from the side, rolled and with a lens that bends: a dot on the glass and one behind it.
class SeenAskew : public testing::TestWithParam<bool> {
 protected:
  static constexpr double kDepth = 0.05, kX = 0.55, kY = -0.4;  // mill radii

  SeenAskew() {
    MillCamera camera;
    camera.focal = 1200;
    camera.centre_u = 310;
    camera.centre_v = 190;
    camera.k1 = -0.15;
    camera.rotation =
        (Eigen::AngleAxisd(0.15, Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(-0.1, Eigen::Vector3d::UnitX()) *
         MillCamera::frontal() * Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitZ()));
    camera.translation = {-0.05, 0.02, 8};
    view_.camera.lens = camera;
    const cv::Point2d middle = picture_of(camera, {0, 0, 0});
    view_.camera.centre_u_px = middle.x;
    view_.camera.centre_v_px = middle.y;
    view_.camera.radius_px = 150;
    view_.clockwise = GetParam();
    view_.depth = kDepth;
    view_.edge_px = 330;  // 150 px a mill radius
    cv::Mat picture(400, 600, CV_8UC3, cv::Scalar::all(30));
    const cv::Point2d dot = picture_of(camera, {GetParam() ? -kX : kX, kY, -kDepth});
    cv::circle(picture, cv::Point(cv::Point2d(16 * dot.x, 16 * dot.y)), 16 * 4, cv::Scalar::all(255), cv::FILLED,
               cv::LINE_AA, 4);
    cv::imwrite(path_, picture);
  }
  ~SeenAskew() override { std::filesystem::remove(path_); }

  Eigen::Vector2d bright_spot() const {
    Eigen::Vector2d sum(0, 0);
    double weight = 0;
    show_film(path_, view_, std::vector{0}, [&](const Image& image) {
      for (int v = 0; v < image.height; ++v)
        for (int u = 0; u < image.width; ++u) {
          const double w = std::max(0, image.row(v)[4 * u] - 60);
          sum += w * Eigen::Vector2d(u, v);
          weight += w;
        }
    });
    return sum / weight;
  }

  std::string path_ = testing::TempDir() + "askew_" + std::to_string(::getpid()) + ".png";
  PictureView view_;
};

TEST_P(SeenAskew, StraightenedAPlaceOfThePlaneIsWhereItsMillHasIt) {
  view_.straightened = true;
  for (const bool mirror : {false, true}) {
    view_.mirror = mirror;
    const double right = GetParam() && !mirror ? -kX : kX;
    const Eigen::Vector2d expected(164.5 + 150 * right, 164.5 - 150 * kY);
    EXPECT_LT((bright_spot() - expected).norm(), 0.3) << bright_spot().transpose();
    EXPECT_LT((place_in_picture(view_, kX, kY, kDepth) - expected).norm(), 1e-9);
  }
}

TEST_P(SeenAskew, APlaceIsFoundInTheFilmsOwnPicture) {
  for (const bool mirror : {false, true}) {
    view_.mirror = mirror;
    EXPECT_LT((bright_spot() - place_in_picture(view_, kX, kY, kDepth)).norm(), 0.3);
    // A ball about that place is seen round it, as wide as the scale there says.
    Eigen::Vector2d middle(0, 0);
    const auto outline = ball_in_picture(view_, kX, kY, kDepth, 40);
    for (const auto& p : outline) middle += p / 40;
    EXPECT_LT((bright_spot() - middle).norm(), 0.3);
    const double width = (outline[0] - outline[20]).norm(),
                 here =
                     (place_in_picture(view_, kX + 0.01, kY, kDepth) - place_in_picture(view_, kX, kY, kDepth)).norm();
    EXPECT_NEAR(width / (2 * kDepth * here / 0.01), 1, 0.05);
  }
}

std::string turning(const testing::TestParamInfo<bool>& info) { return info.param ? "clockwise" : "counter_clockwise"; }
INSTANTIATE_TEST_SUITE_P(Turning, SeenAskew, testing::Bool(), turning);

TEST_F(FilmPictures, WhatIsNoFilmIsAnError) {
  EXPECT_THROW(show_film("no/such.mp4", view_, std::vector{0}, [](const Image&) {}), InputError);
}

}  // namespace
}  // namespace tumble::analysis
