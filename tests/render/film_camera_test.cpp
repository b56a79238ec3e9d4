#include "render/film_camera.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/units.h"
#include "render/film_lens.h"
#include "render/outline_table.h"

namespace tumble::render {
namespace {

// A smooth mill of 0.2 m radius, 0.06 m deep.
FilmScene scene_with(const std::vector<double>& radius) {
  FilmScene scene;
  scene.shape.radius = scene.shape.tip_radius = 0.2;
  scene.length = 0.06;
  scene.radius = radius;
  scene.ball_class.assign(radius.size(), 0);
  return scene;
}

FilmLook plain_look() {
  FilmLook look;
  look.flange.there = false;
  look.timing.exposure = 0;
  place_mill(look.lens, 640, 480, 230, 320, 240, 0);
  return look;
}

// From the left, looking askance through a lens that bends.
FilmLook slanted_look() {
  FilmLook look = plain_look();
  look.lens.position = {-0.9, 0.5, 5};
  look.lens.roll = 0.05;
  look.lens.k1 = -0.4;
  look.lens.k2 = 0.2;
  place_mill(look.lens, 640, 480, 230, 330, 236, 0.3);
  return look;
}

FilmPicture picture_of(const FilmLook& look, const FilmScene& scene, const std::vector<BallState>& balls) {
  FilmCamera camera;
  camera.aim(look, scene);
  FilmMoment moment;
  moment.ball = [&](std::size_t i, double later) {
    BallState b = balls[i];
    b.x += b.vx * later;
    b.y += b.vy * later;
    return b;
  };
  return camera.draw(moment, 0);
}

struct Cover {
  double area = 0, u = 0, v = 0;
};

Cover cover_of(const FilmPicture& picture) {
  Cover cover;
  for (int v = 0; v < picture.image.height; ++v)
    for (int u = 0; u < picture.image.width; ++u) {
      const double share = picture.coverage[static_cast<std::size_t>(v) * picture.image.width + u] / 255.0;
      cover.area += share;
      cover.u += share * u;
      cover.v += share * v;
    }
  cover.u /= cover.area;
  cover.v /= cover.area;
  return cover;
}

TEST(FilmLens, UndoesItsOwnBending) {
  const Pinhole camera = make_pinhole(slanted_look().lens);
  for (const auto& [u, v] : {std::pair{0.0, 0.0}, {639.0, 0.0}, {333.3, 200.0}, {20.0, 470.0}}) {
    const Eigen::Vector2d back = camera.image_from_mill(camera.eye + 3 * camera.ray(u, v));
    EXPECT_NEAR(back.x(), u, 1e-6);
    EXPECT_NEAR(back.y(), v, 1e-6);
  }
}

TEST(FilmLens, PutsTheMillWhereItIsWanted) {
  for (const double crop : {0.0, 0.5, 1.0}) {
    FilmLens lens = slanted_look().lens;
    place_mill(lens, 800, 600, 200, 250, 330, crop);
    const Eigen::Vector2d middle = make_pinhole(lens).image_from_mill(Eigen::Vector3d::Zero());
    EXPECT_NEAR(middle.x(), 250, 1e-6);
    EXPECT_NEAR(middle.y(), 330, 1e-6);
    EXPECT_NEAR(mill_circle_px(make_pinhole(lens)), 200, 6);
  }
}

TEST(FilmLens, RollTurnsThePictureCounterClockwise) {
  FilmLens lens = plain_look().lens;
  lens.roll = 0.2;
  const Pinhole camera = make_pinhole(lens);
  const Eigen::Vector2d way = camera.image_from_mill({0.1, 0, 0}) - camera.image_from_mill({0, 0, 0});
  EXPECT_NEAR(std::atan2(-way.y(), way.x()), 0.2, 1e-9);
}

// Four samples a pixel leave about 0.03 px to chance; a sphere's silhouette lies some hundredths beside its centre.
TEST(FilmCamera, DrawsABallWhereTheTruthSaysItIs) {
  const FilmLook look = slanted_look();
  for (const auto& [x, y, z] : {std::tuple{0.12, 0.08, -0.02}, {-0.15, 0.02, -0.04}, {0.01, -0.16, -0.03}}) {
    const FilmPicture picture = picture_of(look, scene_with({0.015}), {{x, y, z}});
    const SeenBall& ball = picture.balls.front();
    const Cover cover = cover_of(picture);
    EXPECT_NEAR(cover.u, ball.u, 0.1);
    EXPECT_NEAR(cover.v, ball.v, 0.1);
    EXPECT_NEAR(std::sqrt(cover.area / kPi), ball.radius_px, 0.1);
    EXPECT_GT(ball.visible, 0.98);
    // And the truth is what the lens makes of the ball's place.
    const Eigen::Vector2d seen = make_pinhole(look.lens).image_from_mill(Eigen::Vector3d(x, y, z) / 0.2);
    EXPECT_NEAR(ball.u, seen.x(), 1e-9);
    EXPECT_NEAR(ball.v, seen.y(), 1e-9);
  }
}

// Two equal balls at the same height, one behind the other and half a radius aside: what is left of the far one is its
// disc without the lens in which both discs overlap.
TEST(FilmCamera, VisibleShareIsTheDiscWithoutWhatHidesIt) {
  FilmLook look = plain_look();
  look.lens.position = {0, 0, 400};  // so far off that both have one size
  place_mill(look.lens, 640, 480, 230, 320, 240, 0);
  const double r = 0.02, apart = 0.5 * r;
  const FilmPicture picture = picture_of(look, scene_with({r, r}), {{0, 0, -0.02}, {apart, 0, -0.04}});
  const double half = apart / (2 * r);
  const double lens = (2 * std::acos(half) - 2 * half * std::sqrt(1 - half * half)) / kPi;
  EXPECT_NEAR(picture.balls[0].visible, 1, 0.01);
  EXPECT_NEAR(picture.balls[1].visible, 1 - lens, 0.01);
}

TEST(FilmCamera, FixedBarsHideBallsFromTheTruth) {
  FilmLook look = plain_look();
  look.front.bars.push_back({});  // across the middle, 0.1 R wide
  const FilmPicture picture = picture_of(look, scene_with({0.02, 0.005}), {{0, 0, -0.02}, {0.1, 0, -0.02}});
  // A strip of half the ball's radius to each side of its middle.
  const double hidden = 2 * (std::asin(0.5) + 0.5 * std::sqrt(0.75)) / kPi;
  EXPECT_NEAR(picture.balls[0].visible, 1 - hidden, 0.04);  // the bar is nearer than the ball: a little wider
  EXPECT_LT(picture.balls[1].visible, 0.02);
}

TEST(FilmCamera, RollingShutterShiftsWhatMoves) {
  FilmLook look = plain_look();
  look.timing.readout = 0.02;
  const double speed = 1.5, y = 0.12;
  const FilmPicture still = picture_of(look, scene_with({0.015}), {{0, y, -0.02}});
  const FilmPicture moving = picture_of(look, scene_with({0.015}), {{0, y, -0.02, speed, 0}});
  const Cover before = cover_of(still), after = cover_of(moving);
  const double scale = still.balls[0].radius_px / 0.015;  // px per metre
  const double later = look.timing.readout * ((before.v + 0.5) / 480 - 0.5);
  EXPECT_LT(later, -0.004);  // an upper row is read before the middle
  EXPECT_NEAR(after.u - before.u, speed * later * scale, 0.1);
  EXPECT_NEAR(moving.balls[0].u - still.balls[0].u, speed * later * scale, 0.05);
  EXPECT_NEAR(moving.balls[0].state.x, speed * later, 1e-5);
}

TEST(FilmCamera, AShakingCameraMovesPictureAndTruthAlike) {
  const FilmLook look = slanted_look();
  FilmCamera camera;
  camera.aim(look, scene_with({0.015}));
  FilmMoment moment;
  moment.ball = [](std::size_t, double) { return BallState{0.05, -0.08, -0.03}; };
  const FilmPicture still = camera.draw(moment, 0);
  moment.shake = {3.4, -2.7};
  const FilmPicture moved = camera.draw(moment, 1);
  const Cover before = cover_of(still), after = cover_of(moved);
  EXPECT_NEAR(after.u - before.u, 3.4, 0.05);
  EXPECT_NEAR(after.v - before.v, -2.7, 0.05);
  EXPECT_NEAR(moved.balls[0].u - still.balls[0].u, 3.4, 1e-9);
  EXPECT_NEAR(moved.balls[0].v - still.balls[0].v, -2.7, 1e-9);
}

TEST(FilmCamera, AClockwiseMillIsSeenFromItsOtherEnd) {
  FilmScene scene = scene_with({0.015});
  scene.clockwise = true;
  const FilmPicture picture = picture_of(plain_look(), scene, {{0.1, 0.05, -0.02, 0.3, 0, 0.2, 1.0}});
  const SeenBall& ball = picture.balls.front();
  EXPECT_DOUBLE_EQ(ball.state.x, -0.1);
  EXPECT_DOUBLE_EQ(ball.state.vx, -0.3);
  EXPECT_DOUBLE_EQ(ball.state.spin, -1.0);
  EXPECT_NEAR(ball.state.angle, kPi - 0.2, 1e-12);
  EXPECT_NEAR(cover_of(picture).u, ball.u, 0.1);
  EXPECT_LT(ball.u, 320);
}

TEST(FilmCamera, SameSeedSameBytes) {
  FilmLook look = random_look(5, 3);
  place_mill(look.lens, 320, 240, 100, 160, 120, 0);
  const FilmScene scene = scene_with({0.02, 0.015});
  const std::vector<BallState> balls = {{0.05, -0.1, -0.03, 0.5, 0.2, 1, 3}, {-0.05, -0.12, -0.02, 0, 0, 2, 0}};
  const FilmPicture a = picture_of(look, scene, balls), b = picture_of(look, scene, balls);
  EXPECT_EQ(a.image.rgba, b.image.rgba);
  EXPECT_EQ(a.coverage, b.coverage);
}

TEST(OutlineTable, IsZeroAtTheOutlineAndPositiveWhereBallsAre) {
  Mill mill;
  mill.diameter = 0.4;
  mill.lifters.count = 6;
  mill.lifters.profile = LifterProfile::kRectangle;
  mill.lifters.height = 0.02;
  mill.lifters.width = 0.03;
  const MillShape shape = make_mill_shape(mill);
  const OutlineTable table = make_outline_table(shape);
  const auto at = [&](double angle, double rho) {
    const int column = static_cast<int>(angle / (2 * kPi) * table.columns);
    const int row = static_cast<int>((rho - table.begin) / (table.end - table.begin) * table.rows);
    return table.distance[static_cast<std::size_t>(row) * table.columns + column];
  };
  EXPECT_NEAR(at(0.002, 0.85), 0.05, 0.01);  // before a lifter's top, which is at 0.9
  EXPECT_LT(at(0.002, 0.95), 0);             // in it
  EXPECT_NEAR(at(0.5, 0.95), 0.05, 0.01);    // between lifters
  EXPECT_LT(at(0.5, 1.02), 0);               // in the shell
}

}  // namespace
}  // namespace tumble::render
