#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "render/film_look.h"

namespace tumble::render {

// What a ball looks like for good.
struct BallDress {
  Light colour;
  float kind = 0;  // 0 bare, 1 line, 2 half, 3 dots, 4 hollow
  float brightness = 1, material = 0, tilt = 0;
  float chance_x = 0, chance_y = 0;
  bool marked = false, tracer = false;
};

// One for each ball, by the classes of the balls.
std::vector<BallDress> dress(const BallLook& look, std::span<const int> ball_class, std::uint64_t seed);

}  // namespace tumble::render
