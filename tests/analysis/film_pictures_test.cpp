#include "analysis/film_pictures.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <vector>

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

TEST_F(FilmPictures, WhatIsNoFilmIsAnError) {
  EXPECT_THROW(show_film("no/such.mp4", view_, std::vector{0}, [](const Image&) {}), InputError);
}

}  // namespace
}  // namespace tumble::analysis
