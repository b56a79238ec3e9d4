#pragma once
#include "core/mill_shape.h"
#include "render/canvas.h"

namespace tumble::render {

// Inside, steel rim, liner and lifters with their bolts, turned by the mill angle [rad]. Flushes: balls come above.
void draw_mill(Canvas& canvas, const MillShape& shape, double mill_angle);

}  // namespace tumble::render
