#pragma once
#include <array>
#include <cstddef>
#include <numeric>
#include <vector>

#include "core/frame.h"

namespace tumble::sim {

// The balls in the lab frame, a structure of arrays. Between two steps positions belong to the step, velocities to half
// a step later (leapfrog, Mishra & Rajamani 1992, eqs 4 to 6).
struct Charge {
  std::vector<double> x, y;           // centres [m]
  std::vector<double> angle;          // of the ball's mark, unwrapped [rad]
  std::vector<double> vx, vy, spin;   // half a step after the positions [m/s, rad/s]
  std::vector<double> ax, ay, alpha;  // half of what the last step added to the velocities [m/s, rad/s]: v - a is the
                                      // velocity at the positions' own time, v + a that foreseen for the next
  std::vector<double> radius, mass;   // [m], [kg]
  std::vector<double> half_step_per_mass, half_step_per_inertia;  // dt / 2m [s/kg], dt / 2I
  std::vector<double> end_x, end_y;  // springs against the end walls, in the mill's frame [m]
  std::vector<int> id;               // number of the ball that is stored here

  std::size_t size() const { return x.size(); }
};

// What moves, and what stays as it is.
inline std::array<std::vector<double>*, 11> moving_columns(Charge& c) {
  return {&c.x, &c.y, &c.angle, &c.vx, &c.vy, &c.spin, &c.ax, &c.ay, &c.alpha, &c.end_x, &c.end_y};
}
inline std::array<std::vector<double>*, 4> constant_columns(Charge& c) {
  return {&c.radius, &c.mass, &c.half_step_per_mass, &c.half_step_per_inertia};
}

// Balls at rest at the origin.
inline Charge make_charge(const Balls& balls) {
  Charge c;
  c.radius = balls.radius;
  c.mass = balls.mass;
  for (auto* v : moving_columns(c)) v->assign(balls.size(), 0.0);
  c.half_step_per_mass.reserve(balls.size());
  c.half_step_per_inertia.reserve(balls.size());
  c.id.resize(balls.size());
  std::iota(c.id.begin(), c.id.end(), 0);
  return c;
}

// Spheres: I = 2/5 m r^2 [kg m2].
inline double inertia(double mass, double radius) { return 0.4 * mass * radius * radius; }

}  // namespace tumble::sim
