#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "render/film_look.h"

namespace tumble::render {

struct PlacedBall {
  Eigen::Vector3d centre;  // [R]
  double radius = 0;       // [R]
};

// How the others darken a ball: where they crowd (a vector; its length is how much of that side they take), and the
// share of each lamp's light that they leave it.
struct Crowding {
  Eigen::Vector3f towards{0, 0, 0};
  float reach[2] = {1, 1};
};

std::vector<Crowding> crowding_of(std::span<const PlacedBall> balls, std::span<const Lamp> lamps);

}  // namespace tumble::render
