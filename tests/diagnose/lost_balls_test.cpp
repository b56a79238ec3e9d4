#include "diagnose/lost_balls.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/mill_shape.h"
#include "diagnose/free_flight.h"
#include "tests/diagnose/seen_mill.h"

namespace tumble::diagnose {
namespace {

// Every ball is away for one to ten frames now and then; away for longer than three, it has a new number.
std::vector<SeenFrame> some_lost(std::vector<SeenFrame> frames) {
  Random random(3);
  const std::size_t balls = frames.front().balls.size();
  std::vector<int> number(balls), away(balls, 0), left(balls, 0);
  int next = static_cast<int>(balls);
  for (std::size_t b = 0; b < balls; ++b) number[b] = static_cast<int>(b);
  for (SeenFrame& f : frames) {
    std::vector<Sighting> seen;
    for (std::size_t b = 0; b < balls; ++b) {
      if (left[b] == 0 && random.uniform() < 0.01) left[b] = 1 + static_cast<int>(random.below(10));
      if (left[b] > 0) {
        ++away[b];
        --left[b];
        continue;
      }
      if (away[b] > 3) number[b] = next++;
      away[b] = 0;
      seen.push_back(f.balls[b]);
      seen.back().ball = number[b];
    }
    std::sort(seen.begin(), seen.end(), [](const Sighting& a, const Sighting& b) { return a.ball < b.ball; });
    f.balls = std::move(seen);
  }
  return frames;
}

TEST(LostBalls, ArePutBackWhereTheyWere) {
  const Measurement m = measure(simulate_paper_mill(1.2), {}, 1);
  const std::vector<SeenFrame> mended = with_lost_balls(some_lost(m.frames));
  ASSERT_EQ(mended.size(), m.frames.size());
  double lost = 0, missing = 0, guessed = 0, near = 0;
  for (std::size_t f = 15; f + 15 < mended.size(); ++f) {
    missing += double(m.frames[f].balls.size()) - double(mended[f].balls.size());
    for (const Sighting& s : mended[f].balls) {
      if (!s.guessed) continue;
      double least = INFINITY;
      for (const Sighting& t : m.frames[f].balls) least = std::min(least, std::hypot(s.x - t.x, s.y - t.y));
      guessed += 1;
      near += least < 0.25 * s.radius;
    }
  }
  lost = guessed + missing;
  EXPECT_GT(lost, 1000);
  EXPECT_LT(missing, 0.12 * lost);
  EXPECT_GT(near, 0.93 * guessed);
}

// A ball that nobody sees still hits others: their paths are no free fall then.
TEST(LostBalls, MakeNeighboursFlyFreelyLessOften) {
  const SimulatedRun run = simulate_paper_mill(6);
  Errors none;
  none.noise = 0;
  const std::vector<SeenFrame> frames = some_lost(measure(run, none, 1).frames);
  const auto hit = [&](const std::vector<SeenFrame>& seen) {  // share of flights that gravity alone does not explain
    FreeFlights flights(make_mill_shape(run.setup.config).tip_radius);
    for (const SeenFrame& f : seen) flights.add(f.time, f.balls);
    double all = 0, wrong = 0;
    for (const FreeFall& w : flights.windows()) all += 1, wrong += std::hypot(w.ax, w.ay + kGravity) > 0.1;
    return wrong / all;
  };
  const double by_chance = hit(measure(run, none, 1).frames), before = hit(frames) - by_chance;
  EXPECT_GT(before, 0.01);
  EXPECT_LT(hit(with_lost_balls(frames)) - by_chance, 0.7 * before);
}

}  // namespace
}  // namespace tumble::diagnose
