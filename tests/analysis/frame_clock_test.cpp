#include "analysis/frame_clock.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <set>

#include "core/angle.h"
#include "tests/analysis/falling_balls.h"

namespace tumble::analysis {
namespace {

struct Film {
  double turn_deg = 2;                 // of the drum a frame
  double sigma_deg = 0.1;              // of its angle
  double ripple = 0.03, drift = 0.05;  // of the speed: once a turn, over the film
  int frames = 300, duplicates = 8, drops = 10;
  bool pictures = true;
};

struct Truth {
  std::vector<int> source, duplicated, dropped_after;
};

// A film with frames of the camera repeated and left out; differences as H.264 leaves them.
Truth make_film(const Film& film, std::uint64_t seed, std::vector<double>& difference, std::vector<double>& angle) {
  Random random(seed);
  std::set<int> repeat, gap;
  const auto pick = [&] { return 3 + static_cast<int>(random.below(static_cast<std::uint64_t>(film.frames) - 6)); };
  while (static_cast<int>(repeat.size()) < film.duplicates) repeat.insert(pick());
  while (static_cast<int>(gap.size()) < film.drops)
    if (const int i = pick(); !repeat.contains(i)) gap.insert(i);
  Truth truth;
  int source = 0;
  for (int i = 0; i < film.frames; ++i) {
    int step = i == 0 ? 0 : repeat.contains(i) ? 0 : gap.contains(i) ? 2 : 1;
    if (i > 0 && step == 0) truth.duplicated.push_back(i);
    if (step == 2) truth.dropped_after.push_back(i - 1);
    source += step;
    truth.source.push_back(source);
    const double turned = film.turn_deg * source * (1 + 0.5 * film.drift * source / film.frames);
    angle.push_back(radians(turned) + film.ripple * std::sin(radians(turned)) +
                    radians(film.sigma_deg) * gaussian(random));
    const double moved = 1 - std::exp(-0.3 * film.turn_deg * step);  // no more than all of the picture can change
    difference.push_back(i == 0 ? kNotGiven : (0.3 + 14 * moved) * std::exp(0.06 * gaussian(random)));
  }
  if (!film.pictures) difference.clear();
  return truth;
}

std::vector<int> places_of(const std::vector<DroppedFrames>& dropped) {
  std::vector<int> after;
  for (const DroppedFrames& d : dropped) after.push_back(d.after);
  return after;
}

FrameClock clock_of(const std::vector<double>& difference, const std::vector<double>& angle) {
  FrameEvidence evidence;
  evidence.difference = difference;
  evidence.angle = angle;
  return find_frame_clock(evidence);
}

struct Speed {
  double turn_deg, sigma_deg;
};

class FrameClocks : public ::testing::TestWithParam<Speed> {};

TEST_P(FrameClocks, FindAllAndInventNone) {
  Film film;
  film.turn_deg = GetParam().turn_deg;
  film.sigma_deg = GetParam().sigma_deg;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    std::vector<double> difference, angle;
    const Truth truth = make_film(film, seed, difference, angle);
    const FrameClock clock = clock_of(difference, angle);
    EXPECT_EQ(clock.duplicated, truth.duplicated);
    EXPECT_EQ(places_of(clock.dropped), truth.dropped_after);
    EXPECT_EQ(clock.source, truth.source);
    EXPECT_TRUE(clock.drops_can_be_seen);
  }
}

INSTANTIATE_TEST_SUITE_P(Drums, FrameClocks,
                         ::testing::Values(Speed{0.3, 0.02}, Speed{1, 0.05}, Speed{1, 0.1}, Speed{2, 0.02},
                                           Speed{4, 0.2}, Speed{10, 0.02}, Speed{10, 0.2}));

TEST(FrameClock, AnEvenFilmHasNone) {
  for (const double turn : {0.3, 1.0, 3.0, 10.0})
    for (const double sigma : {0.02, 0.2}) {
      Film film;
      film.turn_deg = turn;
      film.sigma_deg = sigma;
      film.duplicates = film.drops = 0;
      for (std::uint64_t seed = 0; seed < 3; ++seed) {
        std::vector<double> difference, angle;
        make_film(film, seed, difference, angle);
        const FrameClock clock = clock_of(difference, angle);
        EXPECT_TRUE(clock.duplicated.empty() && clock.dropped.empty()) << turn << ' ' << sigma;
        EXPECT_EQ(clock.source.back(), film.frames - 1);
      }
    }
}

TEST(FrameClock, WithoutPicturesTheDrumTellsAndWithoutTheDrumThePictures) {
  Film film;
  film.pictures = false;
  std::vector<double> difference, angle;
  const Truth truth = make_film(film, 1, difference, angle);
  EXPECT_EQ(clock_of({}, angle).source, truth.source);

  film.pictures = true;
  const Truth seen = make_film(film, 2, difference = {}, angle = {});
  const FrameClock clock = clock_of(difference, {});
  EXPECT_EQ(clock.duplicated, seen.duplicated);
  EXPECT_TRUE(clock.dropped.empty());
  EXPECT_FALSE(clock.drops_can_be_seen);
}

TEST(FrameClock, HalfOfAllFramesMayBeRepeats) {
  std::vector<double> difference, angle;
  std::vector<int> repeats;
  Random random(4);
  for (int i = 0; i < 200; ++i) {  // 15 frames/s in a file of 30
    angle.push_back(radians(4.0 * (i / 2) + 0.05 * gaussian(random)));
    difference.push_back(i == 0 ? kNotGiven : i % 2 ? 0.4 : 9 + random.uniform());
    if (i % 2) repeats.push_back(i);
  }
  const FrameClock clock = clock_of(difference, angle);
  EXPECT_EQ(clock.duplicated, repeats);
  EXPECT_TRUE(clock.dropped.empty());
}

TEST(FrameClock, ACameraThatChangesItsRateLosesNothing) {
  for (const double change : {0.8, 1.25}) {  // 30 to 24 frames/s in poor light, and back
    std::vector<double> difference, angle;
    Random random(5);
    double turned = 0;
    for (int i = 0; i < 300; ++i) {
      const double step = (i > 150 ? 2 * change : 2.0) * (1 + 0.02 * gaussian(random));
      turned += step;
      angle.push_back(radians(turned + 0.05 * gaussian(random)));
      difference.push_back(i == 0 ? kNotGiven : 4 * step * std::exp(0.05 * gaussian(random)));
    }
    const FrameClock clock = clock_of(difference, angle);
    EXPECT_TRUE(clock.duplicated.empty() && clock.dropped.empty()) << change;
  }
}

// Angles that were read off a charge: it lags behind the drum and is caught up with, by about a frame's turn at a time.
// Pictures two frames apart differ by 40 % more, and not a single one does so from its neighbour but where one is
// missing.
TEST(FrameClock, AnglesDoNotAccuseFramesAgainstThePictures) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    Random random(seed);
    constexpr int kGap = 90;
    std::vector<double> difference{kNotGiven}, over_two{kNotGiven, kNotGiven}, angle{0};
    double lag = 0;
    for (int i = 1; i < 160; ++i) {
      const bool sure = i >= 70 && i < 110;
      lag = sure ? 0 : lag + 0.15 + 0.1 * random.uniform();
      double step = sure ? 1 : 0.8;
      if (lag > 1.2) step += lag, lag = 0;
      if (i == kGap) step += 1;
      angle.push_back(angle.back() + radians(1.5 * step + 0.03 * gaussian(random)));
      difference.push_back((i == kGap ? 14 : 10) * std::exp(0.03 * gaussian(random)));
      if (i > 1) over_two.push_back((i == kGap || i == kGap + 1 ? 17 : 14) * std::exp(0.03 * gaussian(random)));
    }
    angle[40] = angle[39];  // and once it stands
    difference[40] *= 0.9;
    FrameEvidence evidence;
    evidence.difference = difference;
    evidence.difference_over_two = over_two;
    evidence.angle = angle;
    const FrameClock clock = find_frame_clock(evidence);
    EXPECT_TRUE(clock.duplicated.empty()) << seed;
    EXPECT_EQ(places_of(clock.dropped), std::vector<int>{kGap - 1}) << seed;
  }
}

