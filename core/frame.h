#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/config.h"

// What a simulation hands out: the run's setup once, then frames. Plain arrays, SI, index = ball.
namespace tumble {

struct Balls {                 // what does not change during a run
  std::vector<double> radius;  // [m]
  std::vector<double> mass;    // [kg]
  std::size_t size() const { return radius.size(); }
};

struct Observables {          // of one slice
  double torque = kNotGiven;  // mean since the last frame of the full moment about the axis, > 0 drives the mill [N m]
  double torque_shear = kNotGiven;     // the same by the 1992 paper's eq. 8: shear forces only [N m]
  double torque_closure = kNotGiven;   // M g x_com, mean since the last frame [N m]
  double torque_external = kNotGiven;  // moment on the charge of fluid and pool about the axis, likewise [N m];
                                       // in a steady state torque + torque_external = torque_closure
  double power = kNotGiven;            // of the drive, mean since the last frame [W]
  double kinetic = kNotGiven;          // translation and spin [J]
  double potential = kNotGiven;        // against the axis [J]
  double elastic = kNotGiven;          // in contact springs [J]
  double drive_work = kNotGiven;       // done by the drive since the run's start [J]
  std::vector<double> dissipation;  // by cause since the run's start [J], in the order of RunSetup::dissipation_causes
  double locked_balls = 0;          // balls that have turned with the shell for more than a revolution
};

struct Frame {
  std::int64_t step = 0;       // time steps since the run's start
  double time = 0;             // since the first written frame [s]
  double mill_angle = 0;       // theta, unwrapped [rad]
  std::vector<double> x, y;    // [m]
  std::vector<double> vx, vy;  // [m/s]
  std::vector<double> angle;   // of each ball's mark, unwrapped [rad]
  std::vector<double> spin;    // angular velocity, counter-clockwise > 0 [rad/s]
  Observables observed;
};

// The state between two frames of one run, at `time`: cubic through positions and velocities (Hermite), so a flight is
// exact and slow motion is smooth. Observables are the nearer frame's.
Frame between(const Frame& a, const Frame& b, double time);

struct RunSetup {  // known before the first frame
  Config config;
  Balls balls;
  double time_step = 0;          // dt [s]
  double mill_speed = 0;         // Omega [rad/s]
  std::int64_t frame_count = 0;  // frames that a whole run has
  std::vector<std::string> dissipation_causes;
};

// Everything about impacts and falls is per second, over the averaged revolutions.
struct ImpactSpectrum {           // impacts by the energy lost in them
  std::vector<double> edges_J;    // bin edges, logarithmic; the first and last bin take what lies outside
  std::vector<double> ball_ball;  // number of impacts per bin, by all the energy lost [1/s]
  std::vector<double> ball_wall;
  std::vector<double> ball_ball_normal, ball_ball_tangential;  // by the normal, by the tangential part alone [1/s]
  std::vector<double> ball_wall_normal, ball_wall_tangential;
};

struct FallHeights {              // flights from contact to contact, by how far the ball falls from its highest point
  std::vector<double> edges;      // [m], from 0 to the shell's diameter; the first bin takes flights that end higher
  std::vector<double> frequency;  // [1/s]
};

inline constexpr std::array kFaceNames{"plate", "leading", "top", "trailing"};  // parts of the shell, in this order

struct ImpactPlaces {  // where on the shell the first touch of an impact was
  std::vector<double> angle_edges_deg;
  // By face, then angle in the lab: impacts [1/s], and the power lost in them [W].
  std::array<std::vector<double>, kFaceNames.size()> frequency, power;
  // By lifter (0 at mill angle 0, counter-clockwise), its own faces only.
  std::vector<double> lifter_frequency, lifter_power;
};

struct RunResult {  // known after the last frame
  ImpactSpectrum spectrum;
  FallHeights falls;
  ImpactPlaces places;
  double spin_up_revolutions = 0;  // what "auto" came to
  bool steady = true;              // no trend in torque or centre of mass over the averaged revolutions
  std::string caveat;              // one sentence for the user where something is not to be trusted, else empty
};

}  // namespace tumble
