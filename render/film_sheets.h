#pragma once
#include "core/mill_shape.h"
#include "render/film_look.h"
#include "render/paint.h"

namespace tumble::render {

// The painted parts of a look. Decals lie over the mill's own frame from -1.5 to 1.5 R, first row at y = -1.5.
inline constexpr int kDecalSize = 1024;
Sheet paint_decals(const FilmLook& look, double ball_radius);  // on flange and back plate; ball_radius in R
Sheet paint_glass(const FilmLook& look);                       // sticks to the turning glass

// Where the mill lies in the picture, for what is painted round it.
struct MillPlace {
  Spot centre;        // [px]
  double radius = 1;  // R [px]
};
Sheet paint_room(const FilmLook& look, const MillPlace& place, double ball_radius);  // half the picture's size
Sheet paint_front(const FilmLook& look, const MillPlace& place);  // bars and bearing; the picture's size
Sheet paint_glare(const FilmLook& look, const MillPlace& place);  // light to be added; a quarter of the picture's size
void write_overlay(Sheet& sheet, const FilmLook& look,
                   double time);  // words and clock, on a sheet of the picture's size

}  // namespace tumble::render