TEST(FrameClock, UnsteadyStepsAloneAreNoGap) {
  int invented = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random(seed);
    std::vector<double> angle{0};
    for (int i = 1; i < 160; ++i) {
      double step = 0.75 + 0.3 * gaussian(random);
      if (random.below(25) == 0) step += 0.9;
      angle.push_back(angle.back() + radians(1.5 * step));
    }
    invented += static_cast<int>(clock_of({}, angle).dropped.size());
  }
  EXPECT_LE(invented, 10);  // of 130 jumps
}

TEST(FrameClock, OneWildAngleIsNoGap) {
  Film film;
  film.duplicates = film.drops = 0;
  std::vector<double> difference, angle;
  make_film(film, 3, difference, angle);
  angle[100] += radians(20);
  angle[200] = kNotGiven;
  const FrameClock clock = clock_of(difference, angle);
  EXPECT_TRUE(clock.duplicated.empty() && clock.dropped.empty());
}

TEST(FrameClock, AnAngleThatSlipsToAndFroIsNoGap) {
  Film film;
  film.duplicates = film.drops = 0;
  std::vector<double> difference, angle;
  make_film(film, 3, difference, angle);
  for (std::size_t i = 100; i < angle.size(); ++i)
    if (i != 101) angle[i] += radians(film.turn_deg);  // one frame's turn on, back, and on again
  EXPECT_TRUE(clock_of(difference, angle).dropped.empty());
}

TEST(FrameClock, PictureDifferenceLooksInsideTheDrumAlone) {
  cv::Mat before(720, 1280, CV_8UC1, cv::Scalar(100)), now = before.clone();
  EXPECT_EQ(picture_difference(before, now, 640, 360, 300), 0);
  cv::circle(now, {640, 360}, 200, cv::Scalar(130), cv::FILLED);
  EXPECT_NEAR(picture_difference(before, now, 640, 360, 300), 30 * 4.0 / 9, 0.3);
  now.rowRange(0, 40) = cv::Scalar(0);  // above the drum
  EXPECT_NEAR(picture_difference(before, now, 640, 360, 300), 30 * 4.0 / 9, 0.3);
}

}  // namespace
}  // namespace tumble::analysis
