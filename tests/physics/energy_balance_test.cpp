#include <gtest/gtest.h>

#include <numeric>

#include "sim/simulator.h"
#include "tests/support/mills.h"

namespace tumble::sim {
namespace {

double energy(const Observables& o) { return o.kinetic + o.potential + o.elastic; }
double lost(const Observables& o) { return std::accumulate(o.dissipation.begin(), o.dissipation.end(), 0.0); }

// Six revolutions of the paper's mill: what the drive puts in is found again in the charge or in the losses, and the
// torque is the moment of the charge's weight.
TEST(EnergyBalance, ClosesInThePapersMill) {
  std::vector<Observables> seen;
  double torque = 0, closure = 0;
  simulate(paper_mill(), {.setup = {},
                          .frame =
                              [&](const Frame& f) {
                                seen.push_back(f.observed);
                                torque += f.observed.torque;
                                closure += f.observed.torque_closure;
                              },
                          .checkpoint = {},
                          .progress = {}});
  const Observables &first = seen.front(), &last = seen.back();
  const double work = last.drive_work - first.drive_work;
  const double error = work - (energy(last) - energy(first)) - (lost(last) - lost(first));
  EXPECT_GT(work, 100) << "about 9 N m over 38 rad";
  EXPECT_LT(std::abs(error), 1e-3 * work);
  EXPECT_NEAR(closure / torque, 1, 0.01);
  for (std::size_t k = 0; k < last.dissipation.size(); ++k)
    EXPECT_GT(last.dissipation[k] - first.dissipation[k], 0.01 * work) << "cause " << k << " takes its part";
}

}  // namespace
}  // namespace tumble::sim
