#include "diagnose/compare.h"

#include <gtest/gtest.h>

#include <cmath>

namespace tumble::diagnose {
namespace {

const Difference* find(const Deviation& deviation, const std::string& name) {
  for (const Difference& d : deviation.differences)
    if (d.name == name) return &d;
  return nullptr;
}

TEST(Compare, TakesDirectionsRoundTheCircleAndAddsErrorsInSquares) {
  ChargeMotion a, b;
  a.shoulder_deg = {359, 0.3};
  b.shoulder_deg = {2, 0.4};
  a.head = {0.2, 0.01};
  b.head = {0.17, 0.0};
  const Deviation deviation = compare(a, b);
  const Difference* shoulder = find(deviation, "shoulder_deg");
  ASSERT_TRUE(shoulder);
  EXPECT_NEAR(shoulder->difference, 3, 1e-12);
  EXPECT_NEAR(shoulder->se, 0.5, 1e-12);
  EXPECT_NEAR(shoulder->z, 6, 1e-9);
  const Difference* head = find(deviation, "head_m");
  ASSERT_TRUE(head);
  EXPECT_NEAR(head->difference, -0.03, 1e-12);
  EXPECT_NEAR(head->z, -3, 1e-9);
}

TEST(Compare, WhatOneLacksHasNoDifferenceAndWhatBothLackNoRow) {
  ChargeMotion a, b;
  a.toe_deg = {230, 1};
  b.toe_deg = {231, kNotGiven};
  a.torque = {8, 0.1};
  const Deviation deviation = compare(a, b);
  ASSERT_EQ(deviation.differences.size(), 2u);
  EXPECT_TRUE(std::isnan(find(deviation, "toe_deg")->z)) << "an error that is not known is not zero";
  EXPECT_TRUE(std::isnan(find(deviation, "torque_N_m")->difference));
}

}  // namespace
}  // namespace tumble::diagnose
