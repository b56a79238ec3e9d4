#include <gtest/gtest.h>

#include "tests/support/balls.h"

namespace tumble::sim {
namespace {

// Exponent of the step with which the error falls: the slope of log(error) over steps halved thrice.
template <class Error>
double order_of(Error&& error, double step) {
  return std::log2(std::abs(error(step)) / std::abs(error(step / 8))) / 3;
}

// A ball swings on the floor without ever leaving it: y = y_0 + A exp(-z w t) (cos + ...) in closed form.
double swing_error(double e, double dt) {
  MillModel model = resting(smooth_mill(kFlat, {}, 0, e), dt);
  model.gravity = 1e4;  // a deep sag, so that a wide swing stays in contact
  Ball ball = on_floor(model);
  const double rest = ball.y, amplitude = 2e-4, t = 0.02;
  ball.y += amplitude;
  RunningMill mill = start_under_forces(model, charge_of({ball}));
  advance_by(mill, t);
  const double z = damping_ratio(e), w = std::sqrt(4e5 / 0.06), wd = w * std::sqrt(1 - z * z);
  const double expected = amplitude * std::exp(-z * w * t) * (std::cos(wd * t) + z * w / wd * std::sin(wd * t));
  return (mill.charge.y[0] - rest - expected) / amplitude;
}

TEST(Convergence, OfASwingIsOfSecondOrder) {
  for (const double e : {1.0, 0.9})
    EXPECT_NEAR(order_of([&](double dt) { return swing_error(e, dt); }, 4e-5), 2, 0.05) << "e " << e;
}

// Drag is taken at a velocity that is foreseen from the last step: no order is lost by that. (Here one is gained.)
TEST(Convergence, OfADragIsOfSecondOrder) {
  const auto error = [](double dt) {
    const Effects drag{{"fluid_drag", {{"viscosity", {2}}}}};
    MillModel model = resting(smooth_mill(kFlat, drag), dt);
    model.gravity = 0;
    RunningMill mill = start_under_forces(model, charge_of({{.vx = 1}}));
    advance_by(mill, 0.16);
    return vx_of(mill, 0) - std::exp(-6 * kPi * 2 * 0.012 / 0.06 * 0.16);
  };
  EXPECT_GT(order_of(error, 4e-3), 1.9);
}

// An impact from flight to flight: the restitution's error falls as fast, over the phases of the impact in a step.
TEST(Convergence, OfAnImpactIsOfSecondOrder) {
  const auto error = [](double steps) {
    const LinearSpringDashpot law = springs(0.5);
    double square = 0;
    for (int p = 0; p < 64; ++p) {
      const double dt = contact_time(law, 0.06) / steps;
      RunningMill mill =
          start_mill(smooth_shell(1, 0, law, dt), charge_of({{.x = 1 - 0.012 - dt * (2 + p / 64.0), .vx = 1}}));
      advance_by(mill, 3 * steps * dt);
      square += std::pow(-vx_of(mill, 0) - 0.5, 2) / 64;
    }
    return std::sqrt(square);
  };
  EXPECT_GT(std::log2(error(20) / error(160)) / 3, 1.8);
}

}  // namespace
}  // namespace tumble::sim
