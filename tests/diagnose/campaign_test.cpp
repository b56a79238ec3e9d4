#include "diagnose/campaign.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <set>

#include "core/error.h"
#include "core/parallel_for.h"
#include "core/units.h"
#include "tests/support/small_mill.h"

namespace tumble::diagnose {
namespace {

Config run_of(std::size_t i) {
  Config c = small_mill();
  c.run.spin_up = 0.2;
  c.run.revolutions = 0.5;
  c.mill.speed = 0.4 + 0.1 * double(i % 5);
  c.run.seed = i;
  return c;
}

std::vector<std::uint64_t> bits_of(const std::vector<RunOutcome>& runs) {
  std::vector<std::uint64_t> bits;
  for (const RunOutcome& run : runs) {
    for (const Estimate& e : run.motion) {
      bits.push_back(std::bit_cast<std::uint64_t>(e.value));
      bits.push_back(std::bit_cast<std::uint64_t>(e.se));
    }
    bits.push_back(std::bit_cast<std::uint64_t>(run.power.value));
    bits.push_back(std::bit_cast<std::uint64_t>(run.energy_error));
  }
  return bits;
}

TEST(Campaign, SameBitsForAnyNumberOfThreads) {
  limit_threads(1);
  const auto alone = run_campaign(6, run_of);
  limit_threads(4);
  const auto together = run_campaign(6, run_of);
  limit_threads(0);
  EXPECT_EQ(bits_of(alone), bits_of(together));
  std::set<double> torques;
  for (const RunOutcome& run : alone) torques.insert(torque_of(run).value);
  EXPECT_EQ(torques.size(), 6u);
}

// The run's own power and torque agree, and the balances hold: the outcome is of the run it says.
TEST(Campaign, OutcomeIsOfItsRun) {
  Config c = small_mill();
  c.mill.slices = 3;
  const RunOutcome run = run_once(c);
  ASSERT_EQ(run.error, "");
  EXPECT_EQ(run.slices, 3);
  const double omega = rad_s_from_rpm(speed_rpm(c.mill));
  EXPECT_NEAR(run.power.value, torque_of(run).value * omega, 1e-9 * run.power.value);
  EXPECT_LT(std::abs(run.energy_error), 1e-3);
  const Estimate& closure = run.motion[motion_index("torque_closure_N_m")];
  EXPECT_NEAR(closure.value, torque_of(run).value, 0.15 * closure.value);
  EXPECT_EQ(run.motion[motion_index("speed_fraction")].value, 0.6);
}

TEST(Campaign, OneFailedRunDoesNotStopTheOthers) {
  const auto runs = run_campaign(4, [](std::size_t i) {
    Config c = run_of(i);
    if (i == 1) c.run.time_step = 1;  // unstable
    return c;
  });
  for (std::size_t i = 0; i < runs.size(); ++i) EXPECT_EQ(runs[i].error.empty(), i != 1);
  EXPECT_NE(runs[1].error.find("time_step"), std::string::npos) << runs[1].error;
}

TEST(Campaign, RunsNothingThatIsKnownAndLeavesWhenAsked) {
  std::vector<std::size_t> finished;
  CampaignSink sink;
  sink.known = [](std::size_t run, RunOutcome& outcome) {
    outcome.slices = 77;
    return run != 2;
  };
  sink.finished = [&](std::size_t run, const Config&, const RunOutcome&) { finished.push_back(run); };
  double last = 0;
  sink.progress = [&](double done) { last = done; };
  const auto runs = run_campaign(4, run_of, sink);
  EXPECT_EQ(finished, std::vector<std::size_t>{2});
  EXPECT_EQ(runs[0].slices, 77);
  EXPECT_EQ(runs[2].slices, 1);
  EXPECT_NEAR(last, 1, 1e-9);

  sink = {};
  sink.progress = [](double) { throw Interrupted("enough"); };
  EXPECT_THROW(run_campaign(4, run_of, sink), Interrupted);
}

}  // namespace
}  // namespace tumble::diagnose
