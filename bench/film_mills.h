#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "core/config.h"
#include "core/frame.h"
#include "core/random.h"
#include "render/film_camera.h"

// Mills to be filmed: random ones, simulated slice by slice; slices side by side make a charge with depth.
namespace tumble::films {

struct FilmMill {
  Config config;
  int layers = 1;
  double length = 0;                   // glass to back plate [m]
  double charge_depth = 0;             // from the glass: less than the length where the layers behind are left out [m]
  double mill_speed = 0;               // [rad/s]
  std::vector<double> radius;          // of every ball of every layer [m]
  std::vector<int> ball_class, layer;  // of every ball
  struct State {
    double time = 0, mill_angle = 0;
    std::vector<render::BallState> balls;  // z is not set
  };
  std::vector<State> states;
};

// How long and how densely a mill is kept.
struct Keeping {
  double spin_up = 1.2, revolutions = 1.5;
  double seconds = 0;            // instead of revolutions, where > 0
  double states_per_second = 0;  // 0: so that there are about 24
  bool slabs = false;            // room for every layer to move by itself, none through another
};

FilmMill simulate_random_mill(std::uint64_t seed, const Keeping& keeping);

// `count` mills; read from the file if it holds them, else simulated and written there.
std::vector<FilmMill> cached_mills(const std::filesystem::path& file, std::uint64_t seed, int count);

// Depths for every ball of slabs that never touch, for a film [m].
std::vector<double> slab_depths_of(const FilmMill& mill, Random& random);

// One state as a picture shows it: layers that interlock, none through glass or back plate. Balls that found no room
// are left out.
struct PlacedBalls {
  std::vector<std::size_t> ball;
  std::vector<double> z;  // [m]
};
PlacedBalls place_balls(const FilmMill& mill, const FilmMill::State& state, Random& random);

}  // namespace tumble::films
