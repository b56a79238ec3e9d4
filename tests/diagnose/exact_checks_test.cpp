#include "diagnose/exact_checks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "tests/diagnose/seen_mill.h"

namespace tumble::diagnose {
namespace {

using testing::Contains;
using testing::Not;

const SimulatedRun& plain() {
  static const SimulatedRun run = simulate_paper_mill(4);
  return run;
}

std::map<std::string, ExactCheck> by_name(const Measurement& m) {
  std::map<std::string, ExactCheck> checks;
  for (ExactCheck& c : exact_checks(m)) checks[c.name] = c;
  return checks;
}

// Errors of their own size: neither the check cries wolf nor does it sleep.
TEST(ExactChecks, AreQuietAndHonestWhereNothingIsHidden) {
  std::map<std::string, std::vector<double>> z;
  constexpr int kTimes = 6;
  for (int i = 0; i < kTimes; ++i)
    for (const ExactCheck& c : exact_checks(measure(plain(), {}, 100 + i))) {
      z[c.name].push_back(c.z);
      EXPECT_LT(std::abs(c.z), 4) << c.says;
      EXPECT_FALSE(c.is_clear() && c.moved_by.empty());
    }
  for (const char* name :
       {"mill_speed", "speed_ripple", "touching_balls", "shell_radius", "mill_centre_x", "ball_count", "ball_mix",
        "flight_gravity", "flight_down", "flight_drag", "flight_ends", "torque_closure"}) {
    ASSERT_EQ(z[name].size(), std::size_t{kTimes}) << name;
    double square = 0;
    for (const double one : z[name]) square += one * one / kTimes;
    EXPECT_LT(square, 2.8) << name;  // chi-square of 6 over 6: a chance of one in a hundred
  }
}

TEST(ExactChecks, TellHowFarAnArtefactGoes) {
  Errors e;
  e.scale = 0.012;
  e.rotation = 1.5 * kPi / 180;
  e.clock = -0.01;
  e.ripple = 0.04;
  e.lost = 0.03;
  Measurement m = measure(plain(), e, 7);
  m.config.charge.count = 116;
  const auto checks = by_name(m);
  const auto tells = [&](const char* check, const char* suspect, double strength) {
    ASSERT_TRUE(checks.contains(check)) << check;
    const ExactCheck& c = checks.at(check);
    EXPECT_NEAR(c.strength, strength, 3 * c.strength_se) << c.says;
    EXPECT_THAT(c.moved_by, Contains(testing::Field(&MovedBy::suspect, suspect)));
  };
  tells("touching_balls", "camera_scale", 0.012);
  tells("shell_radius", "camera_scale", 0.012);
  tells("flight_gravity", "camera_scale", 1.012 / (0.99 * 0.99) - 1);
  tells("flight_down", "camera_rotation", 1.5);
  tells("mill_speed", "speed_error", 1 / 0.99 - 1);
  tells("ball_count", "filling_error", 112.0 / 116 - 1);
  tells("speed_ripple", "speed_ripple", 0.04);
  EXPECT_TRUE(checks.at("touching_balls").is_clear());
  EXPECT_TRUE(checks.at("speed_ripple").is_clear());
  // What is seen by the clock alone is no contact law's doing.
  EXPECT_THAT(checks.at("mill_speed").excludes, Contains("rolling_resistance"));
  EXPECT_THAT(checks.at("mill_speed").excludes, Not(Contains("frame_clock")));
}

TEST(ExactChecks, TheTorqueHoldsTheChargesWeightAndNothingElse) {
  Errors e;
  e.torque_offset = 0.02;
  const auto off = by_name(measure(plain(), e, 3)).at("torque_closure");
  EXPECT_TRUE(off.is_clear()) << off.says;
  EXPECT_NEAR(off.strength, 0.02, 3 * off.strength_se);
  // Who says that the instrument errs as much is heard.
  Measurement rough_gauge = measure(plain(), e, 3);
  rough_gauge.torque_error = 0.02 * rough_gauge.torque.value;
  EXPECT_LT(std::abs(by_name(rough_gauge).at("torque_closure").z), 2);
  // Without the series, the mean torque's own error counts, in which all the charge's unrest is.
  Measurement mean_only = measure(plain(), {}, 4);
  mean_only.torque_series.clear();
  const auto rough = by_name(mean_only).at("torque_closure");
  EXPECT_LT(std::abs(rough.z), 3.5);
  EXPECT_GT(rough.se, 2 * off.se);
  // A contact law leaves it as it is.
  const auto rolling =
      by_name(measure(simulate_paper_mill(3, {{"rolling_resistance", {{"coefficient", {0.02}}}}}), {}, 5));
  EXPECT_LT(std::abs(rolling.at("torque_closure").z), 3.5);
  EXPECT_THAT(rolling.at("torque_closure").excludes, Contains("torque_offset"));
}

TEST(ExactChecks, FluidAndEndsAreToldApartInFlight) {
  const auto drag = by_name(measure(simulate_paper_mill(4, {{"fluid_drag", {{"viscosity", {0.088}}}}}), {}, 1));
  EXPECT_NEAR(drag.at("flight_drag").strength, 0.088, 3 * drag.at("flight_drag").strength_se);
  EXPECT_TRUE(drag.at("flight_drag").is_clear());
  EXPECT_FALSE(drag.at("flight_ends").is_clear());
  EXPECT_THAT(drag.at("flight_drag").excludes, Contains("end_wall_friction"));
  const auto ends = by_name(measure(simulate_paper_mill(4, {{"end_wall_friction", {{"coefficient", {0.05}}}}}), {}, 2));
  EXPECT_NEAR(ends.at("flight_ends").strength, 0.05, 3 * ends.at("flight_ends").strength_se);
  EXPECT_TRUE(ends.at("flight_ends").is_clear());
  EXPECT_FALSE(ends.at("flight_drag").is_clear());
}

TEST(ExactChecks, RippleHasItsOrderAndPhase) {
  Errors e;
  e.ripple = 0.03;
  const auto orders = ripple_orders(measure(plain(), e, 11));
  ASSERT_EQ(orders.size(), 36u);
  const RippleOrder& r = orders[6];
  EXPECT_EQ(r.order, 7);
  EXPECT_LT(r.p, 1e-6);
  EXPECT_NEAR(r.amplitude, 0.03, 3 * r.se);
  // The angle's wave is drawn against the mean angle here, so 0.03 sin(120 deg) ahead of the ripple's own start.
  EXPECT_NEAR(r.phase_deg, 120 - 0.03 * std::sin(2 * kPi / 3) * 180 / kPi, 3 * r.se / r.amplitude * 180 / kPi);
}

TEST(ExactChecks, SeeTheShellWhereverItIs) {
  Measurement m = measure(plain(), {}, 1);
  for (SeenFrame& f : m.frames)
    for (Sighting& s : f.balls) s.x += 0.002, s.y -= 0.001;
  const SeenShell shell = seen_shell(m);
  EXPECT_NEAR(shell.centre_x.value, 0.002, 3 * shell.centre_x.se);
  EXPECT_NEAR(shell.centre_y.value, -0.001, 3 * shell.centre_y.se);
}

}  // namespace
}  // namespace tumble::diagnose
