#include "analysis/mill_camera.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "core/units.h"

namespace tumble::analysis {
namespace {

MillCamera oblique_camera() {
  MillCamera c;
  c.width = 1280;
  c.height = 720;
  c.focal = 1500;
  c.centre_u = 650;
  c.centre_v = 350;
  c.k1 = -0.1;
  c.k2 = 0.02;
  c.rotation = (Eigen::AngleAxisd(0.06, Eigen::Vector3d::UnitX()) * Eigen::AngleAxisd(-0.13, Eigen::Vector3d::UnitY()))
                   .toRotationMatrix() *
               MillCamera::frontal();
  c.translation = {0.02, -0.01, 1.5};
  return c;
}

TEST(MillCamera, FrontalPictureHasXToTheRightAndYUp) {
  MillCamera c;
  c.focal = 1000;
  c.translation = {0, 0, 2};
  const cv::Point2d p = picture_of(c, {0.2, 0.1, 0});
  EXPECT_NEAR(p.x, 100, 1e-9);
  EXPECT_NEAR(p.y, -50, 1e-9);
  EXPECT_GT(picture_of(c, {0.2, 0, 0.1}).x, p.x);  // z leads towards the camera
}

TEST(MillCamera, PlacesComeBackFromTheirPixelsInTheirPlane) {
  const MillCamera c = oblique_camera();
  for (double z : {0.0, -0.012, -0.066})
    for (double a = 0; a < 6; a += 0.7) {
      const Eigen::Vector3d place(0.27 * std::cos(a), 0.27 * std::sin(a), z);
      EXPECT_LT((mill_place_at(c, picture_of(c, place), z) - place.head<2>()).norm(), 1e-9);
    }
}

TEST(MillCamera, NothingIsSeenBehindTheCamera) {
  const MillCamera c = oblique_camera();
  EXPECT_TRUE(std::isnan(picture_of(c, {0, 0, 5}).x));
  EXPECT_TRUE(std::isnan(mill_place_at(c, {600, 300}, 5).x()));
}

TEST(MillCamera, ABallIsSeenWiderThanItsDiscAsItsOutlineLiesNearer) {
  MillCamera c;
  c.focal = 1000;
  c.translation = {0, 0, 1};
  // Tangent cone of half angle asin(r / d).
  EXPECT_NEAR(apparent_radius(c, {0, 0, 0}, 0.1), 1000 * std::tan(std::asin(0.1)), 1e-6);
}

TEST(MillCamera, FromAfarTheGlassLooksTheSameAndDepthDoesNotShow) {
  MillCamera c = oblique_camera();
  c.rotation = MillCamera::frontal();
  const MillCamera afar = from_afar(c);
  for (double a = 0; a < 6; a += 0.7) {
    const Eigen::Vector3d place(0.27 * std::cos(a), 0.27 * std::sin(a), 0), behind(place.x(), place.y(), -0.05);
    const cv::Point2d seen = picture_of(c, place);
    EXPECT_LT(cv::norm(picture_of(afar, place) - seen), 1e-6);
    EXPECT_LT(cv::norm(picture_of(afar, behind) - seen), 0.01);
    EXPECT_GT(cv::norm(picture_of(c, behind) - seen), 5);
  }
}

TEST(MillCamera, RolledFrameTurnsPlacesBack) {
  const MillCamera c = oblique_camera(), turned = rolled(c, 0.3);
  const cv::Point2d before = picture_of(c, {0.2 * std::cos(0.3), 0.2 * std::sin(0.3), 0}),
                    after = picture_of(turned, {0.2, 0, 0});
  EXPECT_NEAR(before.x, after.x, 1e-9);
  EXPECT_NEAR(before.y, after.y, 1e-9);
}

TEST(MillCamera, EnlargedPicturesKeepPixelCentres) {
  const MillCamera c = oblique_camera(), twice = for_enlarged_pictures(c, 2);
  const cv::Point2d p = picture_of(c, {0.1, 0.2, 0}), q = picture_of(twice, {0.1, 0.2, 0});
  EXPECT_NEAR((q.x + 0.5) / 2 - 0.5, p.x, 1e-9);
  EXPECT_NEAR((q.y + 0.5) / 2 - 0.5, p.y, 1e-9);
}

}  // namespace
}  // namespace tumble::analysis
