#pragma once
#include <cmath>
#include <vector>

#include "analysis/ballistics.h"
#include "core/angle.h"
#include "core/random.h"
#include "core/units.h"

// Balls of a mill as a camera of any rate and roll sees them: carried on circles, and some of them in flight.
namespace tumble::analysis {

struct FallingBalls {
  double fps = 120;
  double roll_deg = 0;                     // the picture turned counter-clockwise by this
  double readout_share = 0;                // of a rolling shutter
  double noise = 0.0006;                   // [m]
  double mill_radius = 0.27, speed = 4.2;  // [m], [rad/s]
  int flying = 20, carried = 30;
  double lost = 0;   // share of sightings that are missing
  double wrong = 0;  // share of sightings that are somewhere else
  double drag = 0;   // share of gravity that flights lack
};

// One second of it. Flying balls are carried to a departure, fly until they meet the shell, and are carried again.
inline std::vector<TimedPlace> sightings(const FallingBalls& scene, Random& random) {
  std::vector<TimedPlace> places;
  const double g = kGravity * (1 - scene.drag), roll = radians(scene.roll_deg);
  for (int id = 0; id < scene.flying + scene.carried; ++id) {
    const bool flies = id < scene.flying;
    const double rho = scene.mill_radius * random.uniform(0.75, 0.95);
    const double leave = radians(random.uniform(35, 75)), start = random.uniform(0.1, 0.5);
    const double speed = scene.speed * random.uniform(0.95, 1.1), first = random.uniform(0, 360);
    double landed = kNotGiven, landed_at = 0;
    const auto place_at = [&](double t, double& x, double& y) {
      double a = radians(first) + speed * t;
      if (flies) a = leave + speed * (t - start);
      x = rho * std::cos(a), y = rho * std::sin(a);
      if (!flies || t < start) return;
      const double s = t - start;
      x = rho * (std::cos(leave) - speed * std::sin(leave) * s);
      y = rho * (std::sin(leave) + speed * std::cos(leave) * s) - 0.5 * g * s * s;
      if (std::isnan(landed) && s > 0.02 && std::hypot(x, y) > rho) landed = t, landed_at = std::atan2(y, x);
      if (t < landed || std::isnan(landed)) return;
      a = landed_at + speed * (t - landed);
      x = rho * std::cos(a), y = rho * std::sin(a);
    };
    for (int f = 0; f < static_cast<int>(scene.fps); ++f) {
      TimedPlace p;
      p.track = id;
      p.frame = f;
      double x = 0, y = 0;
      p.row_share = 0.5;
      for (int k = 0; k < 3; ++k) {  // the row tells when the ball is read, and the ball's place tells the row
        place_at((f + scene.readout_share * p.row_share) / scene.fps, x, y);
        p.row_share = 0.5 - (x * std::sin(roll) + y * std::cos(roll)) / (2.6 * scene.mill_radius);
      }
      p.x = x * std::cos(roll) - y * std::sin(roll) + scene.noise * gaussian(random);
      p.y = x * std::sin(roll) + y * std::cos(roll) + scene.noise * gaussian(random);
      if (random.uniform() < scene.wrong) p.x += random.uniform(-0.05, 0.05), p.y += random.uniform(-0.05, 0.05);
      if (random.uniform() < scene.lost) continue;
      places.push_back(p);
    }
  }
  return places;
}

}  // namespace tumble::analysis
