#include "render/renderer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <thread>
#include <tuple>

#include "core/error.h"
#include "core/units.h"
#include "render/palette.h"
#include "tests/support/mill_scene.h"

namespace tumble::render {
namespace {

struct Trace {
  std::vector<double> time, torque;
};

Trace trace() {
  Trace t;
  for (int i = 0; i < 400; ++i) {
    t.time.push_back(0.01 * i);
    t.torque.push_back(10 + 3 * std::sin(0.37 * i) + std::sin(0.013 * i));
  }
  return t;
}

Image picture(const Scene& scene, const Style& style, const Moment& moment = {}) {
  Renderer renderer(scene.setup, style);
  return renderer.draw(scene.frame, moment);
}

// The rule of render/camera.h in numbers: R is 302.4 px of a 1280 x 720 picture, the axis in the middle of pixel edges
// (400, 360).
TEST(Renderer, PutsABallWhereTheCameraRuleSays) {
  for (const bool mirror : {false, true}) {
    Scene scene = scene_of(paper_mill(), 1);
    Style style;
    style.mirror = mirror;
    scene.setup.balls.radius[0] = 0.025;
    scene.frame.x[0] = 0.0712;
    scene.frame.y[0] = -0.1334;
    Scene empty = scene;
    empty.frame.x[0] = 10;  // outside the picture
    const Blob blob = changed(picture(scene, style), picture(empty, style));
    const double scale = 302.4 / 0.2725;
    EXPECT_NEAR(blob.u, 399.5 + (mirror ? -1 : 1) * 0.0712 * scale, 0.1);
    EXPECT_NEAR(blob.v, 359.5 + 0.1334 * scale, 0.1);
    EXPECT_NEAR(std::sqrt(blob.area / kPi), 0.025 * scale, 0.6);
  }
}

// Seen from the other end, x, the marks and the mill's turning are mirrored; light and letters are not.
TEST(Renderer, MirrorsTheMillAndNotItsFurniture) {
  const Scene scene = scene_of(paper_mill(), 40);
  Scene reflected = scene;
  for (std::size_t i = 0; i < scene.frame.x.size(); ++i) {
    reflected.frame.x[i] = -scene.frame.x[i];
    reflected.frame.angle[i] = kPi - scene.frame.angle[i];
  }
  reflected.frame.mill_angle = -scene.frame.mill_angle;
  Style mirrored, plain;
  mirrored.overlay.text = plain.overlay.text = false;
  mirrored.mirror = true;
  const Moment marks{230, 40, {}, {}, {}}, reflected_marks{140, 310, {}, {}, {}};
  // Corners of antialiased polygons blend in the other order, a few grey levels; a shape that stood wrongly by half a
  // pixel would differ by 50 and more.
  EXPECT_LE(largest_difference(picture(scene, mirrored), picture(reflected, plain)), 25);
  EXPECT_GT(largest_difference(picture(scene, mirrored), picture(scene, plain)), 100);
  // Pointers and arc are mirrored too (so toe and shoulder change places); labels go on stating the mill's own angles.
  const Blob labels = changed(picture(scene, mirrored, marks), picture(reflected, plain, reflected_marks), 40);
  const Blob pointers = changed(picture(scene, mirrored, marks), picture(scene, mirrored), 40);
  EXPECT_LT(labels.area, 0.6 * pointers.area);

  Style with_text;
  with_text.mirror = true;
  EXPECT_EQ(largest_difference(picture(scene, with_text), picture(scene, Style{}), 790), 0);
}

TEST(Renderer, DrawsTheSamePixelsInEveryThread) {
  const Scene scene = scene_of(paper_mill(), 112);
  const Trace t = trace();
  const Moment moment{232, 38, t.time, t.torque, {}};
  const Image alone = picture(scene, {}, moment);
  Renderer built_here(scene.setup, {});
  Image first, second;
  std::thread one([&] { first = built_here.draw(scene.frame, moment); });
  std::thread two([&] {
    Renderer built_there(scene.setup, {});
    for (int i = 0; i < 3; ++i) second = built_there.draw(scene.frame, moment);
  });
  one.join();
  two.join();
  EXPECT_TRUE(alone.rgba == first.rgba);
  EXPECT_TRUE(alone.rgba == second.rgba);
}

// What stands still is painted once: nothing of an earlier frame, scale or trace may stay behind.
TEST(Renderer, RemembersNothingOfEarlierFrames) {
  const Scene scene = scene_of(paper_mill(), 30), other = scene_of(paper_mill(), 30, 2);
  Frame late = other.frame;
  late.time = 3.5;
  const Trace t = trace();
  std::vector<double> half(t.torque);
  for (double& value : half) value /= 2;
  const Moment first{232, 38, t.time, t.torque, {}}, second{100, 20, t.time, half, {}};

  Renderer used(scene.setup, {}), fresh(scene.setup, {}), scaled(scene.setup, {});
  scaled.set_scale(0, 9);
  used.draw(scene.frame, first);
  EXPECT_EQ(largest_difference(used.draw(late, first), fresh.draw(late, first)), 0);  // another frame
  used.set_scale(0, 9);
  EXPECT_EQ(largest_difference(used.draw(late, first), scaled.draw(late, first)), 0);  // another scale
  Renderer with_second(scene.setup, {});
  with_second.set_scale(0, 9);
  EXPECT_EQ(largest_difference(used.draw(scene.frame, second), with_second.draw(scene.frame, second)), 0);  // trace
  EXPECT_GT(largest_difference(used.draw(scene.frame, first), with_second.draw(scene.frame, second)), 100);
}

TEST(Renderer, ColourBarRunsFromDarkToLight) {
  const Image image = picture(scene_of(paper_mill(), 3), {});
  double before = 0;
  for (int u = 801; u < 1239; u += 4) {
    const std::uint8_t* p = image.row(655) + 4 * u;
    const double now = lightness({p[0], p[1], p[2]});
    EXPECT_GT(now, before - 0.002) << u;
    before = now;
  }
  EXPECT_GT(before, 0.9);
}

TEST(Renderer, MarksTurnAndFadeOnSmallBalls) {
  for (const double radius : {0.018, 0.003}) {
    Scene scene = scene_of(paper_mill(), 1);
    scene.setup.balls.radius[0] = radius;
    Scene turned = scene;
    turned.frame.angle[0] += 1.3;
    const int difference = largest_difference(picture(scene, {}), picture(turned, {}));
    if (radius > 0.01) {
      EXPECT_GT(difference, 40);
    } else {
      EXPECT_EQ(difference, 0);
    }
  }
}

TEST(Renderer, TorqueCursorFollowsTheClock) {
  Scene scene = scene_of(paper_mill(), 1);
  const Trace t = trace();
  const auto cursor = [&](double time) {  // the accent's amber in the plot's first row
    scene.frame.time = time;
    const Image image = picture(scene, {}, {kNotGiven, kNotGiven, t.time, t.torque, {}});
    for (int u = 800; u < 1245; ++u) {
      const std::uint8_t* p = image.row(300) + 4 * u;
      if (p[0] > 150 && p[2] < 90) return u;
    }
    return -1;
  };
  const int start = cursor(0), middle = cursor(1.995), end = cursor(3.99);
  EXPECT_GT(start, 800);
  EXPECT_NEAR(end, 1239, 2);
  EXPECT_NEAR(middle, (start + end) / 2.0, 1);
}

TEST(Renderer, TakesEveryMillThatAConfigCanHold) {
  Config smooth = paper_mill();
  smooth.mill.lifters = {};
  Config triangles = paper_mill();
  triangles.mill.lifters.profile = LifterProfile::kTriangle;
  Config trapezoids = paper_mill();
  trapezoids.mill.lifters.profile = LifterProfile::kTrapezoid;
  trapezoids.mill.lifters.leading_angle_deg = 20;
  trapezoids.mill.lifters.count = 1;
  for (const Config& config : {smooth, triangles, trapezoids}) {
    const Scene scene = scene_of(config, 5);
    std::vector<Frame> past(3, scene.frame);
    for (std::size_t i = 0; i < past.size(); ++i) past[i].time -= 0.01 * static_cast<double>(past.size() - i);
    const std::tuple<int, int, Colour> looks[] = {
        {64, 64, Colour::kSpeed}, {640, 360, Colour::kSize}, {720, 1280, Colour::kSpin}, {1920, 1080, Colour::kSteel}};
    for (const auto& [width, height, colour] : looks) {
      Style style;
      style.width = width;
      style.height = height;
      style.colour = colour;
      style.overlay.tracks = style.overlay.velocity = true;
      const Moment moment{359.9, 89, {}, {}, past};
      Scene gone = scene;
      gone.frame.x[0] = 10;
      EXPECT_GT(changed(picture(scene, style, moment), picture(gone, style, moment)).area, 5) << width << "x" << height;
    }
  }
}

// Each overlay of the mean alone: the middle of what it changes, in the mill [m].
TEST(Renderer, DrawsTheMeanWhereItLies) {
  struct Case {
    bool Overlay::*shown;
    double x, y, within;
  };
  const double rim = 0.2725 * 1.12, degree = kPi / 180;
  const Case cases[] = {
      {&Overlay::occupancy, 0.06, -0.1, 0.02},
      {&Overlay::streamlines, 0.06, -0.1, 0.02},
      {&Overlay::mean_velocity, 0.06, -0.1, 0.02},
      {&Overlay::surface, 0, 0.05, 0.004},
      {&Overlay::circulation, 0.06, -0.1, 0.03},  // its name stands to the right
      {&Overlay::departure, rim * std::cos(70 * degree), rim * std::sin(70 * degree), 0.03},
      {&Overlay::impact, rim * std::cos(200 * degree), rim * std::sin(200 * degree), 0.03},
  };
  for (const bool mirror : {false, true}) {
    const Scene scene = scene_of(paper_mill(), 0);
    Style style;
    style.mirror = mirror;
    style.overlay = {};
    style.overlay.text = false;
    Renderer bare(scene.setup, style);
    bare.set_mean(mean_motion());
    const Image without = bare.draw(scene.frame, {});
    const double scale = 302.4 / 0.2725;
    for (const Case& c : cases) {
      Style with = style;
      with.overlay.*c.shown = true;
      Renderer renderer(scene.setup, with);
      EXPECT_EQ(largest_difference(renderer.draw(scene.frame, {}), without), 0);  // nothing is known yet
      renderer.set_mean(mean_motion());
      const Blob blob = changed(renderer.draw(scene.frame, {}), without);
      EXPECT_NEAR((mirror ? -1 : 1) * (blob.u - 639.5) / scale, c.x, c.within) << &c - cases;
      EXPECT_NEAR((359.5 - blob.v) / scale, c.y, c.within) << &c - cases;
    }
    Style head = style;
    head.overlay.head = true;
    Renderer renderer(scene.setup, head);
    renderer.set_mean(mean_motion());
    const Image image = renderer.draw(scene.frame, {});
    const auto v = static_cast<int>(std::lround(359.5 - 0.15 * scale));
    int dashes = 0;
    for (int u = 420; u < 860; ++u) dashes += difference(image, without, v, u) > 60;
    EXPECT_NEAR(dashes, 215, 40);  // half of the mill's width there
  }
}

TEST(Renderer, DrawsForcesBetweenTheBallsThatPress) {
  Scene scene = scene_of(paper_mill(), 3);
  scene.frame.x = {-0.1, 0.1, 0.1};
  scene.frame.y = {0, 0, -0.15};
  Style style;
  style.overlay.chains = true;
  Renderer renderer(scene.setup, style);
  renderer.set_force_scale(100);
  const Image none = renderer.draw(scene.frame, {});
  const auto with = [&](double force) {
    const ContactForce contacts[] = {{0, 1, 0, 0, force}};
    Moment moment;
    moment.contacts = contacts;
    return changed(renderer.draw(scene.frame, moment), none);
  };
  const double scale = 302.4 / 0.2725;
  const Blob strong = with(100), weak = with(30);
  EXPECT_NEAR(strong.u, 399.5, 1);  // midway between the two
  EXPECT_NEAR(strong.v, 359.5, 1);
  // As wide as the force, with an outline of 1 px on both sides and a pixel in which edges fade.
  EXPECT_NEAR(strong.area / (0.2 * scale), 7.5 + 3, 1.5);
  EXPECT_NEAR(weak.area / (0.2 * scale), 0.3 * 7.5 + 3, 1.5);
}

TEST(Renderer, ColoursBallsByWhatItIsTold) {
  Scene scene = scene_of(paper_mill(), 3);
  scene.frame.x = {-0.1, 0.1, 0};
  scene.frame.y = {0, 0, -0.15};
  for (const Colour colour : {Colour::kResidence, Colour::kForce}) {
    Style style;
    style.colour = colour;
    Renderer renderer(scene.setup, style);
    renderer.set_scale(0, 8);
    const auto red_of_second = [&](double value) {
      const double values[] = {4, value, 4};
      Moment moment;
      moment.of_ball = values;
      return renderer.draw(scene.frame, moment).row(352)[4 * 518];  // off its mark
    };
    EXPECT_GT(red_of_second(8), red_of_second(0) + 60);
    EXPECT_EQ(red_of_second(8), red_of_second(80));  // beyond the scale's end
  }
}

// Names of places that lie close make way for one another.
TEST(Renderer, KeepsLabelsApart) {
  const Scene scene = scene_of(paper_mill(), 0);
  Style style;
  style.overlay.impact = true;
  Renderer renderer(scene.setup, style);
  const Image none = renderer.draw(scene.frame, {});
  ChargeMotion motion;
  motion.impact_toe_deg.value = 208;
  renderer.set_mean(motion);
  const Image impact = renderer.draw(scene.frame, {});
  const auto covered_by_toe = [&](double toe_deg) {
    const Image both = renderer.draw(scene.frame, {toe_deg, kNotGiven, {}, {}, {}});
    EXPECT_GT(changed(both, impact, 30).area, 100);
    int covered = 0;
    for (int v = 0; v < none.height; ++v)
      for (int u = 0; u < none.width; ++u)
        covered += difference(impact, none, v, u) > 30 && difference(both, impact, v, u) > 30;
    return covered;
  };
  for (const double toe_deg : {204, 206, 210, 213}) EXPECT_EQ(covered_by_toe(toe_deg), 0) << toe_deg;
}

TEST(Renderer, RefusesPicturesThatNoFilmCanHold) {
  const Scene scene = scene_of(paper_mill(), 1);
  Style odd;
  odd.width = 1281;
  EXPECT_THROW(picture(scene, odd), InputError);
  Style huge;
  huge.height = 100000;
  EXPECT_THROW(picture(scene, huge), InputError);
  Style frozen;
  frozen.slow = 0;
  EXPECT_THROW(picture(scene, frozen), InputError);
}

}  // namespace
}  // namespace tumble::render
