#include "analysis/drum_calibration.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <complex>

#include "analysis/drum_turn.h"
#include "core/error.h"
#include "tests/analysis/painted_drum.h"

namespace tumble::analysis {
namespace {

const cv::Size kPicture{640, 360};

struct Film {
  PaintedDrum drum;
  std::vector<cv::Mat> pictures;
  std::vector<double> angles;
};

Film film_of(const PaintedDrum& drum, const std::vector<int>& turns) {
  Film film{drum, {}, {}};
  DrumPainter painter(drum);
  double angle = 0.3;
  for (int turn : turns) {
    angle += turn * drum.step;
    film.angles.push_back(angle);
    film.pictures.push_back(turn == 0 && !film.pictures.empty() ? film.pictures.back() : painter.paint(angle));
  }
  return film;
}

DrumView calibrated(const Film& film) {
  Config known;
  known.mill.diameter = 2 * film.drum.shell;
  known.charge.balls.push_back({film.drum.ball});
  std::size_t i = 0;
  return calibrate_drum(
      [&](cv::Mat& bgr) {
        if (i == film.pictures.size()) return false;
        film.pictures[i++].copyTo(bgr);
        return true;
      },
      50, known, {});
}

// RMS distance of the places that pixels are given from where they are, in a plane, but for scale and turn about the
// axis [m].
double place_error(const MillCamera& found, const PaintedDrum& drum, double z) {
  std::vector<std::complex<double>> is, seems;
  for (double r : {0.0, 0.3, 0.6, 0.95})
    for (int k = 0; k < 16; ++k) {
      const double x = r * drum.shell * std::cos(k * kPi / 8), y = r * drum.shell * std::sin(k * kPi / 8);
      const Eigen::Vector2d p = mill_place_at(found, picture_of(drum.camera, {x, y, z}), z);
      is.emplace_back(x, y);
      seems.emplace_back(p.x(), p.y());
    }
  std::complex<double> match = 0;
  double size = 0, sum = 0;
  for (std::size_t i = 0; i < is.size(); ++i) {
    match += std::conj(seems[i]) * is[i];
    size += std::norm(seems[i]);
  }
  for (std::size_t i = 0; i < is.size(); ++i) sum += std::norm(seems[i] * match / size - is[i]);
  return std::sqrt(sum / static_cast<double>(is.size()));
}

double worst_angle(const DrumView& view, const Film& film) {
  std::vector<double> misses;
  for (std::size_t t = 0; t < film.angles.size(); ++t) misses.push_back(view.angles[t].angle - film.angles[t]);
  std::vector<double> ordered = misses;
  std::sort(ordered.begin(), ordered.end());
  double worst = 0;
  for (double m : misses) worst = std::max(worst, std::abs(m - ordered[ordered.size() / 2]));
  return worst;
}

PaintedDrum seen_from(double yaw, double pitch) {
  PaintedDrum drum;
  drum.camera = camera_for(kPicture, 700, yaw, pitch, 0.45 * kPicture.height, drum.rim, {333.3, 181.2}, -0.06);
  drum.flange_contrast = 0.7;
  return drum;
}

// An oblique view by a rolling shutter, with repeated and missing pictures, clockwise: made once, asked by several
// tests.
struct ObliqueFilm {
  Film film;
  DrumView view;
};

const ObliqueFilm& oblique() {
  static const ObliqueFilm kFilm = [] {
    PaintedDrum drum = seen_from(0.15, -0.1);
    drum.readout = 0.8;
    drum.step = -0.055;
    std::vector<int> turns(90, 1);
    turns[0] = turns[17] = turns[60] = 0;
    turns[30] = turns[80] = 2;
    Film film = film_of(drum, turns);
    DrumView view = calibrated(film);
    return ObliqueFilm{std::move(film), std::move(view)};
  }();
  return kFilm;
}

TEST(DrumCalibration, ObliqueViewIsFoundFromTheTexture) {
  const auto& [film, view] = oblique();
  ASSERT_TRUE(view.found);
  // A tenth of a pixel is 0.2 mm; the frontal view that was supposed so far is 10 mm off.
  EXPECT_LT(place_error(view.camera, film.drum, 0), 0.7e-3);
  EXPECT_LT(place_error(view.camera, film.drum, -film.drum.ball), 0.9e-3);
  EXPECT_NEAR(view.obliqueness.value, obliqueness(film.drum.camera), 0.7 * kPi / 180);
  const cv::Point2d axis = picture_of(film.drum.camera, Eigen::Vector3d::Zero());
  EXPECT_NEAR(view.centre_u.value, axis.x, 0.5);
  EXPECT_NEAR(view.centre_v.value, axis.y, 0.5);
}

TEST(DrumCalibration, RollingShutterIsToldFromPerspective) {
  EXPECT_NEAR(oblique().view.readout.value, 0.8, 0.1);
  EXPECT_LT(std::abs(oblique().view.readout.value - 0.8), 3 * oblique().view.readout.se);
}

TEST(DrumCalibration, AnglesFollowRepeatedAndMissingPictures) {
  const auto& [film, view] = oblique();
  ASSERT_EQ(view.angles.size(), film.angles.size());
  EXPECT_LT(worst_angle(view, film), 0.1 * kPi / 180);
  EXPECT_LT(std::abs(view.angles[17].angle - view.angles[16].angle), 1e-3);
  EXPECT_NEAR(view.angles[30].angle - view.angles[29].angle, 2 * film.drum.step, 2e-3);
  EXPECT_NEAR(view.turn_per_frame.value, film.drum.step, 5e-4 * std::abs(film.drum.step));
}

TEST(DrumCalibration, AFurtherPictureHasItsAngle) {
  const auto& [film, view] = oblique();
  DrumPainter painter(film.drum);  // the same drum, its balls elsewhere
  const double zero = view.angles[0].angle - film.angles[0], angle = film.angles.back() + 40 * film.drum.step;
  const DrumAngle found = (*view.reader)(painter.paint(angle), angle + zero + 0.03, 0.03);
  EXPECT_NEAR(found.angle, angle + zero, 0.1 * kPi / 180);
  EXPECT_LT(found.error, 0.1 * kPi / 180);
}

// A band whose pattern nearly repeats itself three times round, and one picture of it in noise.
TEST(DrumTurn, ADrumDoesNotJumpToWhereItLooksAlike) {
  constexpr int kColumns = 720;
  const auto band = [&](double angle, double odd) {
    cv::Mat m(12, kColumns, CV_32F);
    for (int k = 0; k < kColumns; ++k) {
      const double a = 2 * kPi * k / kColumns - angle;
      for (int r = 0; r < m.rows; ++r)
        m.at<float>(r, k) = static_cast<float>(10 * std::cos(3 * a) + 8 * std::sin(9 * a) + odd * std::cos(4 * a));
    }
    return m;
  };
  // The picture is the pattern at 0.5, but what tells the three apart says that it is at 0.5 + 120 degrees.
  cv::Mat picture = band(0.5, 0);
  const cv::Mat elsewhere = band(0.5 + 2 * kPi / 3, 6) - band(0.5 + 2 * kPi / 3, 0);
  picture += elsewhere;
  const RoundSpectrum pattern(band(0, 6)), seen(picture);
  EXPECT_NEAR(angle_of(pattern, seen, 0.48, 0.05), 0.5, 0.05);
  EXPECT_NEAR(angle_of(pattern, seen, 0.48 + 2 * kPi / 3, 0.05), 0.5 + 2 * kPi / 3, 0.02);
}

TEST(DrumCalibration, ScaleIsGoodWithinItsError) {
  const auto& [film, view] = oblique();
  const Eigen::Vector2d p = mill_place_at(view.camera, picture_of(film.drum.camera, {0, film.drum.shell, 0}), 0);
  EXPECT_NEAR(p.norm(), film.drum.shell, 3 * view.scale.se * film.drum.shell);
}

TEST(DrumCalibration, NothingIsHiddenWhereNothingStandsInFront) {
  double share = 0;
  for (double h : oblique().view.hidden_share) share += h / 360;
  EXPECT_LT(share, 0.03);
}

TEST(AwkwardDrum, BarIsHiddenAndDoesNotMislead) {
  PaintedDrum drum = seen_from(-0.08, 0.03);
  drum.bar_angle = 2.4;
  const Film film = film_of(drum, std::vector<int>(80, 1));
  const DrumView view = calibrated(film);
  ASSERT_TRUE(view.found);
  EXPECT_LT(place_error(view.camera, drum, 0), 0.7e-3);
  const int bar = static_cast<int>(drum.bar_angle * 180 / kPi);
  EXPECT_GT(view.hidden_share[static_cast<std::size_t>(bar)], 0.9);
  EXPECT_LT(view.hidden_share[static_cast<std::size_t>(bar + 12)], 0.1);
  EXPECT_LT(view.hidden_share[static_cast<std::size_t>(bar - 12)], 0.1);
}

TEST(AwkwardDrum, RimOutsideOfThePictureIsNoHindrance) {
  PaintedDrum drum = seen_from(0.06, 0.1);
  drum.camera = camera_for(kPicture, 650, 0.06, 0.1, 0.58 * kPicture.height, drum.rim, {300, 190}, 0.05);
  const Film film = film_of(drum, std::vector<int>(80, 1));
  const DrumView view = calibrated(film);
  ASSERT_TRUE(view.found);
  EXPECT_LT(place_error(view.camera, drum, 0), 0.7e-3);
  EXPECT_LT(worst_angle(view, film), 0.1 * kPi / 180);
}

// A third of the rim in view: the circle that is all in view is a part of the back plate.
TEST(AwkwardDrum, ADrumMostlyOutsideOfThePictureIsFound) {
  for (const double step : {0.03, -0.03}) {
    PaintedDrum drum = seen_from(0, 0);
    drum.camera = camera_for(kPicture, 700, 0.0, 0.0, 1.0 * kPicture.height, drum.rim, {470, 300}, 0);
    drum.step = step;
    const DrumView view = calibrated(film_of(drum, std::vector<int>(60, 1)));
    ASSERT_TRUE(view.found);
    EXPECT_LT(view.in_view, 0.5);
    EXPECT_NEAR(view.turn_per_frame.value, step, 0.05 * std::abs(step));  // marks on the back plate seem slower here
    const cv::Point2d axis = picture_of(drum.camera, Eigen::Vector3d::Zero());
    EXPECT_NEAR(view.centre_u.value, axis.x, 5);
    EXPECT_NEAR(view.centre_v.value, axis.y, 5);
  }
}

// A chart that scrolls beside the drum: a wide circle about the drum's axis moves wherever it is in view, and evenly.
TEST(AwkwardDrum, WhatMovesBesideADrumIsNotTheDrum) {
  PaintedDrum drum = seen_from(0, 0);
  drum.camera = camera_for(kPicture, 700, 0, 0, 0.45 * kPicture.height, drum.rim, {175, 180}, 0);
  Film film = film_of(drum, std::vector<int>(60, 1));
  Random random(7);
  cv::Mat coarse(40, 16, CV_8U), chart;
  for (int i = 0; i < 40 * 16; ++i) coarse.at<uchar>(i / 16, i % 16) = static_cast<uchar>(random.uniform(30, 220));
  cv::resize(coarse, chart, {280, 700}, 0, 0, cv::INTER_CUBIC);
  cv::cvtColor(chart, chart, cv::COLOR_GRAY2BGR);
  for (std::size_t t = 0; t < film.pictures.size(); ++t)
    chart.rowRange(static_cast<int>(t), static_cast<int>(t) + kPicture.height)
        .copyTo(film.pictures[t].colRange(360, 640));
  const DrumView view = calibrated(film);
  ASSERT_TRUE(view.found);
  EXPECT_NEAR(view.turn_per_frame.value, drum.step, 5e-4 * drum.step);
  EXPECT_NEAR(view.centre_u.value, 175, 0.5);
  EXPECT_NEAR(view.centre_v.value, 180, 0.5);
}

TEST(DrumCalibration, AStillMillIsRefusedWithAReason) {
  const Film film = film_of(seen_from(0, 0), std::vector<int>(20, 0));
  const DrumView view = calibrated(film);
  EXPECT_FALSE(view.found);
  ASSERT_FALSE(view.caveats.empty());
}

TEST(DrumCalibration, AMissingFilmIsAnInputError) { EXPECT_THROW(calibrate_drum("no_such.mp4", {}, {}), InputError); }

}  // namespace
}  // namespace tumble::analysis
