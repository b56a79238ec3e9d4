#pragma once
#include <cmath>
#include <vector>

#include "core/units.h"
#include "sim/running_mill.h"

// Small scenes for the physics tests: a resting smooth shell, a few balls, one contact law.
namespace tumble::sim {

struct Ball {
  double radius = 0.012, mass = 0.06;
  double x = 0, y = 0, vx = 0, vy = 0, spin = 0;
};

inline Charge charge_of(const std::vector<Ball>& balls) {
  Balls bodies;
  for (const Ball& b : balls) {
    bodies.radius.push_back(b.radius);
    bodies.mass.push_back(b.mass);
  }
  Charge c = make_charge(bodies);
  for (std::size_t i = 0; i < balls.size(); ++i) {
    c.x[i] = balls[i].x;
    c.y[i] = balls[i].y;
    c.vx[i] = balls[i].vx;
    c.vy[i] = balls[i].vy;
    c.spin[i] = balls[i].spin;
  }
  return c;
}

// The paper's springs; no friction unless asked for.
inline LinearSpringDashpot springs(double restitution, double friction = 0) {
  return {4e5, 3e5, friction, restitution};
}

inline MillModel smooth_shell(double radius, double gravity, const LinearSpringDashpot& law, double time_step) {
  MillModel m;
  m.shell.radius = m.shell.tip_radius = radius;
  m.ball = m.wall = law;
  m.gravity = gravity;
  m.time_step = time_step;
  return m;
}

inline void advance_by(RunningMill& mill, double seconds) {
  const auto steps = std::llround(seconds / mill.model.time_step);
  for (std::int64_t k = 0; k < steps; ++k) advance(mill);
}

// Velocities at the positions' own time.
inline double vx_of(const RunningMill& mill, std::size_t i) { return mill.charge.vx[i] - mill.charge.ax[i]; }
inline double vy_of(const RunningMill& mill, std::size_t i) { return mill.charge.vy[i] - mill.charge.ay[i]; }

}  // namespace tumble::sim
