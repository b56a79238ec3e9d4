#include "sim/packing.h"

#include <gtest/gtest.h>

#include "sim/running_mill.h"
#include "tests/support/mills.h"

namespace tumble::sim {
namespace {

double largest_overlap(const MillModel& model, const Charge& c) {
  double worst = 0;
  for (std::size_t i = 0; i < c.size(); ++i) {
    worst = std::max(worst, std::hypot(c.x[i], c.y[i]) + c.radius[i] - model.shell.radius);
    for (std::size_t j = i + 1; j < c.size(); ++j)
      worst = std::max(worst, c.radius[i] + c.radius[j] - std::hypot(c.x[i] - c.x[j], c.y[i] - c.y[j]));
    for (int f = 1; f < feature_count(model.shell); ++f)
      worst = std::max(worst, c.radius[i] - nearest_on_wall(model.shell, {}, f, c.x[i], c.y[i]).distance);
  }
  return worst;
}

TEST(Packing, StartsLooseAndSettlesLow) {
  for (const double filling : {0.05, 0.385, 0.75}) {
    Config config = paper_mill();
    config.charge.count.reset();
    config.charge.filling = filling;
    const MillModel model = make_mill_model(config);
    const Charge loose = place_loosely(config, model, draw_balls(config));
    EXPECT_LE(largest_overlap(model, loose), 1e-6) << filling;

    const Charge settled = settle(model, loose, {});
    EXPECT_LT(largest_overlap(model, settled), 1e-3) << filling << ": springs give way a little under weight";
    double before = 0, after = 0;
    for (std::size_t i = 0; i < loose.size(); ++i) {
      before += loose.mass[i] * loose.y[i];
      after += settled.mass[i] * settled.y[i];
    }
    EXPECT_LT(after, before) << filling;
  }
}

TEST(Packing, ClassesAreShuffledAndCounted) {
  const Config config = paper_mill();
  const Balls balls = draw_balls(config);
  const std::vector<int> counts = class_counts(config);
  for (std::size_t k = 0; k < counts.size(); ++k)
    EXPECT_EQ(std::count(balls.radius.begin(), balls.radius.end(), config.charge.balls[k].radius), counts[k]);
  EXPECT_FALSE(std::is_sorted(balls.radius.begin(), balls.radius.end()));
}

}  // namespace
}  // namespace tumble::sim
