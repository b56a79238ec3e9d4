#pragma once
#include <cstdint>
#include <span>

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

// For magnitudes: lightness rises all the way, so that it also reads in print and to colour-blind eyes.
const Palette& sequential_palette();
// For signed values: cool below, warm above, pale in the middle.
const Palette& diverging_palette();

// Lightness L of Oklab in [0, 1].
double lightness(Rgba colour);

// The picture's own colours: one dark ground, greys of steel, one accent.
namespace ink {
inline constexpr Rgba kGround{14, 17, 22};
inline constexpr Rgba kMillInside{37, 43, 53};
inline constexpr Rgba kSteel{176, 186, 197};
inline constexpr Rgba kText{236, 240, 245};
inline constexpr Rgba kQuiet{146, 156, 170};  // labels, axes
inline constexpr Rgba kFaint{52, 59, 70};     // rules, frames
inline constexpr Rgba kAccent{255, 179, 71};  // toe, shoulder, cursor
inline constexpr Rgba kTrace{111, 190, 230};  // the torque's line
}  // namespace ink

}  // namespace tumble::render
