#include "diagnose/calibrate.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/error.h"
#include "diagnose/campaign.h"
#include "tests/support/small_mill.h"

namespace tumble::diagnose {
namespace {

constexpr double kTruth = 0.25;

Config mill_of(const Experiment& e, const std::vector<double>& values, std::uint64_t seed) {
  Config c = small_mill();
  c.mill.speed = std::stod(e.sets.at(0).second);
  c.contact.friction = values.at(0);
  c.run.seed = seed;
  return c;
}

std::vector<RunOutcome> run_all(const std::vector<Config>& configs) {
  return run_campaign(configs.size(), [&](std::size_t i) { return configs[i]; });
}

// What the mill itself gives with the true friction and packings that the fit does not see: means of four runs.
CalibrationRequest made_up() {
  CalibrationRequest request;
  request.keys = {{"contact.friction", 0.05, 0.6}};
  request.simulations = 36;
  request.repeats = 2;
  for (const char* speed : {"0.5", "0.7", "0.9"}) {
    Experiment e;
    e.name = speed;
    e.sets = {{"mill.speed", speed}};
    std::vector<Config> configs;
    for (std::uint64_t seed = 0; seed < 4; ++seed) configs.push_back(mill_of(e, {kTruth}, 5'000'000'000 + seed));
    std::vector<Estimate> power, toe;
    for (const RunOutcome& run : run_all(configs)) {
      power.push_back(quantity_of(run, kScalarData[0]));
      toe.push_back(quantity_of(run, kScalarData[2]));
    }
    e.power = {mean_of_repeats(power).value, se_within_repeats(power)};
    e.toe_deg = {mean_of_repeats(toe, true).value, se_within_repeats(toe)};
    request.experiments.push_back(e);
  }
  return request;
}

TEST(Calibrate, RecoversFrictionFromRunsWithOtherPackings) {
  const Calibration c = calibrate(made_up(), mill_of, run_all);
  const Estimate friction = c.keys.at(0).value;
  EXPECT_LT(friction.se, 0.1);
  EXPECT_NEAR(friction.value, kTruth, 3 * friction.se);
  EXPECT_LT(c.fitted.rms_relative_error, 0.1);
  EXPECT_EQ(c.runs.size(), 36u);
  EXPECT_EQ(c.predictions.size(), 6u);
}

// Whatever a held-out experiment says, the fit does not move by a bit; its prediction is reported against it.
TEST(Calibrate, NeverUsesWhatIsHeldOut) {
  // Any smooth stand-in for the mill will do: what counts is who is asked for what.
  const RunAll stand_in = [](const std::vector<Config>& configs) {
    std::vector<RunOutcome> runs(configs.size());
    for (std::size_t i = 0; i < runs.size(); ++i) {
      const Config& c = configs[i];
      const double noise = 0.01 * double(c.run.seed % 7) - 0.03;
      runs[i].power = {10 * c.mill.speed * (1 + std::sqrt(c.contact.friction)) + noise, 0.02};
      runs[i].slices = 1;
    }
    return runs;
  };
  CalibrationRequest request;
  request.keys = {{"contact.friction", 0.05, 0.6}};
  request.simulations = 30;
  request.repeats = 2;
  for (const char* speed : {"0.5", "0.7", "0.9"}) {
    Experiment e;
    e.name = speed;
    e.sets = {{"mill.speed", speed}};
    e.power = {10 * std::stod(speed) * 1.5, 0.05};
    request.experiments.push_back(e);
  }
  request.experiments[1].hold_out = true;
  const Calibration before = calibrate(request, mill_of, stand_in);
  request.experiments[1].power = {1000, 1};
  const Calibration after = calibrate(request, mill_of, stand_in);
  EXPECT_EQ(before.keys[0].value.value, after.keys[0].value.value);
  EXPECT_EQ(before.keys[0].value.se, after.keys[0].value.se);
  EXPECT_EQ(before.chi2, after.chi2);
  EXPECT_NEAR(before.keys[0].value.value, 0.25, 3 * before.keys[0].value.se);
  EXPECT_LT(before.held_out.rms_relative_error, 0.02);
  EXPECT_GT(after.held_out.rms_relative_error, 0.9);
  EXPECT_EQ(after.fitted.rms_relative_error, before.fitted.rms_relative_error);

  request.experiments[2].power = {1000, 1};  // while one that is fitted does move it
  EXPECT_NE(calibrate(request, mill_of, stand_in).keys[0].value.value, before.keys[0].value.value);
}

}  // namespace
}  // namespace tumble::diagnose
