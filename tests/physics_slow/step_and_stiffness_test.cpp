#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "analysis/charge_motion.h"
#include "sim/simulator.h"
#include "tests/support/mills.h"

namespace tumble {
namespace {

struct Means {
  double mean[3] = {}, se[3] = {};  // torque, toe and shoulder (bulk) over the packings, standard errors of the means
};
constexpr const char* kNames[3] = {"torque", "toe_bulk", "shoulder_bulk"};
constexpr int kPackings = 5;

// The mean over packings, with the standard error that their scatter gives: averages of chaos have no other.
Means over_packings(Config config) {
  double sum[3] = {}, squares[3] = {};
  for (int seed = 1; seed <= kPackings; ++seed) {
    config.run.seed = std::uint64_t(seed);
    std::optional<analysis::FrameMeasurer> measurer;
    sim::RunSink sink;
    sink.setup = [&](const RunSetup& setup) { measurer.emplace(setup); };
    sink.frame = [&](const Frame& frame) { measurer->add(frame); };
    sim::simulate(config, sink);
    const ChargeMotion motion = measurer->finish();
    const double seen[3] = {motion.torque.value, motion.toe_bulk_deg.value, motion.shoulder_bulk_deg.value};
    for (int q = 0; q < 3; ++q) {
      sum[q] += seen[q];
      squares[q] += seen[q] * seen[q];
    }
  }
  Means means;
  for (int q = 0; q < 3; ++q) {
    means.mean[q] = sum[q] / kPackings;
    const double variance = (squares[q] - sum[q] * sum[q] / kPackings) / (kPackings - 1);
    means.se[q] = std::sqrt(variance / kPackings);
  }
  return means;
}

// A change of the mean must be below the error of one run, as far as this many packings can tell.
void expect_same(const Means& a, const Means& b, const char* what) {
  for (int q = 0; q < 3; ++q) {
    const double one_run = a.se[q] * std::sqrt(double(kPackings)), se = std::hypot(a.se[q], b.se[q]);
    EXPECT_LT(std::abs(b.mean[q] - a.mean[q]), one_run + 2 * se) << what << ": " << kNames[q] << " " << a.mean[q];
    std::printf("%s: %s %.3f -> %.3f, %.2f standard errors (%.3f), one run %.3f\n", what, kNames[q], a.mean[q],
                b.mean[q], (b.mean[q] - a.mean[q]) / se, se, one_run);
  }
}

// A mill whose lifters hold no balls. What the step or the stiffness change must drown in what the packing changes.
TEST(StepAndStiffness, ChangeNoMean) {
  Config config = paper_mill();
  config.mill.lifters.count = 12;
  config.contact.friction = 0.2;
  config.run.spin_up = 3;
  config.run.revolutions = 8;
  config.run.frames_per_second = 100;
  const Means plain = over_packings(config);
  Config half = config;
  half.run.time_step = 2.15e-5;
  expect_same(plain, over_packings(half), "half the step");
  Config stiff = config;
  stiff.contact.normal_stiffness *= 2;
  stiff.contact.tangential_stiffness *= 2;
  expect_same(plain, over_packings(stiff), "twice the stiffness");
}

}  // namespace
}  // namespace tumble
