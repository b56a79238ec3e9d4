#include "core/slow_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/units.h"
#include "sim/simulator.h"
#include "tests/support/mills.h"

// Slow motion from sparse frames beside the same mill stored finely.
namespace tumble::sim {
namespace {

struct Stored {
  Balls balls;
  std::vector<Frame> frames;
};

const Stored& fine_run() {
  static const Stored run = [] {
    Config config = paper_mill();
    config.run.spin_up = 0.6;
    config.run.revolutions = 0.3;
    config.run.frames_per_second = 3200;
    Stored made;
    RunSink sink;
    sink.setup = [&](const RunSetup& s) { made.balls = s.balls; };
    sink.frame = [&](const Frame& f) { made.frames.push_back(f); };
    simulate(config, sink);
    return made;
  }();
  return run;
}

double speed_change(double before_x, double before_y, double after_x, double after_y, double seconds) {
  return std::hypot(after_x - before_x, after_y - before_y + kGravity * seconds);  // by anything but gravity
}

// Hermite's cubic is exact for a parabola. A kick that changes the velocity by dv puts it wrong by at most 4/27 h dv
// (the largest value of the cubic's kernel), and so kicks of any kind by 4/27 h times the sum of their sizes. The sum
// is taken over the fine frames; what cancels within one of them moves a ball by less than the tenth that is allowed on
// top.
TEST(SlowMotion, IsExactInFlightAndBoundedByTheKicksElsewhere) {
  const Stored& run = fine_run();
  constexpr std::size_t kEvery = 16;  // 200 frames/s
  int flights = 0, kicked = 0;
  for (std::size_t i = 0; i + kEvery < run.frames.size(); i += kEvery) {
    const Frame &a = run.frames[i], &b = run.frames[i + kEvery];
    const double h = b.time - a.time;
    std::vector<Frame> made;
    for (std::size_t k = 1; k < kEvery; ++k) made.push_back(between(a, b, run.frames[i + k].time));
    for (std::size_t ball = 0; ball < run.balls.size(); ++ball) {
      double kicks = 0, error = 0, turned = 0;
      for (std::size_t k = 0; k < kEvery; ++k) {
        const Frame &p = run.frames[i + k], &q = run.frames[i + k + 1];
        kicks += speed_change(p.vx[ball], p.vy[ball], q.vx[ball], q.vy[ball], q.time - p.time);
        if (k == 0) continue;
        error = std::max(error, std::hypot(made[k - 1].x[ball] - p.x[ball], made[k - 1].y[ball] - p.y[ball]));
        turned = std::max(turned, std::abs(made[k - 1].angle[ball] - p.angle[ball]));
      }
      if (kicks < 1e-9) {
        ++flights;
        EXPECT_LT(error, 1e-9);
        EXPECT_LT(turned, 1e-9);
      } else {
        ++kicked;
        EXPECT_LT(error, 1.1 * 4.0 / 27.0 * h * kicks + 2e-6);
      }
    }
  }
  EXPECT_GT(flights, 200);
  EXPECT_GT(kicked, 2000);
}

TEST(SlowMotion, OfSparseFramesIsNearerToTheTruthWithBallsPushedApart) {
  const Stored& run = fine_run();
  constexpr std::size_t kEvery = 128;  // 25 frames/s
  double squares = 0, plain_squares = 0, deepest = 0, plain_deepest = 0;
  const auto depth = [&](const Frame& f) {
    double most = 0;
    for (std::size_t i = 0; i < f.x.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        const double r = run.balls.radius[i], s = run.balls.radius[j];
        most = std::max(most, (r + s - std::hypot(f.x[i] - f.x[j], f.y[i] - f.y[j])) / std::min(r, s));
      }
    return most;
  };
  for (std::size_t i = 0; i + kEvery < run.frames.size(); i += kEvery) {
    for (std::size_t k = 16; k < kEvery; k += 16) {
      const Frame& truth = run.frames[i + k];
      const Frame f = slow_motion(run.frames[i], run.frames[i + kEvery], run.balls, truth.time);
      const Frame plain = between(run.frames[i], run.frames[i + kEvery], truth.time);
      deepest = std::max(deepest, depth(f));
      plain_deepest = std::max(plain_deepest, depth(plain));
      for (std::size_t b = 0; b < f.x.size(); ++b) {
        squares += std::pow(f.x[b] - truth.x[b], 2) + std::pow(f.y[b] - truth.y[b], 2);
        plain_squares += std::pow(plain.x[b] - truth.x[b], 2) + std::pow(plain.y[b] - truth.y[b], 2);
      }
    }
  }
  EXPECT_LT(squares, plain_squares);
  EXPECT_GT(plain_deepest, 0.6);  // half through one another
  EXPECT_LT(deepest, 0.2);
}

}  // namespace
}  // namespace tumble::sim
