#include <gtest/gtest.h>

#include <cmath>

#include "sim/kernels/kernels.h"
#include "sim/laws/real.h"

namespace tumble::sim {
namespace {

TEST(Decay, IsTheExponential) {
  EXPECT_EQ(decay(0.0), 1);
  for (double u = 1e-9; u < 700; u *= 1.003) ASSERT_NEAR(decay(u) / std::exp(-u), 1, 5e-16) << u;
  EXPECT_LT(decay(1e300), 1e-300);
}

// Sums of rounded terms are the same forwards, backwards and in two halves; and what rounding takes is beneath notice.
TEST(ExactSum, DoesNotHangOnTheOrder) {
  const ExactSum exact = exact_up_to(1000);
  std::vector<double> terms;
  for (int k = 0; k < 2000; ++k) terms.push_back(exact(std::sin(k * 1.7) / (1 + k % 13)));
  double forwards = 0, backwards = 0, odd = 0, even = 0;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    forwards += terms[k];
    backwards += terms[terms.size() - 1 - k];
    (k % 2 ? odd : even) += terms[k];
  }
  EXPECT_EQ(forwards, backwards);
  EXPECT_EQ(forwards, odd + even);
  EXPECT_NEAR(exact(0.1), 0.1, 1000 * std::ldexp(1, -51));
  EXPECT_NE(exact(0.1), 0.1) << "nothing is rounded";
}

}  // namespace
}  // namespace tumble::sim
