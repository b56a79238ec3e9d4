#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <variant>

#include "core/error.h"
#include "core/units.h"
#include "render/sheet.h"
#include "tests/support/mill_scene.h"

namespace tumble::render {
namespace {

constexpr double kScale = 302.4 / 0.2725;  // pixels per metre of a 1280 x 720 picture of the 0.545 m mill

Style plain() {
  Style style;
  style.overlay.toe = style.overlay.shoulder = false;
  return style;
}

Image picture(const Scene& scene, const Style& style, const Moment& moment = {}) {
  Renderer renderer(scene.setup, style);
  return renderer.draw(scene.frame, moment);
}

// Where the picture shows its one ball: against the same picture with the ball elsewhere.
Blob ball_in(const Scene& scene, const Style& style, const Moment& moment = {}) {
  Scene empty = scene;
  empty.frame.x[0] = 10;
  return changed(picture(scene, style, moment), picture(empty, style, moment));
}

TEST(Views, OnTheShellABallThatTurnsWithItStandsStill) {
  Style style = plain();
  style.view.from = View::From::kShell;
  Scene scene = scene_of(paper_mill(), 1);
  for (const double angle : {0.0, 0.7, 2.9}) {
    scene.frame.mill_angle = angle;
    scene.frame.x[0] = 0.2 * std::cos(angle + 0.4);
    scene.frame.y[0] = 0.2 * std::sin(angle + 0.4);
    const Blob ball = ball_in(scene, style);
    EXPECT_NEAR(ball.u, 399.5 + 0.2 * kScale * std::cos(0.4), 0.1) << angle;
    EXPECT_NEAR(ball.v, 359.5 - 0.2 * kScale * std::sin(0.4), 0.1) << angle;
  }
}

// The gravity arrow is what changes in the corner when the mill turns; its bright tip points to where down is.
TEST(Views, OnTheShellGravityGoesRound) {
  Style style = plain();
  style.view.from = View::From::kShell;
  Scene scene = scene_of(paper_mill(), 1);
  for (const double angle : {0.0, 1.2, 4.0}) {
    scene.frame.mill_angle = angle;
    const Image image = picture(scene, style);
    double u = 0, v = 0, sum = 0;  // of the arrow's head: bright, in the outer half of the dial at (48, 42)
    for (int y = 18; y < 66; ++y) {
      for (int x = 24; x < 72; ++x) {
        const double r = std::hypot(x - 47.5, y - 41.5);
        if (r < 9 || r > 22 || image.row(y)[4 * x] < 180) continue;
        u += x - 47.5;
        v += y - 41.5;
        sum += 1;
      }
    }
    ASSERT_GT(sum, 10);
    const double down = -kPi / 2 - angle;
    EXPECT_GT(u * std::cos(down) - v * std::sin(down), 0.9 * std::hypot(u, v)) << angle;
  }
}

TEST(Views, AFollowedBallStaysInTheMiddle) {
  Style style = plain();
  style.view = {View::From::kBall, 0, 2.0};
  Scene scene = scene_of(paper_mill(), 3);
  for (const double x : {-0.1, 0.12}) {
    scene.frame.x[0] = x;
    scene.frame.x[1] = x + 0.06;
    scene.frame.y[1] = scene.frame.y[0] + 0.02;
    Scene without = scene;
    without.frame.x[1] = 10;
    const Blob other = changed(picture(scene, style), picture(without, style));
    EXPECT_NEAR(other.u, (776 - 1) / 2.0 + 0.06 * 2 * kScale, 0.2);
    EXPECT_NEAR(other.v, 359.5 - 0.02 * 2 * kScale, 0.2);
  }
}

// However near, nothing of the mill lies over the panel.
TEST(Views, ACloserViewKeepsOffThePanel) {
  Style style = plain(), far = plain();
  style.view.zoom = 3;
  const Scene scene = scene_of(paper_mill(), 60);
  EXPECT_EQ(largest_difference(picture(scene, style), picture(scene, far), 777), 0);
  EXPECT_GT(largest_difference(picture(scene, style), picture(scene, far)), 100);
}

std::vector<SheetMill> three_mills() {
  std::vector<SheetMill> mills;
  for (const double diameter : {0.545, 0.3, 0.545}) {
    Config config = paper_mill();
    config.mill.diameter = diameter;
    mills.push_back({scene_of(config, 1).setup, "mill"});
  }
  return mills;
}

// The ball of cell k, in a sheet of three mills of which the second is smaller.
Blob in_cell(std::size_t k, double x, double y) {
  const std::vector<SheetMill> mills = three_mills();
  Sheet sheet(mills, plain());
  std::vector<Frame> frames(3, scene_of(paper_mill(), 1).frame);
  for (Frame& f : frames) f.x[0] = 10;
  const std::vector<Moment> moments(3);
  const Image empty = sheet.draw(frames, moments, 0);
  frames[k].x[0] = x;
  frames[k].y[0] = y;
  return changed(sheet.draw(frames, moments, 0), empty);
}

TEST(Views, SideBySideAllMillsHaveOneScale) {
  const Blob a0 = in_cell(0, -0.1, 0), a1 = in_cell(0, 0.1, 0), b0 = in_cell(1, -0.1, 0), b1 = in_cell(1, 0.1, 0);
  EXPECT_GT(a1.u - a0.u, 40);
  EXPECT_NEAR(a1.u - a0.u, b1.u - b0.u, 0.2);
  EXPECT_GT(b0.u, a1.u);  // and stand in a row
  EXPECT_NEAR(a0.v, b0.v, 0.2);
}

TEST(Views, SideBySideACellIsAsItsOwnPicture) {
  std::vector<SheetMill> mills = three_mills();
  mills[1] = mills[0];
  Scene scene = scene_of(paper_mill(), 1);
  Sheet sheet(mills, {});
  const std::vector<Frame> frames(3, scene.frame);
  const std::vector<Moment> moments(3, Moment{230, 40, {}, {}, {}});
  const Image all = sheet.draw(frames, moments, 1.25);
  Style style;
  style.width = style.height = 406;
  style.overlay.text = false;
  const Image alone = picture(scene, style, moments[0]);
  int found = 0;  // it is there three times, pixel by pixel
  for (int left = 0; left + 406 <= 1280; ++left)
    for (int top = 100; top < 200; ++top)
      if (std::equal(alone.row(200), alone.row(200) + 406 * 4, all.row(top + 200) + 4 * left) &&
          std::equal(alone.row(60), alone.row(60) + 406 * 4, all.row(top + 60) + 4 * left))
        ++found;
  EXPECT_EQ(found, 3);
}

TEST(Views, SideBySideAFilmsPictureHasTheMillsPlaceAndScale) {
  const std::vector<SheetMill> mills(2, three_mills()[0]);
  Sheet sheet(mills, plain());
  std::vector<Frame> frames(2, scene_of(paper_mill(), 1).frame);
  const std::vector<Moment> moments(2);
  for (Frame& f : frames) f.x[0] = 10;
  const Image empty = sheet.draw(frames, moments, 0);
  frames[1].x[0] = 0.1;
  frames[1].y[0] = 0.05;
  const Blob ball = changed(sheet.draw(frames, moments, 0), empty);

  const FilmSquare square = sheet.square();
  const double pixels_per_metre = square.edge_px / 2.0 / square.margin / (0.545 / 2);
  Image film(square.edge_px, square.edge_px);  // transparent
  frames[1].x[0] = 10;
  sheet.set_picture(1, film);
  const Image ground = sheet.draw(frames, moments, 0);
  const int u = static_cast<int>(square.edge_px / 2.0 + 0.1 * pixels_per_metre),
            v = static_cast<int>(square.edge_px / 2.0 - 0.05 * pixels_per_metre);
  for (int dv = -2; dv <= 2; ++dv) std::fill_n(film.row(v + dv) + 4 * (u - 2), 4 * 5, std::uint8_t{255});
  sheet.set_picture(1, film);
  const Blob dot = changed(sheet.draw(frames, moments, 0), ground);
  EXPECT_NEAR(dot.u, ball.u, 1);
  EXPECT_NEAR(dot.v, ball.v, 1);
  EXPECT_FALSE(std::equal(ground.row(empty.height / 2), ground.row(empty.height / 2) + 4 * empty.width,
                          empty.row(empty.height / 2)))
      << "the mill itself is not drawn under its film";
}

TEST(Views, ASheetHoldsOneToTwelveMills) {
  const std::vector<SheetMill> one(1, three_mills()[0]), thirteen(13, one[0]);
  EXPECT_THROW(Sheet({}, {}), InputError);
  EXPECT_THROW(Sheet(thirteen, {}), InputError);
  const Scene scene = scene_of(paper_mill(), 1);
  Sheet sheet(one, {});
  EXPECT_TRUE(sheet.draw({&scene.frame, 1}, std::vector<Moment>(1), 0).rgba == picture(scene, {}).rgba);
}

// A drawing has what the picture has, where the picture has it.
TEST(Views, ADrawingIsThePictureInShapes) {
  const Scene scene = scene_of(paper_mill(), 40);
  for (const View::From from : {View::From::kLab, View::From::kShell, View::From::kBall}) {
    Style style;
    style.view.from = from;
    Renderer renderer(scene.setup, style);
    const Moment moment{230, 40, {}, {}, {}};
    const Image before = renderer.draw(scene.frame, moment);
    const Drawing drawing = renderer.sketch(scene.frame, moment);
    EXPECT_TRUE(renderer.draw(scene.frame, moment).rgba == before.rgba);  // sketching leaves no trace
    int balls = 0, depth = 0;
    bool has_shoulder = false;
    for (const Drawing::Shape& shape : drawing.shapes) {
      if (const auto* ball = std::get_if<Drawing::Ball>(&shape)) {
        ++balls;
        EXPECT_GT(ball->radius, 12 * 1.1);
      }
      if (const auto* label = std::get_if<Drawing::Label>(&shape)) has_shoulder |= label->text == "shoulder";
      depth += std::holds_alternative<Drawing::Enter>(shape) - std::holds_alternative<Drawing::Leave>(shape);
    }
    EXPECT_EQ(balls, 40);
    EXPECT_EQ(depth, 0);
    EXPECT_TRUE(has_shoulder || from == View::From::kBall);
  }
}

// What stands for a place or a height in the mill turns and mirrors with it.
TEST(Views, TheMeanTurnsWithTheMill) {
  struct Case {
    bool Overlay::*shown;
    double x, y;  // of the middle of what it draws [m]
    double within;
  };
  const Case cases[] = {{&Overlay::streamlines, 0.06, -0.1, 0.02},
                        {&Overlay::occupancy, 0.06, -0.1, 0.02},
                        {&Overlay::circulation, 0.06, -0.1, 0.03},
                        {&Overlay::surface, 0, 0.05, 0.004}};
  for (const double angle : {0.0, 0.8, 4.0}) {
    for (const bool mirror : {false, true}) {
      Scene scene = scene_of(paper_mill(), 0);
      scene.frame.mill_angle = angle;
      Style style = plain();
      style.overlay.text = false;
      style.mirror = mirror;
      style.view.from = View::From::kShell;
      const Image bare = picture(scene, style);
      for (const Case& c : cases) {
        Style with = style;
        with.overlay.*c.shown = true;
        Renderer renderer(scene.setup, with);
        renderer.set_mean(mean_motion());
        const Blob blob = changed(renderer.draw(scene.frame, {}), bare);
        const double x = c.x * std::cos(angle) + c.y * std::sin(angle);
        const double y = c.y * std::cos(angle) - c.x * std::sin(angle);
        EXPECT_NEAR((mirror ? -1 : 1) * (blob.u - 639.5) / kScale, x, c.within) << &c - cases << " at " << angle;
        EXPECT_NEAR((359.5 - blob.v) / kScale, y, c.within) << &c - cases << " at " << angle;
      }
      Style with = style;
      with.overlay.head = true;
      Renderer renderer(scene.setup, with);
      renderer.set_mean(mean_motion());
      const Image image = renderer.draw(scene.frame, {});
      int dashes = 0;  // along the line, half of it
      for (int k = -190; k < 190; ++k) {
        const double x = 0.001 * k, across = x * std::cos(angle) + 0.15 * std::sin(angle);
        const auto u = static_cast<int>(std::lround(639.5 + (mirror ? -1 : 1) * across * kScale));
        const auto v = static_cast<int>(std::lround(359.5 - (0.15 * std::cos(angle) - x * std::sin(angle)) * kScale));
        dashes += difference(image, bare, v, u) > 60;
      }
      EXPECT_NEAR(dashes, 190, 40) << angle;
    }
  }
}

// On the shell its arrows are those against the shell: a charge that turns with it has none.
TEST(Views, OnTheShellAChargeThatTurnsWithItHasNoMeanVelocity) {
  const Scene scene = scene_of(paper_mill(), 0);
  ChargeMotion motion = mean_motion();
  Field& f = motion.field;
  for (int j = 0; j < f.n; ++j) {
    for (int i = 0; i < f.n; ++i) {
      const auto k = static_cast<std::size_t>(j * f.n + i);
      f.vx[k] = -scene.setup.mill_speed * (j - 19.5) * f.cell;
      f.vy[k] = scene.setup.mill_speed * (i - 19.5) * f.cell;
    }
  }
  for (const View::From from : {View::From::kLab, View::From::kShell}) {
    Style style = plain(), with = plain();
    style.overlay.text = with.overlay.text = false;
    style.view.from = with.view.from = from;
    with.overlay.mean_velocity = true;
    Renderer renderer(scene.setup, with);
    renderer.set_mean(motion);
    const int arrows = largest_difference(renderer.draw(scene.frame, {}), picture(scene, style));
    EXPECT_TRUE(from == View::From::kLab ? arrows > 100 : arrows == 0) << arrows;
  }
}

// Labels at the rim make way for the key, wherever a view puts it and the mark.
TEST(Views, MarksKeepOffTheKey) {
  Scene scene = scene_of(paper_mill(), 0);
  scene.frame.mill_angle = 0;
  for (const View::From from : {View::From::kLab, View::From::kShell}) {
    Style style = plain();
    style.view.from = from;
    style.overlay.departure = true;
    const Image keyless = picture(scene, style);
    style.overlay.surface = style.overlay.streamlines = style.overlay.occupancy = style.overlay.chains = true;
    Renderer renderer(scene.setup, style);
    const Image none = renderer.draw(scene.frame, {});
    int left = none.width, right = 0, top = none.height, bottom = 0;  // of the key
    for (int v = 0; v < none.height; ++v) {
      for (int u = 0; u < none.width; ++u) {
        if (difference(none, keyless, v, u) == 0) continue;
        left = std::min(left, u);
        right = std::max(right, u);
        top = std::min(top, v);
        bottom = std::max(bottom, v);
      }
    }
    ASSERT_LT(left, right);
    const double first = from == View::From::kLab ? 120 : 40;  // the side on which the key stands
    for (double at = first; at <= first + 20; at += 2) {
      ChargeMotion motion;
      motion.departure_deg.value = at;
      renderer.set_mean(motion);
      const Image marked = renderer.draw(scene.frame, {});
      int covered = 0;
      for (int v = top; v <= bottom; ++v)
        for (int u = left; u <= right; ++u) covered += difference(marked, none, v, u) > 30;
      EXPECT_EQ(covered, 0) << at;
    }
  }
}

TEST(Views, SideBySideEachMillHasItsOwnMean) {
  const std::vector<SheetMill> mills(2, three_mills()[0]);
  Style style = plain();
  style.overlay.surface = true;
  Sheet sheet(mills, style);
  const std::vector<Frame> frames(2, scene_of(paper_mill(), 1).frame);
  const std::vector<Moment> moments(2);
  const Image none = sheet.draw(frames, moments, 0);
  sheet.set_mean(1, mean_motion());
  const Image one = sheet.draw(frames, moments, 0);
  EXPECT_GT(largest_difference(one, none), 100);
  for (int v = 0; v < one.height; ++v) ASSERT_TRUE(std::equal(one.row(v), one.row(v) + 640 * 4, none.row(v)));
}

// Overlays are lines and words in a drawing, in the theme's own inks.
TEST(Views, ADrawingHasTheOverlays) {
  Scene scene = scene_of(paper_mill(), 2);
  Style style;
  style.theme = ThemeName::kLight;
  style.view.from = View::From::kShell;
  style.overlay = {true, true, false, true, true, true, true, true, true, true, true, true, true, true};
  Renderer renderer(scene.setup, style);
  renderer.set_mean(mean_motion());
  renderer.set_force_scale(100);
  const ContactForce contacts[] = {{0, 1, 0, 0, 100}};
  Moment moment{230, 40, {}, {}, {}};
  moment.contacts = contacts;
  const Drawing drawing = renderer.sketch(scene.frame, moment);
  EXPECT_EQ(drawing.ground.r, 255);
  std::map<std::string, int> words;
  int outlined = 0, chains = 0;
  for (const Drawing::Shape& shape : drawing.shapes) {
    if (const auto* label = std::get_if<Drawing::Label>(&shape)) {
      ++words[label->text];
      outlined += label->halo_width > 0;
    }
    if (const auto* stroke = std::get_if<Drawing::Stroke>(&shape))
      chains += stroke->colour.r == 196 && stroke->colour.g == 24 && stroke->width > 7;  // and its sample in the key
  }
  for (const char* word : {"CoC", "head 150 mm", "20 %", "60 %", "departure", "impact", "toe", "shoulder", "gravity",
                           "free surface", "mean flow", "occupancy", "force 100 N"})
    EXPECT_EQ(words[word], 1) << word;
  EXPECT_EQ(outlined, 5);  // 20, 40, 60 %, head, CoC
  EXPECT_EQ(chains, 2);
}

TEST(Views, EglDrawsWhatOsmesaDraws) {
  const Scene scene = scene_of(paper_mill(), 112);
  Style egl;
  egl.overlay.velocity = true;
  Style osmesa = egl;
  egl.context = ContextKind::kEgl;
  std::optional<Image> image;
  try {
    image = picture(scene, egl, {230, 40, {}, {}, {}});
  } catch (const WorkError& e) {
    GTEST_SKIP() << e.what();
  }
  EXPECT_LE(largest_difference(*image, picture(scene, osmesa, {230, 40, {}, {}, {}})), 1);
}

}  // namespace
}  // namespace tumble::render
