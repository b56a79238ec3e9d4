#include "diagnose/proofs.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/random.h"
#include "tests/diagnose/made_up_mill.h"

namespace tumble::diagnose {
namespace {

// One condition, and polynomials that are off by the same wave wherever they were tried.
class PutRight : public testing::Test {
 protected:
  PutRight() : numbers_(mill_.response()->at(Eigen::VectorXd::Zero(6)).mean.size()), wave_(numbers_) {
    for (Eigen::Index i = 0; i < numbers_; ++i) wave_[i] = std::sin(0.7 * double(i));
  }

  Case measured(const SignatureRun& run) const {
    Case c;
    const Eigen::VectorXd seen = mill_.response()->whitened(observed_at(run.seen, kSpans[0])) + wave_;
    c.by_lifter = {{{mill_.response(), seen, run.revolutions}}};
    c.suspects = mill_.suspects();
    return c;
  }

  FoundError found(double a, double b, double bend, double twist, int runs) {
    FoundError f{Eigen::VectorXd::Zero(6), wave_, double(runs)};
    f.places.head(4) << a, b, bend, twist;
    for (Eigen::Index i = 0; i < numbers_; ++i) f.shift[i] += gaussian(random_) / std::sqrt(double(runs));
    return f;
  }

  static Explanation about(double a, double b, double bend, double twist) {
    Explanation e;
    e.places = Eigen::VectorXd::Zero(6);
    e.places.head(4) << a, b, bend, twist;
    e.free = {0, 1, 2};
    e.suspects = {0};
    return e;
  }

  MadeUpMill mill_;
  Eigen::Index numbers_;
  Eigen::VectorXd wave_;
  Random random_{41};
};

TEST_F(PutRight, TheMoreRunsTheBetter) {
  const Case c = measured(mill_.run(random_, {0, 0, 0}));
  const auto left = [&](const FoundErrors& errors, const Explanation& e) {
    const Measured again = corrected(c, errors, e).by_lifter[0][0];
    return (again.shift - wave_).norm() / wave_.norm();
  };
  const FoundErrors few{{found(0, 0, 0, 0, 6)}};
  FoundErrors more = few;
  for (int i = 0; i < 5; ++i) more[0].push_back(found(0.2 * i, -0.1 * i, 0.05 * i, 0, 6));
  EXPECT_LT(left(few, about(0, 0, 0, 0)), 0.7);
  EXPECT_LT(left(more, about(0, 0, 0, 0)), 0.35);
  EXPECT_GT(left(more, about(3, 3, 1, 1)), 0.95);  // nothing was simulated there
}

// What chance did to each one's own few runs must not tell neighbours apart.
TEST_F(PutRight, NeighboursAreJudgedAlike) {
  const Case c = measured(mill_.run(random_, {0, 0, 0}));
  const FoundErrors errors{{found(0, 0, 0, 0, 6), found(0, 0, 0.02, 0, 6)}};
  const Measured none = corrected(c, errors, about(0, 0, 0, 0)).by_lifter[0][0],
                 hardly = corrected(c, errors, about(0, 0, 0.02, 0)).by_lifter[0][0];
  EXPECT_LT((none.shift - hardly.shift).norm(), 0.1 * (errors[0][0].shift - errors[0][1].shift).norm());
  EXPECT_NEAR(none.shift_variance, hardly.shift_variance, 0.01);
}

TEST_F(PutRight, WhatIsLeftOpenShrinksWithWhatIsFound) {
  const Case c = measured(mill_.run(random_, {0, 0, 0}));
  double last = 10;
  FoundErrors errors(1);
  for (const int runs : {2, 6, 40}) {
    errors[0] = {found(0, 0, 0, 0, runs)};
    const Measured again = corrected(c, errors, about(0, 0, 0, 0)).by_lifter[0][0];
    EXPECT_LT(again.shift_variance, last);
    last = again.shift_variance;
  }
  EXPECT_LT(last, 1.0 / 40 + 1e-9);
}

// Six runs know their scatter badly: what is z = 1 to many is more to few, and to a measurement as to a run left out.
TEST(Chance, ARunLeftOutIsAsFarOffAsAMeasurement) {
  Random random(7);
  constexpr std::size_t kNumbers = 4000;
  const auto run = [&] {
    std::vector<double> numbers(kNumbers);
    for (std::size_t i = 0; i < kNumbers; ++i) numbers[i] = double(i % 7) + gaussian(random);
    return numbers;
  };
  Replicas a, b;
  for (int r = 0; r < 4; ++r) a.seen.push_back(run());
  for (int r = 0; r < 6; ++r) b.seen.push_back(run());
  const Chance chance = chance_of({&a, &b});
  double left_out = 0, fresh = 0;
  for (const std::vector<double>& z : chance.left_out)
    for (const double each : z) left_out += each * each / double(chance.left_out.size());
  const std::vector<double> measured = run();
  for (std::size_t i = 0; i < kNumbers; ++i) {
    double mean = 0;
    for (const auto& r : b.seen) mean += r[i] / 6;
    const double z = (measured[i] - mean) / (chance.scatter[i] * std::sqrt(1 + 1.0 / 6));
    fresh += z * z;
  }
  EXPECT_GT(fresh, 1.15 * kNumbers);
  // Eight degrees of freedom are left to a fresh one, seven to a run left out: 8 / 6 against 7 / 5 on average.
  EXPECT_NEAR(left_out / fresh, (7.0 / 5) / (8.0 / 6), 0.08);
}

}  // namespace
}  // namespace tumble::diagnose
