#pragma once
#include <cstdint>
#include <vector>

#include "core/image.h"
#include "render/film_look.h"
#include "render/paint.h"

namespace tumble::render {

// What stands still between mill and picture, painted once.
struct StillSheets {
  Sheet front{0, 0};  // bars, bearing; the picture's size
  Sheet glare{0, 0};  // a quarter of the picture's size
};

// The gain that brings the bright parts of the mill (within `radius` of the place) to the sensor's level.
float exposure_gain(const Sheet& light, const FilmLook& look, const Spot& centre, double radius);

// Brightness of the glare at a place of the picture, before the gain.
double glare_at(const StillSheets& still, double u, double v);

// From linear light to the picture: front and glare, lens blur, vignette, noise, gamma, sharpening, overlay.
Image develop(Sheet light, const FilmLook& look, const StillSheets& still, float gain, double time,
              std::uint64_t noise_seed);

}  // namespace tumble::render
