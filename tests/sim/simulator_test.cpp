#include "sim/simulator.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include "core/error.h"
#include "core/parallel_for.h"
#include "core/units.h"
#include "tests/support/checkpoints.h"
#include "tests/support/mills.h"

namespace tumble::sim {
namespace {

using testing::HasSubstr;

Config short_run() {
  Config config = paper_mill();
  config.run.spin_up = 0.5;
  config.run.revolutions = 0.5;
  return config;
}

struct Seen {
  RunSetup setup;
  std::vector<Frame> frames;
  RunResult result;
};

Seen run(const Config& config, std::optional<StoredCheckpoint> resume = {}) {
  Seen seen;
  RunSink sink;
  sink.setup = [&](const RunSetup& s) { seen.setup = s; };
  sink.frame = [&](const Frame& f) { seen.frames.push_back(f); };
  seen.result = simulate(config, sink, std::move(resume));
  return seen;
}

void expect_same_bits(const Frame& a, const Frame& b) {
  EXPECT_EQ(a.step, b.step);
  EXPECT_EQ(a.x, b.x);
  EXPECT_EQ(a.y, b.y);
  EXPECT_EQ(a.vx, b.vx);
  EXPECT_EQ(a.vy, b.vy);
  EXPECT_EQ(a.angle, b.angle);
  EXPECT_EQ(a.spin, b.spin);
  EXPECT_EQ(a.observed.torque, b.observed.torque);
  EXPECT_EQ(a.observed.drive_work, b.observed.drive_work);
  EXPECT_EQ(a.observed.dissipation, b.observed.dissipation);
}

std::string message_of(const Config& config) {
  try {
    run(config);
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

TEST(Simulator, WritesTheFramesItPromised) {
  const Seen seen = run(short_run());
  const double omega = 0.7 * std::sqrt(kGravity / 0.2725);
  EXPECT_DOUBLE_EQ(seen.setup.mill_speed, omega);
  EXPECT_EQ(seen.setup.frame_count, std::llround(0.5 * 2 * kPi / omega * 200));
  ASSERT_EQ(seen.frames.size(), std::size_t(seen.setup.frame_count));
  EXPECT_EQ(seen.setup.balls.size(), 112u);
  EXPECT_EQ(seen.setup.dissipation_causes.size(), seen.frames[0].observed.dissipation.size());
  for (std::size_t k = 0; k < seen.frames.size(); ++k) {
    const Frame& f = seen.frames[k];
    EXPECT_NEAR(f.time, double(k) / 200, 1e-12);
    EXPECT_NEAR(f.mill_angle, omega * double(f.step) * seen.setup.time_step, 1e-9);
    EXPECT_NEAR(f.observed.power, f.observed.torque * omega, 1e-9);
  }
  EXPECT_NEAR(seen.result.spin_up_revolutions, 0.5, 1e-3);
}

TEST(Simulator, TorqueSeriesAddsUpToTheDriveWork) {
  const Seen seen = run(short_run());
  double work = 0;
  for (std::size_t k = 1; k < seen.frames.size(); ++k) work += seen.frames[k].observed.power / 200;
  EXPECT_NEAR(work, seen.frames.back().observed.drive_work - seen.frames.front().observed.drive_work, 1e-9);
}

// Number times energy of the impacts is the power dissipated: bins, edges and rates belong together. Bins are a third
// wide, and contacts that outlast the run are not counted.
TEST(Simulator, ImpactSpectrumHoldsTheDissipation) {
  const Seen seen = run(short_run());
  const ImpactSpectrum& spectrum = seen.result.spectrum;
  ASSERT_EQ(spectrum.edges_J.size(), spectrum.ball_ball.size() + 1);
  const auto power = [&](const std::vector<double>& rates) {
    double sum = 0;
    for (std::size_t b = 0; b < rates.size(); ++b)
      sum += rates[b] * std::sqrt(spectrum.edges_J[b] * spectrum.edges_J[b + 1]);
    return sum;
  };
  const auto &first = seen.frames.front(), &last = seen.frames.back();
  const auto dissipated = [&](std::size_t cause) {
    return (last.observed.dissipation[cause] - first.observed.dissipation[cause]) / (last.time - first.time);
  };
  EXPECT_NEAR(power(spectrum.ball_ball) / (dissipated(0) + dissipated(1)), 1, 0.2);
  EXPECT_NEAR(power(spectrum.ball_wall) / (dissipated(2) + dissipated(3)), 1, 0.2);
}

TEST(Simulator, SameSeedSameBitsForAnyNumberOfThreads) {
  limit_threads(1);
  const Seen one = run(short_run());
  limit_threads(2);
  const Seen two = run(short_run());
  limit_threads(0);
  expect_same_bits(one.frames.back(), two.frames.back());

  Config other = short_run();
  other.run.seed = 2;
  EXPECT_NE(run(other).frames.back().x, one.frames.back().x);
}

// Every checkpoint of a run, in spin-up or after a frame, leads to the same bits.
TEST(Simulator, ResumedRunGoesOnWithTheSameBits) {
  Config config = short_run();
  config.run.spin_up = 0.1;
  config.run.revolutions = 0.1;
  const Seen whole = run(config);
  for (const int wait_at : {0, 15}) {
    std::vector<KeptCheckpoint> checkpoints;
    int frames = 0;
    bool waited = false, settled = false;
    RunSink sink;
    sink.setup = [&](const RunSetup&) { settled = true; };
    const auto wait = [&] {  // checkpoints come by wall time
      if (waited || frames != wait_at) return;
      std::this_thread::sleep_for(std::chrono::milliseconds(2100));
      waited = true;
    };
    sink.frame = [&](const Frame&) {
      ++frames;
      wait();
    };
    sink.progress = [&](double) {
      if (settled) wait();
    };
    sink.checkpoint = [&](const Checkpoint& c) { checkpoints.push_back(keep(c)); };
    simulate(config, sink);
    // A slow machine may give more of them.
    const auto at = std::find_if(checkpoints.begin(), checkpoints.end(),
                                 [&](const KeptCheckpoint& c) { return c.frames_written == wait_at; });
    ASSERT_NE(at, checkpoints.end());
    EXPECT_LE(at->words.size(), checkpoint_capacity(config));

    const Seen rest = run(config, stored(*at));
    ASSERT_EQ(rest.frames.size(), whole.frames.size() - std::size_t(wait_at));
    expect_same_bits(rest.frames.front(), whole.frames[std::size_t(wait_at)]);
    expect_same_bits(rest.frames.back(), whole.frames.back());
    EXPECT_EQ(rest.result.spectrum.ball_wall, whole.result.spectrum.ball_wall);
    EXPECT_EQ(rest.setup.balls.radius, whole.setup.balls.radius);
  }
}

TEST(Simulator, TellsItsProgressFromTheSettlingOn) {
  Config config = short_run();
  config.run.spin_up = 0.1;
  config.run.revolutions = 0.1;
  double last = 0, settled_at = 0;
  RunSink sink;
  sink.setup = [&](const RunSetup&) { settled_at = last; };
  sink.progress = [&](double done) {
    EXPECT_GE(done, last);
    last = done;
  };
  const RunResult result = simulate(config, sink);
  EXPECT_GT(settled_at, 0);
  EXPECT_LT(settled_at, 1);
  EXPECT_NEAR(last, 1, 0.01);
  EXPECT_FALSE(result.steady) << "a tenth of a revolution cannot tell";
}

TEST(Simulator, RefusesATimeStepThatIsNotStable) {
  Config config = short_run();
  config.run.time_step = 1e-3;
  config.origin["run.time_step"] = "mill.toml:30";
  EXPECT_THROW(run(config), InputError);
  const std::string message = message_of(config);
  EXPECT_THAT(message, HasSubstr("mill.toml:30: run.time_step"));
  EXPECT_THAT(message, HasSubstr("0.001"));
  EXPECT_THAT(message, HasSubstr("at most"));
}

TEST(Simulator, RefusesATimeStepThatWouldNeverEnd) {
  Config config = short_run();
  config.run.time_step = 1e-300;
  EXPECT_THAT(message_of(config), HasSubstr("run.time_step: 1e-300 s makes"));
}

// The step that the paper prints is allowed, and energy still balances there: the limit is on the safe side.
TEST(Simulator, TakesThePapersTimeStep) {
  Config config = short_run();
  config.run.time_step = 1e-4;
  const Seen seen = run(config);
  EXPECT_DOUBLE_EQ(seen.setup.time_step, 1e-4);
  EXPECT_LT(seen.frames.back().observed.kinetic, 10);
}

TEST(Simulator, RefusesAChargeThatDoesNotFit) {
  Config config = short_run();
  config.charge.count = 260;  // a quarter more area than the mill has between its lifters
  EXPECT_THROW(run(config), InputError);
  EXPECT_THAT(message_of(config), HasSubstr("charge.count"));
}

TEST(Simulator, SaysWhenARunLeavesPhysics) {
  Config config = short_run();
  config.contact.normal_stiffness =
      150;  // a ball's weight presses it in by 4 mm, a few on top by more than half a radius
  EXPECT_THROW(run(config), WorkError);
  const std::string message = message_of(config);
  EXPECT_THAT(message, HasSubstr("step"));
  EXPECT_THAT(message, HasSubstr("ball"));
  EXPECT_THAT(message, HasSubstr("run.time_step"));
}

TEST(Simulator, RunsOneBallAndAFullMill) {
  Config config = short_run();
  config.charge.count = 1;
  EXPECT_EQ(run(config).frames.back().x.size(), 1u);
  config.charge.count.reset();
  config.charge.filling = 0.7;
  EXPECT_GT(run(config).frames.back().x.size(), 150u);
}

}  // namespace
}  // namespace tumble::sim
