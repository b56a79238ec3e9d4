#include "analysis/time_base.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/units.h"

namespace tumble::analysis {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

TimeWitnesses film(double file_rate, Estimate falling) {
  TimeWitnesses w;
  w.file_rate = file_rate;
  w.falling_rate = falling;
  return w;
}

// A drum that turns at `rpm` when the film has `rate` frames/s, in a mill that is said to turn at `nominal`.
void add_drum(TimeWitnesses& w, double rpm, double rate, double nominal) {
  w.turn_per_frame = {rad_s_from_rpm(rpm) / rate, 1e-6};
  w.nominal_rpm = nominal;
}

TEST(TimeBase, TheFileIsKeptToTheLetterWhereFlightsAgree) {
  const TimeBase base = judge_time_base(film(29.97, {30.3, 0.3}));
  EXPECT_EQ(base.frames_per_second.value, 29.97);
  EXPECT_EQ(base.frames_per_second.se, 0);
  EXPECT_THAT(base.caveats, IsEmpty());
}

TEST(TimeBase, SlowMotionIsFoundAndTakenAsTheCamerasRate) {
  TimeWitnesses w = film(30, {118.6, 1.2});
  EXPECT_EQ(judge_time_base(w).frames_per_second.value, 120);
  EXPECT_THAT(judge_time_base(w).caveats,
              ElementsAre(HasSubstr("the file says 30 frames/s; balls in flight fall as at")));
  w.file_rate = 30000.0 / 1001;  // the same clock
  EXPECT_DOUBLE_EQ(judge_time_base(w).frames_per_second.value, 120000.0 / 1001);
}

TEST(TimeBase, NoCamerasRateIsPutInWhereTwoWouldDoOrNone) {
  EXPECT_EQ(judge_time_base(film(30, {110, 4})).frames_per_second.value, 110);  // 100 or 120
  EXPECT_EQ(judge_time_base(film(30, {317, 4})).frames_per_second.value, 317);
}

TEST(TimeBase, FlightsAndNominalSpeedArePutTogetherWhereTheyAgree) {
  TimeWitnesses w = film(kNotGiven, {317, 10});
  w.scale_error = 0;
  add_drum(w, 39, 325, 39);
  const TimeBase base = judge_time_base(w);
  EXPECT_GT(base.frames_per_second.value, 317);
  EXPECT_LT(base.frames_per_second.value, 325);
  EXPECT_LT(base.frames_per_second.se, 9.75);  // 3 % of 325

  add_drum(w, 39, 317, 60);  // the drawing is wrong
  EXPECT_EQ(judge_time_base(w).frames_per_second.value, 317);
  EXPECT_THAT(judge_time_base(w).caveats, ElementsAre(HasSubstr("317"), HasSubstr("60 are given for it")));
}

TEST(TimeBase, FileAndNominalSpeedTogetherOverruleFlights) {
  TimeWitnesses w = film(120, {151, 8});
  add_drum(w, 27, 120, 27.4);
  EXPECT_EQ(judge_time_base(w).frames_per_second.value, 120);
  EXPECT_THAT(judge_time_base(w).caveats, ElementsAre(HasSubstr("fall as at 151 +- 8")));
}

TEST(TimeBase, WhatIsToldIsBelievedAndContradictionReported) {
  TimeWitnesses w = film(30, {119, 2});
  w.told_rate = 120;
  EXPECT_EQ(judge_time_base(w).frames_per_second.value, 120);
  EXPECT_THAT(judge_time_base(w).caveats, IsEmpty());
  w.told_rate = 100;
  add_drum(w, 43, 120, 43);
  EXPECT_EQ(judge_time_base(w).frames_per_second.value, 100);
  EXPECT_THAT(judge_time_base(w).caveats,
              ElementsAre(HasSubstr("--recorded-fps 100 is believed, but balls in flight fall as at 119 +- 2"),
                          HasSubstr("35.8 rev/min, while 43 are given")));
}

TEST(TimeBase, PoorFlightsDoNotOverruleAFile) {
  const TimeBase base = judge_time_base(film(30, {119, 20}));
  EXPECT_EQ(base.frames_per_second.value, 30);
  EXPECT_THAT(base.caveats, ElementsAre(HasSubstr("too few balls fly to check")));
}

TEST(TimeBase, WithoutFlightsTheNominalSpeedShowsSlowMotionButNoLess) {
  TimeWitnesses w = film(30, {});
  add_drum(w, 43, 120, 43.8);
  EXPECT_EQ(judge_time_base(w).frames_per_second.value, 120);
  EXPECT_THAT(judge_time_base(w).caveats, ElementsAre(HasSubstr("give --recorded-fps")));
  add_drum(w, 43, 110, 43);  // 100 or 120: as the dial says, to 3 %
  EXPECT_NEAR(judge_time_base(w).frames_per_second.value, 110, 0.1);
  EXPECT_NEAR(judge_time_base(w).frames_per_second.se, 3.3, 0.1);
  add_drum(w, 43, 30.3, 43);  // file and dial agree
  EXPECT_EQ(judge_time_base(w).frames_per_second.value, 30);
  EXPECT_EQ(judge_time_base(w).frames_per_second.se, 0);
  add_drum(w, 43, 36, 43);  // a fifth: as likely another speed as another clock
  EXPECT_EQ(judge_time_base(w).frames_per_second.value, 30);
  EXPECT_NEAR(judge_time_base(w).frames_per_second.se, 6, 0.1);
  EXPECT_THAT(judge_time_base(w).caveats, ElementsAre(HasSubstr("too few"), HasSubstr("43 are given for it")));
}

TEST(TimeBase, NobodyKnows) {
  const TimeBase base = judge_time_base({});
  EXPECT_TRUE(std::isnan(base.frames_per_second.value));
  EXPECT_THAT(base.caveats, ElementsAre(HasSubstr("give --recorded-fps")));
}

}  // namespace
}  // namespace tumble::analysis
