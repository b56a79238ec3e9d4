#pragma once
#include <cstdint>
#include <initializer_list>

#include "core/drawing.h"

namespace tumble::render {

Rgba with_alpha(Rgba colour, double alpha);   // alpha in [0, 1], times the colour's own
Rgba mix(Rgba a, Rgba b, double share);       // share of b in [0, 1], channel by channel
Rgba scaled(Rgba colour, double brightness);  // channels times brightness, clipped

// A colour scale of 256 steps through a few colours, blended in Oklab (Ottosson 2020), where equal steps look equal.
struct Palette {
  Rgba colours[256];
  Rgba at(double share) const;  // share in [0, 1]; beyond it the ends
};

// A scale through colours at equal distances along it.
Palette blend(std::initializer_list<Rgba> stops);

// Lightness L of Oklab in [0, 1].
double lightness(Rgba colour);
// Relative luminance of an sRGB colour in [0, 1].
double luminance(Rgba colour);

}  // namespace tumble::render
