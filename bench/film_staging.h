#pragma once
#include <nlohmann/json.hpp>

#include "bench/film_mills.h"
#include "render/film_camera.h"

// What pictures and films have in common: a mill put before a camera, and the truth about both in words.
namespace tumble::films {

// How much of the mill must be seen.
enum class Crop { kNever, kSeldom, kOften };

// A picture's size and where the mill stands in it, so that the smallest balls have a fair size.
void frame_mill(render::FilmLook& look, const FilmMill& mill, Crop crop, Random& random);

render::FilmScene scene_of(const FilmMill& mill, bool clockwise);

double log_uniform(Random& random, double low, double high);

nlohmann::ordered_json json_of(const render::FilmLens& lens, double shell_radius);
nlohmann::ordered_json json_of(const FilmMill& mill);
nlohmann::ordered_json json_of(const render::FilmLook& look);  // what matters to whoever looks at the picture

}  // namespace tumble::films
