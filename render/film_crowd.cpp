#include "render/film_crowd.h"

#include <algorithm>
#include <cmath>

namespace tumble::render {
namespace {

constexpr double kReach = 1.3;  // centres farther apart than this times 2 r_max do not darken one another

void darken(Crowding& crowding, const PlacedBall& me, const PlacedBall& other, std::span<const Lamp> lamps) {
  const Eigen::Vector3d way = other.centre - me.centre;
  const double apart = way.norm();
  const double gap = apart - me.radius - other.radius;
  const double near = std::clamp(1 - gap / (0.7 * me.radius), 0.0, 1.0);
  crowding.towards += (0.42 * near * std::min(1.0, other.radius / me.radius) / apart * way).cast<float>();
  for (std::size_t k = 0; k < lamps.size() && k < 2; ++k) {
    const double along = way.dot(lamps[k].towards);
    if (along <= 0.2 * me.radius) continue;
    const double aside = (way - along * lamps[k].towards).norm();
    const double hidden = std::clamp((me.radius + other.radius - aside) / (2 * me.radius), 0.0, 1.0);
    crowding.reach[k] *= static_cast<float>(1 - 0.55 * hidden);
  }
}

}  // namespace

std::vector<Crowding> crowding_of(std::span<const PlacedBall> balls, std::span<const Lamp> lamps) {
  std::vector<Crowding> all(balls.size());
  double largest = 0;
  for (const PlacedBall& b : balls) largest = std::max(largest, b.radius);
  if (largest <= 0) return all;
  const double cell = 2 * kReach * largest;
  const int across = static_cast<int>(2.4 / cell) + 3;
  const auto index = [&](double x) { return std::clamp(static_cast<int>((x + 1.2) / cell) + 1, 1, across - 2); };
  std::vector<std::vector<int>> cells(static_cast<std::size_t>(across) * across);
  for (std::size_t i = 0; i < balls.size(); ++i)
    cells[static_cast<std::size_t>(index(balls[i].centre.y())) * across + index(balls[i].centre.x())].push_back(
        static_cast<int>(i));
  for (std::size_t i = 0; i < balls.size(); ++i) {
    const PlacedBall& me = balls[i];
    const int x = index(me.centre.x()), y = index(me.centre.y());
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        for (const int j : cells[static_cast<std::size_t>(y + dy) * across + x + dx])
          if (j != static_cast<int>(i)) darken(all[i], me, balls[static_cast<std::size_t>(j)], lamps);
    const double rho = me.centre.head<2>().norm();
    const double near = std::clamp(1 - (1 - rho - me.radius) / (0.8 * me.radius), 0.0, 1.0);
    if (near > 0) all[i].towards.head<2>() += (0.5 * near / std::max(rho, 1e-6) * me.centre.head<2>()).cast<float>();
    all[i].towards.z() -= 0.2f;  // the back plate takes light, the glass gives it
    const float length = all[i].towards.norm();
    if (length > 1) all[i].towards /= length;
  }
  return all;
}

}  // namespace tumble::render
