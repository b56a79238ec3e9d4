#pragma once
#include <vector>

#include "render/film_lens.h"

namespace tumble::render {

// Triangles of the picture that hold each part of the drum whatever its angle, a little too large; a part's shader
// works out what is seen. u, v of each corner [px].
struct DrumParts {
  std::vector<float> flange, plate, wall;
};

// Lengths in R: `tip` the lifters' tips, `depth` from glass to back plate.
DrumParts drum_parts(const Pinhole& camera, const FlangeLook& flange, double tip, double depth);

}  // namespace tumble::render
